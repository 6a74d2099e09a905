// Tasks are blocks of tiles times blocks of directions. Within a task products are met in the order of the
// tiles; the answers of tasks are joined in that order too, so they do not depend on how the work was shared.
#include "approx/rays/direction_scan.h"

#include <algorithm>
#include <cmath>

#include "approx/rays/direction_scan_kernel.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// A task's directions stay in the first-level cache with a tile (8 kB in 16-d), its tiles in the second.
constexpr std::size_t kDirectionsPerTask = 128;
constexpr std::size_t kTilesPerTask = 64;

/// The queries of one task, and what it found.
struct ScanTask {
  std::vector<DirectionState> states;
  std::vector<NearPoint> near;
};

/// Runs the loop over some tiles for queries first .. first + count.
void run_task(const ScanTiles& tiles, std::size_t begin_tile, std::size_t end_tile,
              std::span<const float> directions, std::span<const DirectionQuery> queries, ScanTask& task) {
  const std::size_t dimension = tiles.dimension();
  const std::size_t padded = (queries.size() + kDirectionGroup - 1) / kDirectionGroup * kDirectionGroup;
  task.states.clear();
  for (const DirectionQuery& query : queries) {
    DirectionState state{query.threshold, query.refute, query.skip};
    state.end_tile = static_cast<std::uint32_t>(
        tiles.tiles_above(static_cast<double>(query.threshold) - tiles.product_error()));
    task.states.push_back(state);
  }
  task.states.resize(padded, DirectionState{HUGE_VALF, HUGE_VALF, DirectionQuery::kNoPoint});
  std::vector<float> filled;
  const float* rows = directions.data();
  if (padded != queries.size()) {
    filled.assign(directions.begin(), directions.end());
    filled.resize(padded * dimension, 0.0F);
    rows = filled.data();
  }
  task.near.clear();
  scan_tiles(tiles, begin_tile, end_tile, rows, task.states.data(), padded, task.near);
}

/// Adds what a task found; tasks come in the order of their tiles.
void join_task(const ScanTask& task, std::span<DirectionQuery> queries) {
  for (std::size_t row = 0; row < queries.size(); ++row) {
    const DirectionState& state = task.states[row];
    DirectionQuery& query = queries[row];
    query.is_refuted = query.is_refuted || state.is_refuted;
    if (state.furthest == DirectionQuery::kNoPoint) continue;
    if (query.furthest == DirectionQuery::kNoPoint || state.furthest_product > query.furthest_product) {
      query.furthest = state.furthest;
      query.furthest_product = state.furthest_product;
    }
  }
  for (const NearPoint& near : task.near) {
    if (!queries[near.direction].is_refuted) queries[near.direction].near.push_back(near.id);
  }
}

/// What is near matters only to planes that stand.
void drop_near_of_refuted(std::span<DirectionQuery> queries) {
  for (DirectionQuery& query : queries) {
    if (query.is_refuted) query.near.clear();
  }
}

void clear_answers(std::span<DirectionQuery> queries) {
  for (DirectionQuery& query : queries) {
    query.is_refuted = false;
    query.furthest = DirectionQuery::kNoPoint;
    query.furthest_product = 0.0F;
    query.near.clear();
  }
}

}  // namespace

void ScanTiles::reserve(std::size_t points) {
  values_.reserve((points + kScanTile - 1) / kScanTile * kScanTile * dimension_);
  ids_.reserve(points);
}

void ScanTiles::append(const double* point, std::uint32_t id) {
  const std::size_t slot = ids_.size() % kScanTile;
  if (slot == 0) values_.resize(values_.size() + dimension_ * kScanTile, 0.0F);
  float* const tile = values_.data() + ids_.size() / kScanTile * dimension_ * kScanTile;
  double length_sq = 0.0;
  for (std::size_t k = 0; k < dimension_; ++k) {
    tile[k * kScanTile + slot] = static_cast<float>(point[k]);
    length_sq += point[k] * point[k];
  }
  const double length = std::sqrt(length_sq);
  if (slot == 0) tile_lengths_.push_back(0.0);
  tile_lengths_.back() = std::max(tile_lengths_.back(), length);
  largest_length_ = std::max(largest_length_, length);
  ids_.push_back(id);
}

void ScanTiles::mark_sorted() { is_sorted_ = true; }

std::size_t ScanTiles::tiles_above(double threshold) const {
  if (!is_sorted_) return tile_count();
  const auto end = std::partition_point(tile_lengths_.begin(), tile_lengths_.end(),
                                        [threshold](double length) { return length > threshold; });
  return static_cast<std::size_t>(end - tile_lengths_.begin());
}

double ScanTiles::product_error() const {
  return 2.0 * static_cast<double>(dimension_ + 2) * 0x1p-24 * largest_length_;
}

void scan_directions(const ScanTiles& tiles, std::span<const float> directions,
                     std::span<DirectionQuery> queries) {
  clear_answers(queries);
  ScanTask task;
  for (std::size_t first = 0; first < queries.size(); first += kDirectionsPerTask) {
    const std::size_t count = std::min(kDirectionsPerTask, queries.size() - first);
    run_task(tiles, 0, tiles.tile_count(),
             directions.subspan(first * tiles.dimension(), count * tiles.dimension()),
             queries.subspan(first, count), task);
    join_task(task, queries.subspan(first, count));
  }
  drop_near_of_refuted(queries);
}

void scan_directions_in_parallel(const ScanTiles& tiles, std::span<const float> directions,
                                 std::span<DirectionQuery> queries) {
  clear_answers(queries);
  const std::size_t tile_blocks = (tiles.tile_count() + kTilesPerTask - 1) / kTilesPerTask;
  const std::size_t query_blocks = (queries.size() + kDirectionsPerTask - 1) / kDirectionsPerTask;
  std::vector<ScanTask> tasks(tile_blocks * query_blocks);
  const auto block_of = [&](std::size_t task) {
    const std::size_t first = task / tile_blocks * kDirectionsPerTask;
    return std::pair(first, std::min(kDirectionsPerTask, queries.size() - first));
  };
  for_each_block(tasks.size(), 1, [&](std::size_t task, std::size_t) {
    const auto [first, count] = block_of(task);
    const std::size_t begin = task % tile_blocks * kTilesPerTask;
    run_task(tiles, begin, std::min(begin + kTilesPerTask, tiles.tile_count()),
             directions.subspan(first * tiles.dimension(), count * tiles.dimension()),
             queries.subspan(first, count), tasks[task]);
  });
  for (std::size_t task = 0; task < tasks.size(); ++task) {
    const auto [first, count] = block_of(task);
    join_task(tasks[task], queries.subspan(first, count));
  }
  drop_near_of_refuted(queries);
}

}  // namespace ndhull
