#include "core/search/outside_heights.h"

#include <algorithm>

namespace ndhull {

void OutsideHeights::reset(std::size_t count) {
  levels_.clear();
  rows_.assign(count, 0);
  for (;;) {
    const std::size_t blocks = std::max<std::size_t>((count + kBlock - 1) / kBlock, 1);
    Level& level = levels_.emplace_back();
    level.values.assign(blocks * kBlock, kNotOutside);
    if (levels_.size() > 1) level.is_dirty.assign(level.values.size(), 0);
    if (blocks == 1) return;
    count = blocks;
  }
}

void OutsideHeights::extend(std::size_t count) {
  const std::vector<std::uint32_t> rows = std::move(rows_);
  const std::vector<double> heights = std::move(levels_[0].values);
  reset(count);
  for (std::uint32_t point = 0; point < rows.size(); ++point)
    if (heights[point] != kNotOutside) put(point, rows[point], heights[point]);
}

void OutsideHeights::mark_dirty(std::size_t level, std::size_t block) {
  Level& at = levels_[level];
  if (at.is_dirty[block] != 0) return;
  at.is_dirty[block] = 1;
  at.dirty.push_back(static_cast<std::uint32_t>(block));
}

double OutsideHeights::largest_in_block(std::size_t level, std::size_t block) const {
  constexpr std::size_t kSideBySide = 8;
  const double* const values = levels_[level].values.data() + block * kBlock;
  double largest[kSideBySide];
  std::copy_n(values, kSideBySide, largest);
  for (std::size_t i = kSideBySide; i < kBlock; i += kSideBySide)
    for (std::size_t k = 0; k < kSideBySide; ++k)
      largest[k] = largest[k] < values[i + k] ? values[i + k] : largest[k];
  return *std::max_element(largest, largest + kSideBySide);
}

std::uint32_t OutsideHeights::lowest_row(std::size_t level, std::size_t block, double height) const {
  std::uint32_t lowest = UINT32_MAX;
  for (std::size_t index = block * kBlock; index < (block + 1) * kBlock; ++index) {
    if (levels_[level].values[index] != height) continue;
    lowest = std::min(lowest, level == 0 ? rows_[index] : lowest_row(level - 1, index, height));
  }
  return lowest;
}

OutsideHeights::Furthest OutsideHeights::furthest() {
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    // What is written marks blocks of the levels above only.
    for (const std::uint32_t block : levels_[level].dirty) {
      levels_[level].is_dirty[block] = 0;
      write(level, block, largest_in_block(level - 1, block));
    }
    levels_[level].dirty.clear();
  }
  const std::size_t top = levels_.size() - 1;
  const double height = largest_in_block(top, 0);
  return {height, height == kNotOutside ? 0 : lowest_row(top, 0, height)};
}

void OutsideHeights::list_above(double height, std::vector<std::uint32_t>& points) const {
  list_above(levels_.size() - 1, 0, height, points);
}

void OutsideHeights::list_above(std::size_t level, std::size_t block, double height,
                                std::vector<std::uint32_t>& points) const {
  for (std::size_t index = block * kBlock; index < (block + 1) * kBlock; ++index) {
    if (!(levels_[level].values[index] > height)) continue;
    if (level == 0) {
      points.push_back(static_cast<std::uint32_t>(index));
    } else {
      list_above(level - 1, index, height, points);
    }
  }
}

}  // namespace ndhull
