#include "core/column_table.h"

#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/column_table.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>

#include "core/error.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One block's largest product goes into `best` when it is larger than what is there. A block's products stay
/// in registers; looking for the place of the largest is rare.
void search_blocks(const double* values, std::size_t blocks, std::size_t block_width, std::size_t rows,
                   const double* multipliers, double& best_product, std::size_t& best_column) {
  const hn::CappedTag<double, 8> tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t group = 4 * lanes;
  const std::size_t stride = block_width;
  HWY_ALIGN double products[32];
  auto bar = hn::Set(tag, best_product);
  for (std::size_t block = 0; block < blocks; ++block) {
    const double* const begin = values + block * rows * stride;
    for (std::size_t first = 0; first < block_width; first += group) {
      const double* at = begin + first;
      auto a = hn::Zero(tag), b = a, c = a, d = a;
      for (std::size_t row = 0; row < rows; ++row, at += stride) {
        const auto factor = hn::Set(tag, multipliers[row]);
        a = hn::MulAdd(factor, hn::LoadU(tag, at), a);
        b = hn::MulAdd(factor, hn::LoadU(tag, at + lanes), b);
        c = hn::MulAdd(factor, hn::LoadU(tag, at + 2 * lanes), c);
        d = hn::MulAdd(factor, hn::LoadU(tag, at + 3 * lanes), d);
      }
      const auto largest = hn::Max(hn::Max(a, b), hn::Max(c, d));
      if (hn::AllFalse(tag, hn::Gt(largest, bar))) continue;
      hn::Store(a, tag, products);
      hn::Store(b, tag, products + lanes);
      hn::Store(c, tag, products + 2 * lanes);
      hn::Store(d, tag, products + 3 * lanes);
      for (std::size_t k = 0; k < group; ++k) {
        if (!(products[k] > best_product)) continue;
        best_product = products[k];
        best_column = block * block_width + first + k;
      }
      bar = hn::Set(tag, best_product);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

ColumnTable::ColumnTable(std::size_t height, std::size_t count)
    : height_(height),
      count_(count),
      values_((count + kBlock - 1) / kBlock * kBlock * (height + 1)),
      multipliers_(height + 1),
      entries_(height) {}

void ColumnTable::set(std::size_t column, std::span<const double> entries, double cost) {
  NDHULL_CHECK(column < count_ && entries.size() == height_);
  // The last column is repeated to the end of its block: a repetition is never the first of a tie.
  const std::size_t copies = column + 1 == count_ ? values_.size() / (height_ + 1) - column : 1;
  for (std::size_t copy = column; copy < column + copies; ++copy) {
    for (std::size_t row = 0; row < height_; ++row) values_[index(copy, row)] = entries[row];
    values_[index(copy, height_)] = cost;
  }
}

ColumnTable::Best ColumnTable::largest_product(std::span<const double> multipliers) const {
  NDHULL_CHECK(count_ > 0 && multipliers.size() == height_ + 1);
  Best best{0, -HUGE_VAL};
  const std::size_t blocks = values_.size() / (kBlock * (height_ + 1));
  NDHULL_BEST_OF(search_blocks)
  (values_.data(), blocks, kBlock, height_ + 1, multipliers.data(), best.product, best.column);
  return best;
}

std::optional<LpColumn> ColumnTable::price(const LpQuery& query) {
  if (count_ == 0) return std::nullopt;
  std::copy(query.duals.begin(), query.duals.end(), multipliers_.begin());
  multipliers_.back() = -query.cost_weight;
  return column(largest_product(multipliers_).column);
}

LpColumn ColumnTable::column(std::size_t column) {
  for (std::size_t row = 0; row < height_; ++row) entries_[row] = entry(column, row);
  return {LpColumnId{static_cast<std::uint32_t>(column)}, cost(column), entries_};
}

}  // namespace ndhull
#endif
