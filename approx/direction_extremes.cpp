#include "approx/direction_extremes.h"

#include <algorithm>
#include <cmath>

#include "core/portable_random.h"

namespace ndhull {
namespace {

/// Points that are multiplied with all directions at a time; their coordinates stay in the first-level cache.
constexpr std::size_t kTile = 128;

struct Extreme {
  float product = -HUGE_VALF;
  std::uint32_t id = 0xFFFF'FFFFu;
  bool is_before(const Extreme& other) const {
    return product != other.product ? product > other.product : id < other.id;
  }
};

/// One thread's look at some blocks.
class Tile {
 public:
  Tile(const std::vector<float>& directions, std::size_t rank)
      : directions_(directions), rank_(rank), values_(rank * kTile), best_(directions.size() / rank) {
    ids_.reserve(kTile);
  }

  void add(const double* point, std::uint32_t id) {
    for (std::size_t k = 0; k < rank_; ++k) values_[k * kTile + ids_.size()] = static_cast<float>(point[k]);
    ids_.push_back(id);
    if (ids_.size() == kTile) finish();
  }

  /// Of the points added, in ascending order, the furthest along each direction.
  const std::vector<Extreme>& finish() {
    float products[kTile];
    for (std::size_t direction = 0; direction < best_.size() && !ids_.empty(); ++direction) {
      const float* const u = directions_.data() + direction * rank_;
      for (float& product : products) product = 0.0F;
      for (std::size_t k = 0; k < rank_; ++k) {
        const float* const column = values_.data() + k * kTile;
        for (std::size_t i = 0; i < kTile; ++i) products[i] += u[k] * column[i];
      }
      float highest = best_[direction].product;
      for (std::size_t i = 0; i < kTile; ++i) highest = std::max(highest, products[i]);
      if (highest == best_[direction].product) continue;
      for (std::size_t i = 0; i < ids_.size(); ++i)
        if (products[i] > best_[direction].product) best_[direction] = {products[i], ids_[i]};
    }
    ids_.clear();
    std::fill(values_.begin(), values_.end(), 0.0F);
    return best_;
  }

 private:
  const std::vector<float>& directions_;
  std::size_t rank_;
  std::vector<float> values_;  // rank x kTile; 0 where there is no point
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

RowList find_direction_extremes(const PointShards& shards, const Frame& frame, double least_length,
                                std::size_t count, std::uint64_t seed) {
  const std::size_t dimension = shards.dimension, rank = frame.rank;
  const std::vector<float> directions = random_directions(count, rank, seed);
  const std::vector<ShardBlock> blocks = blocks_of(shards);
  std::vector<std::vector<Extreme>> found(blocks.size());
  for_each_shard_block(shards, blocks, [&](std::size_t index, const ShardBlock& block) {
    const PointShard& part = shards.parts[block.part];
    Tile tile(directions, rank);
    std::vector<double> shifted(dimension), point(rank);
    for (std::size_t row = block.begin; row < block.end; ++row) {
      for (std::size_t k = 0; k < dimension; ++k) shifted[k] = part.points.at(row, k) - frame.centre[k];
      double length_sq = 0.0;
      for (std::size_t r = 0; r < rank; ++r) {
        double y = 0.0;
        if (frame.is_diagonal) {
          y = frame.map[r * dimension + r] * shifted[r];
        } else {
          for (std::size_t k = 0; k < dimension; ++k) y += frame.map[r * dimension + k] * shifted[k];
        }
        point[r] = y;
        length_sq += y * y;
      }
      if (length_sq >= least_length * least_length)
        tile.add(point.data(), static_cast<std::uint32_t>(part.first_row + row));
    }
    found[index] = tile.finish();
  });
  std::vector<Extreme> best(count);
  for (const std::vector<Extreme>& block : found)
    for (std::size_t i = 0; i < count; ++i)
      if (block[i].is_before(best[i])) best[i] = block[i];

  // Each process says product, id and coordinates of its own; an id that is too large: it has none.
  const std::size_t entry = 2 + dimension;
  std::vector<double> mine(count * entry, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    mine[i * entry] = static_cast<double>(best[i].product);
    mine[i * entry + 1] = static_cast<double>(best[i].id);
    if (best[i].id == Extreme{}.id) continue;
    RowCopier(shards).copy(best[i].id, mine.data() + i * entry + 2);
  }
  const std::vector<double> all = shards.all_gather(std::move(mine));
  struct Row {
    std::uint32_t id;
    const double* coordinates;
  };
  std::vector<Row> rows;
  for (std::size_t i = 0; i < count; ++i) {
    Extreme furthest;
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
