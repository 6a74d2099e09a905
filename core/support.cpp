#include "core/support.h"

#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/support.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include "core/dimension_switch.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <std::size_t D>
double largest_of(const double* direction, const double* columns, std::size_t stride, double* dots) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag);
  auto largest = hn::Set(tag, -HUGE_VAL);
  for (std::size_t row = 0; row < stride; row += lanes) {
    auto dot = hn::Mul(hn::Set(tag, direction[0]), hn::LoadU(tag, columns + row));
    for (std::size_t k = 1; k < D; ++k) {
      dot = hn::MulAdd(hn::Set(tag, direction[k]), hn::LoadU(tag, columns + k * stride + row), dot);
    }
    hn::StoreU(dot, tag, dots + row);
    largest = hn::Max(largest, dot);
  }
  return hn::GetLane(hn::MaxOfLanes(tag, largest));
}

std::uint32_t find_support(std::size_t dimension, const double* direction, const double* columns,
                           std::size_t stride, double* dots) {
  double largest = 0.0;
  call_with_dimension<1, kMaxRank>(
      dimension, [&](auto d) { largest = largest_of<d>(direction, columns, stride, dots); });
  const hn::ScalableTag<double> tag;
  for (std::size_t row = 0; row < stride; row += hn::Lanes(tag)) {
    const auto equal = hn::Eq(hn::LoadU(tag, dots + row), hn::Set(tag, largest));
    const std::intptr_t found = hn::FindFirstTrue(tag, equal);
    if (found >= 0) return static_cast<std::uint32_t>(row) + static_cast<std::uint32_t>(found);
  }
  return 0;
}

void find_rows_above(const double* dots, std::size_t count, double low, std::vector<std::uint32_t>& rows) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag);
  const auto least = hn::Set(tag, low);
  for (std::size_t row = 0; row < count; row += lanes) {
    if (hn::AllFalse(tag, hn::Ge(hn::LoadU(tag, dots + row), least))) continue;
    for (std::size_t i = row; i < row + lanes && i < count; ++i)
      if (dots[i] >= low) rows.push_back(static_cast<std::uint32_t>(i));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {
HWY_EXPORT(find_support);
HWY_EXPORT(find_rows_above);

void SupportTable::assign(std::size_t dimension, std::span<const double> rows) {
  dimension_ = dimension;
  count_ = rows.size() / dimension;
  constexpr std::size_t kWholeVectors = 256 / sizeof(double);  // the longest of any instruction set
  stride_ = (count_ + kWholeVectors - 1) / kWholeVectors * kWholeVectors;
  columns_.resize(dimension * stride_);
  for (std::size_t row = 0; row < stride_; ++row) {
    const std::size_t from = row < count_ ? row : count_ - 1;
    for (std::size_t k = 0; k < dimension; ++k) columns_[k * stride_ + row] = rows[from * dimension + k];
  }
}

std::uint32_t SupportTable::find(const double* direction, double* dots) const {
  return HWY_DYNAMIC_DISPATCH(find_support)(dimension_, direction, columns_.data(), stride_, dots);
}

void SupportTable::rows_above(const double* dots, double low, std::vector<std::uint32_t>& rows) const {
  HWY_DYNAMIC_DISPATCH(find_rows_above)(dots, count_, low, rows);
}

}  // namespace ndhull
#endif
