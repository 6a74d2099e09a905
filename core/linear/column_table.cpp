#include "core/linear/column_table.h"

#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/linear/column_table.cpp"
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
      values_(HugeArray<double>::to_write((count + kBlock - 1) / kBlock * kBlock * (height + 1))),
      multipliers_(height + 1),
      entries_(height) {}

void ColumnTable::set(std::size_t column, std::span<const double> entries, double cost) {
  NDHULL_CHECK(column < count_ && entries.size() == height_);
  for (std::size_t copy = column, end = column + copies_of(column); copy < end; ++copy) {
    for (std::size_t row = 0; row < height_; ++row) values_[index(copy, row)] = entries[row];
    values_[index(copy, height_)] = cost;
  }
}

void ColumnTable::set_cost(std::size_t column, double cost) {
  NDHULL_CHECK(column < count_);
  for (std::size_t copy = column, end = column + copies_of(column); copy < end; ++copy)
    values_[index(copy, height_)] = cost;
}

ColumnTable::Best ColumnTable::largest_product(std::span<const double> multipliers) const {
  return largest_product(multipliers, 0, count_);
}

ColumnTable::Best ColumnTable::largest_product(std::span<const double> multipliers, std::size_t first,
                                               std::size_t last) const {
  NDHULL_CHECK(first < last && last <= count_ && multipliers.size() == height_ + 1);
  Best best{0, -HUGE_VAL};
  const std::size_t begin = first / kBlock, end = (last + kBlock - 1) / kBlock;
  NDHULL_BEST_OF(search_blocks)
  (values_.data() + begin * kBlock * (height_ + 1), end - begin, kBlock, height_ + 1, multipliers.data(),
   best.product, best.column);
  best.column += begin * kBlock;
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
