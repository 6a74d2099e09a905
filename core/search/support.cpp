#include "core/search/support.h"

#include <array>
#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/search/support.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>

#include "core/dimension_switch.h"
#include "core/machine/mask_bits-inl.h"

#ifndef NDHULL_SUPPORT_BLOCK_
#define NDHULL_SUPPORT_BLOCK_
namespace ndhull {
/// Points of a block: a vector of floats where vectors are longest.
inline constexpr std::size_t kSupportBlock = 16;
}  // namespace ndhull
#endif

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using SupportTag = hn::CappedTag<float, kSupportBlock>;

template <std::size_t D>
float fill_dots(const float* direction, const float* blocks, std::size_t block_count, float* dots) {
  const SupportTag tag;
  auto largest = hn::Set(tag, -HUGE_VALF);
  for (std::size_t block = 0; block < block_count; ++block) {
    for (std::size_t at = 0; at < kSupportBlock; at += hn::Lanes(tag)) {
      const float* column = blocks + block * D * kSupportBlock + at;
      auto dot = hn::Mul(hn::Set(tag, direction[0]), hn::LoadU(tag, column));
      for (std::size_t k = 1; k < D; ++k)
        dot = hn::MulAdd(hn::Set(tag, direction[k]), hn::LoadU(tag, column + k * kSupportBlock), dot);
      hn::StoreU(dot, tag, dots + block * kSupportBlock + at);
      largest = hn::Max(largest, dot);
    }
  }
  return hn::GetLane(hn::MaxOfLanes(tag, largest));
}

float fill_dots_any(std::size_t dimension, const float* direction, const float* blocks,
                    std::size_t block_count, float* dots) {
  float largest = 0.0f;
  call_with_dimension<1, kMaxRank>(
      dimension, [&](auto d) { largest = fill_dots<d>(direction, blocks, block_count, dots); });
  return largest;
}

/// A NaN is not below `low`.
void find_rows_above(const float* dots, std::size_t count, float low, std::vector<std::uint32_t>& rows) {
  const SupportTag tag;
  const auto least = hn::Set(tag, low);
  for (std::size_t row = 0; row < count; row += hn::Lanes(tag)) {
    const auto is_above = hn::Not(hn::Lt(hn::LoadU(tag, dots + row), least));
    if (hn::AllFalse(tag, is_above)) continue;
    for (std::uint64_t bits = bits_of_mask(tag, is_above); bits != 0; bits &= bits - 1) {
      const auto found = static_cast<std::uint32_t>(row) + static_cast<std::uint32_t>(__builtin_ctzll(bits));
      if (found < count) rows.push_back(found);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

SupportTable::SupportTable(std::size_t dimension, std::span<const double> rows)
    : dimension_(dimension), count_(rows.size() / dimension), rows_(rows.data()) {
  double largest = 0.0;
  for (const double x : rows) largest = std::max(largest, std::abs(x));
  if (largest > 0.0) scale_ = std::ldexp(1.0, std::clamp(-std::ilogb(largest) - 1, -1000, 1000));
  // Two roundings of each factor, one of each operation; twice that for what they make of each other.
  rounding_ = static_cast<float>(2 * dimension * (dimension + 3)) * 0x1p-24f;
  const std::size_t block_count = (count_ + kSupportBlock - 1) / kSupportBlock;
  blocks_.resize(block_count * dimension * kSupportBlock);
  for (std::size_t row = 0; row < block_count * kSupportBlock; ++row) {
    const double* from = rows_ + std::min(row, count_ - 1) * dimension;
    float* const to = blocks_.data() + row / kSupportBlock * dimension * kSupportBlock + row % kSupportBlock;
    for (std::size_t k = 0; k < dimension; ++k) to[k * kSupportBlock] = static_cast<float>(from[k] * scale_);
  }
}

std::uint32_t SupportTable::find(const double* direction, SupportProducts& products, double& height) const {
  auto& [dots, candidates] = products;
  std::array<float, kMaxRank> entries;
  for (std::size_t k = 0; k < dimension_; ++k) entries[k] = static_cast<float>(direction[k]);
  const std::size_t block_count = blocks_.size() / (dimension_ * kSupportBlock);
  dots.resize(block_count * kSupportBlock);
  const float largest =
      NDHULL_BEST_OF(fill_dots_any)(dimension_, entries.data(), blocks_.data(), block_count, dots.data());
  candidates.clear();
  NDHULL_BEST_OF(find_rows_above)(dots.data(), count_, largest - 2.0f * rounding_, candidates);
  std::uint32_t furthest = 0;
  height = -HUGE_VAL;
  for (const std::uint32_t row : candidates) {
    double dot = 0.0;
    for (std::size_t k = 0; k < dimension_; ++k) dot += direction[k] * rows_[row * dimension_ + k];
    if (dot <= height) continue;
    height = dot;
    furthest = row;
  }
  return furthest;
}

void SupportTable::rows_above(const SupportProducts& products, double low, std::size_t end,
                              std::vector<std::uint32_t>& rows) const {
  const auto least = static_cast<float>(low * scale_) - rounding_;
  NDHULL_BEST_OF(find_rows_above)(products.dots.data(), end, least, rows);
}

}  // namespace ndhull
#endif
