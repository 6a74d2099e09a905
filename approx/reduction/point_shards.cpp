#include "approx/reduction/point_shards.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "core/error.h"
#include "core/machine/blocks.h"
#include "core/machine/huge_array.h"

namespace ndhull {

PointShards PointShards::whole(const PointView& points) {
  PointShards shards;
  shards.parts.push_back({points, 0});
  shards.rows = points.rows;
  shards.dimension = points.dimension;
  shards.type = points.type;
  return shards;
}

std::vector<double> PointShards::all_gather(std::vector<double> mine) const {
  return exchange == nullptr ? std::move(mine) : exchange->all_gather(mine);
}

bool PointShards::any(bool mine) const {
  const std::vector<double> said = all_gather({mine ? 1.0 : 0.0});
  return std::find(said.begin(), said.end(), 1.0) != said.end();
}

std::vector<std::uint32_t> rows_of(const PointShards& shards) {
  std::vector<std::uint32_t> rows;
  for (const PointShard& part : shards.parts) {
    const std::size_t first = rows.size();
    rows.resize(first + part.points.rows);
    std::iota(rows.begin() + static_cast<std::ptrdiff_t>(first), rows.end(),
              static_cast<std::uint32_t>(part.first_row));
  }
  return rows;
}

std::vector<ShardBlock> blocks_of(const PointShards& shards) {
  std::vector<ShardBlock> blocks;
  for (std::size_t part = 0; part < shards.parts.size(); ++part) {
    const std::size_t rows = shards.parts[part].points.rows;
    for (std::size_t begin = 0; begin < rows; begin += kShardBlock)
      blocks.push_back({part, begin, std::min(rows, begin + kShardBlock)});
  }
  return blocks;
}

void for_each_shard_block(const PointShards& shards, const std::vector<ShardBlock>& blocks,
                          const std::function<void(std::size_t, const ShardBlock&)>& work) {
  for_each_block(blocks.size(), 1, [&](std::size_t index, std::size_t) {
    const ShardBlock& block = blocks[index];
    work(index, block);
    give_back_rows(shards.parts[block.part].points, block.begin, block.end);
  });
}

// Systems map 2 MiB of a file at once where they can: whatever is read next to what was given back would
// bring it all again. So whole such parts go, also those that another thread is reading: its pages come
// again.
void give_back_rows(const PointView& points, std::size_t begin, std::size_t end) {
  if (!points.is_file_mapping || begin >= end) return;
  constexpr std::uintptr_t kMappedAtOnce = std::uintptr_t{1} << 21;
  const std::size_t size = points.type == ScalarType::kFloat32 ? sizeof(float) : sizeof(double);
  const std::size_t columns = points.column_stride == 1 ? 1 : points.dimension;
  const auto data = reinterpret_cast<std::uintptr_t>(points.data);
  const std::uintptr_t data_end = data + points.rows * points.dimension * size;
  for (std::size_t column = 0; column < columns; ++column) {
    const std::uintptr_t at = data + column * points.column_stride * size;
    const std::uintptr_t first = (at + begin * points.row_stride * size) / kMappedAtOnce * kMappedAtOnce;
    const std::uintptr_t last =
        (at + end * points.row_stride * size + kMappedAtOnce - 1) / kMappedAtOnce * kMappedAtOnce;
    discard_pages(reinterpret_cast<void*>(std::max(first, data)),
                  reinterpret_cast<void*>(std::min(last, data_end)));
  }
}

void RowCopier::copy(std::size_t row, double* out) {
  const auto holds = [&](const PointShard& part) {
    return row >= part.first_row && row < part.first_row + part.points.rows;
  };
  std::size_t part = part_;
  while (part < shards_.parts.size() && !holds(shards_.parts[part])) ++part;
  NDHULL_CHECK(part < shards_.parts.size());
  const PointShard& shard = shards_.parts[part];
  const std::size_t block = (row - shard.first_row) / kShardBlock * kShardBlock;
  shard.points.copy_row(row - shard.first_row, out);
  if (part == part_ && block == block_) return;
  give_back();
  part_ = part;
  block_ = block;
}

void RowCopier::give_back() const {
  if (part_ >= shards_.parts.size()) return;
  const PointView& points = shards_.parts[part_].points;
  if (block_ < points.rows) give_back_rows(points, block_, std::min(block_ + kShardBlock, points.rows));
}

}  // namespace ndhull
