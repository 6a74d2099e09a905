// A point set in parts: the rows that this process holds, and what processes tell each other about theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/points.h"

namespace ndhull {

/// Several processes that work on one point set. Each call is made by all of them, in the same order.
class ShardExchange {
 public:
  virtual ~ShardExchange() = default;
  /// The numbers of all processes, one after the other in the order of the processes; every process gets
  /// them.
  virtual std::vector<double> all_gather(std::span<const double> mine) const = 0;
  /// The same for the first process alone; the others get nothing.
  virtual std::vector<double> gather_to_first(std::span<const double> mine) const = 0;
  virtual bool is_first() const = 0;
};

/// Rows that stand together in memory.
struct PointShard {
  PointView points;
  std::size_t first_row = 0;  ///< of the whole set
};

/// The parts that this process holds. Rows are counted in the whole set.
struct PointShards {
  /// Ascending. All rows of a process come before those of the next one.
  std::vector<PointShard> parts;
  std::size_t rows = 0;  ///< of the whole set
  std::size_t dimension = 0;
  ScalarType type = ScalarType::kFloat64;   ///< kFloat32: all parts of all processes are
  const ShardExchange* exchange = nullptr;  ///< null: this process holds all rows

  /// One part that is the whole.
  static PointShards whole(const PointView& points);

  std::vector<double> all_gather(std::vector<double> mine) const;
  /// Does any process say so? The answer is the same for all.
  bool any(bool mine) const;
};

/// All rows that this process holds, ascending.
std::vector<std::uint32_t> rows_of(const PointShards& shards);

/// Rows of one part that one thread takes at a time: 1 MB of 8-d single precision. A multiple of 64.
inline constexpr std::size_t kShardBlock = 1 << 15;

/// Some rows of a part.
struct ShardBlock {
  std::size_t part, begin, end;
};
std::vector<ShardBlock> blocks_of(const PointShards& shards);

/// Calls work(block index, block) for all blocks, shared among threads, and gives back the memory of each.
void for_each_shard_block(const PointShards& shards, const std::vector<ShardBlock>& blocks,
                          const std::function<void(std::size_t, const ShardBlock&)>& work);

/// Gives the memory of rows begin .. end back when they are a mapped file: they come again when they are
/// read.
void give_back_rows(const PointView& points, std::size_t begin, std::size_t end);

/// Copies single rows, ascending rows of the whole set that this process holds, as doubles; of a mapped file
/// what was passed goes back.
class RowCopier {
 public:
  explicit RowCopier(const PointShards& shards) : shards_(shards) {}
  RowCopier(const RowCopier&) = delete;
  RowCopier& operator=(const RowCopier&) = delete;
  ~RowCopier() { give_back(); }

  void copy(std::size_t row, double* out);

 private:
  void give_back() const;

  const PointShards& shards_;
  std::size_t part_ = 0, block_ = 0;  // what the last row was in: block_ is the block's first row of the part
};

}  // namespace ndhull
