#include "approx/reduction/direction_extremes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/reduction/direction_extremes_kernel.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

using Extreme = DirectionExtreme;

/// One thread's look at some blocks.
class Tile {
 public:
  Tile(const std::vector<float>& directions, std::size_t rank)
      : directions_(directions),
        rank_(rank),
        columns_(rank * kExtremeTile),
        best_(directions.size() / rank, Extreme{-HUGE_VALF}) {
    ids_.reserve(kExtremeTile);
  }

  /// Point i of those in the columns of z, rank x kWhitenedPoints.
  void add(const double* z, std::size_t i, std::uint32_t id) {
    for (std::size_t k = 0; k < rank_; ++k)
      columns_[k * kExtremeTile + ids_.size()] = static_cast<float>(z[k * kWhitenedPoints + i]);
    ids_.push_back(id);
    if (ids_.size() == kExtremeTile) finish();
  }

  /// Of the points added, in ascending order, the furthest along each direction.
  const std::vector<Extreme>& finish() {
    raise_extremes(columns_.data(), rank_, ids_, directions_.data(), best_);
    ids_.clear();
    return best_;
  }

 private:
  const std::vector<float>& directions_;
  std::size_t rank_;
  std::vector<float> columns_;  // rank x kExtremeTile
  std::vector<std::uint32_t> ids_;
  std::vector<Extreme> best_;
};

std::vector<float> random_directions(std::size_t count, std::size_t rank, std::uint64_t seed) {
  PortableRandom random(seed);
  std::vector<float> directions(count * rank);
  for (float& number : directions) number = static_cast<float>(random.normal());
  return directions;
}

}  // namespace

RowList find_direction_extremes(const PointShards& shards, const SampleShape& shape, double least_length,
                                std::size_t count, std::uint64_t seed) {
  const std::size_t dimension = shards.dimension, rank = shape.rank();
  const double least_sq = least_length * least_length;
  const std::vector<float> directions = random_directions(count, rank, seed);
  const std::vector<ShardBlock> blocks = blocks_of(shards);
  std::vector<std::vector<Extreme>> found(blocks.size());
  for_each_shard_block(shards, blocks, [&](std::size_t index, const ShardBlock& block) {
    const PointShard& part = shards.parts[block.part];
    Tile tile(directions, rank);
    std::vector<double> z(rank * kWhitenedPoints), length_sq(kWhitenedPoints);
    std::vector<std::size_t> rows;
    for (std::size_t first = block.begin; first < block.end; first += kWhitenedPoints) {
      rows.resize(std::min(kWhitenedPoints, block.end - first));
      std::iota(rows.begin(), rows.end(), first);
      shape.whiten(part.points, rows, z.data(), length_sq.data());
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (length_sq[i] >= least_sq)
          tile.add(z.data(), i, static_cast<std::uint32_t>(part.first_row + rows[i]));
    }
    found[index] = tile.finish();
  });
  std::vector<Extreme> best(count, Extreme{-HUGE_VALF});
  for (const std::vector<Extreme>& block : found)
    for (std::size_t i = 0; i < count; ++i)
      if (block[i].is_before(best[i])) best[i] = block[i];

  // Each process says product, id and coordinates of its own; an id that is too large: it has none.
  const std::size_t entry = 2 + dimension;
  std::vector<double> mine(count * entry, 0.0);
  std::vector<std::uint32_t> by_id(count);
  std::iota(by_id.begin(), by_id.end(), 0u);
  std::sort(by_id.begin(), by_id.end(), [&](auto a, auto b) { return best[a].id < best[b].id; });
  RowCopier copier(shards);
  for (const std::uint32_t i : by_id) {
    mine[i * entry] = static_cast<double>(best[i].product);
    mine[i * entry + 1] = static_cast<double>(best[i].id);
    if (best[i].id != Extreme::kNoPoint) copier.copy(best[i].id, mine.data() + i * entry + 2);
  }
  const std::vector<double> all = shards.all_gather(std::move(mine));
  struct Row {
    std::uint32_t id;
    const double* coordinates;
  };
  std::vector<Row> rows;
  for (std::size_t i = 0; i < count; ++i) {
    Extreme furthest{-HUGE_VALF};
    const double* coordinates = nullptr;
    for (std::size_t at = i * entry; at < all.size(); at += count * entry) {
      const Extreme extreme{static_cast<float>(all[at]), static_cast<std::uint32_t>(all[at + 1])};
      if (!extreme.is_before(furthest)) continue;
      furthest = extreme;
      coordinates = all.data() + at + 2;
    }
    if (coordinates != nullptr) rows.push_back({furthest.id, coordinates});
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  RowList list;
  for (const Row& row : rows) {
    if (!list.ids.empty() && list.ids.back() == row.id) continue;
    list.ids.push_back(row.id);
    list.rows.insert(list.rows.end(), row.coordinates, row.coordinates + dimension);
  }
  return list;
}

}  // namespace ndhull
