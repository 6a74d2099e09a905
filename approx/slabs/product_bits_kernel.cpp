#include "approx/slabs/product_bits_kernel.h"

#include <algorithm>
#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "approx/slabs/product_bits_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include "core/dimension_switch.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// How far a sum in single precision may be from a product.
template <std::size_t D>
HWY_INLINE float error_of(float length_sq, float reach, float limit) {
  constexpr float kRounding = static_cast<float>(D + 8) * 0x1p-24f;
  return kRounding * (std::sqrt(length_sq) * reach + std::abs(limit));
}

#if HWY_TARGET == HWY_SCALAR

template <std::size_t D>
ProductBits compare_row(const FloatPoints& points, const float* plane, const std::uint32_t* ids,
                        float limit) {
  float length_sq = 0.0f;
  for (std::size_t k = 0; k < D; ++k) length_sq += plane[k] * plane[k];
  const float error = error_of<D>(length_sq, points.reach(), limit);
  unsigned at_least = 0, may_be = 0;
  for (std::size_t i = 0; i < D; ++i) {
    const float* const y = points.data() + std::size_t{ids[i]} * FloatPoints::stride(D);
    float sum = 0.0f;
    for (std::size_t k = 0; k < D; ++k) sum += plane[k] * y[k];
    at_least |= (sum >= limit + error ? 1u : 0u) << i;
    may_be |= (sum >= limit - error ? 1u : 0u) << i;
  }
  return {static_cast<std::uint16_t>(at_least), static_cast<std::uint16_t>(may_be & ~at_least)};
}

#else

/// Four vectors of products to one of their sums.
template <class Tag, class Vec = hn::Vec<Tag> >
HWY_INLINE hn::Vec<hn::CappedTag<float, 4> > sums_of_four(Tag tag, Vec a, Vec b, Vec c, Vec d) {
  const hn::RepartitionToWide<Tag> pairs;
  const Vec first = hn::Add(hn::InterleaveLower(tag, a, b), hn::InterleaveUpper(tag, a, b));
  const Vec last = hn::Add(hn::InterleaveLower(tag, c, d), hn::InterleaveUpper(tag, c, d));
  const auto even = hn::InterleaveLower(pairs, hn::BitCast(pairs, first), hn::BitCast(pairs, last));
  const auto odd = hn::InterleaveUpper(pairs, hn::BitCast(pairs, first), hn::BitCast(pairs, last));
  const Vec sums = hn::Add(hn::BitCast(tag, even), hn::BitCast(tag, odd));  // of each 16 bytes
  if constexpr (hn::MaxLanes(tag) == 8) {
    return hn::Add(hn::LowerHalf(sums), hn::UpperHalf(hn::Half<Tag>(), sums));
  } else {
    return sums;
  }
}

/// `plane`: filled up with zeros.
template <std::size_t D>
HWY_INLINE ProductBits compare_row(const FloatPoints& points, const float* plane, const std::uint32_t* ids,
                                   float limit) {
  constexpr std::size_t kStride = FloatPoints::stride(D);
  constexpr hn::CappedTag<float, (kStride < 8 ? 4 : 8)> tag;
  constexpr hn::CappedTag<float, 4> four;
  constexpr std::size_t kLanes = hn::MaxLanes(tag), kParts = kStride / kLanes;
  hn::Vec<decltype(tag)> parts[kParts];
  auto squares = hn::Zero(tag);
  for (std::size_t part = 0; part < kParts; ++part) {
    parts[part] = hn::LoadU(tag, plane + part * kLanes);
    squares = hn::MulAdd(parts[part], parts[part], squares);
  }
  const auto product = [&](std::size_t k) HWY_ATTR {
    const float* const y = points.data() + std::size_t{ids[std::min(k, D - 1)]} * kStride;
    auto sum = hn::Mul(parts[0], hn::LoadU(tag, y));
    for (std::size_t part = 1; part < kParts; ++part)
      sum = hn::MulAdd(parts[part], hn::LoadU(tag, y + part * kLanes), sum);
    return sum;
  };
  const float error = error_of<D>(hn::GetLane(hn::SumOfLanes(tag, squares)), points.reach(), limit);
  const auto sure = hn::Set(four, limit + error), possible = hn::Set(four, limit - error);
  unsigned at_least = 0, may_be = 0;
  for (std::size_t k = 0; k < D; k += 4) {
    const auto sums = sums_of_four(tag, product(k), product(k + 1), product(k + 2), product(k + 3));
    std::uint8_t bytes[2][8];
    hn::StoreMaskBits(four, hn::Ge(sums, sure), bytes[0]);
    hn::StoreMaskBits(four, hn::Ge(sums, possible), bytes[1]);
    at_least |= static_cast<unsigned>(bytes[0][0]) << k;
    may_be |= static_cast<unsigned>(bytes[1][0]) << k;
  }
  constexpr unsigned kAll = (1u << D) - 1;
  return {static_cast<std::uint16_t>(at_least & kAll), static_cast<std::uint16_t>(may_be & ~at_least & kAll)};
}

#endif

template <std::size_t D>
void compare_products_of(const FloatPoints& points, const double* planes, const std::uint32_t* ids,
                         std::span<const double> least, std::span<ProductBits> bits) {
  constexpr std::size_t kStride = FloatPoints::stride(D), kRows = 64;
  // All of them before the first is read: a vector is not read soon after its parts were written.
  float rows[kRows * kStride];
  for (std::size_t begin = 0; begin < least.size(); begin += kRows) {
    const std::size_t count = std::min(kRows, least.size() - begin);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < kStride; ++k)
        rows[i * kStride + k] = k < D ? static_cast<float>(planes[(begin + i) * D + k]) : 0.0f;
    for (std::size_t i = 0; i < count; ++i)
      bits[begin + i] = compare_row<D>(points, rows + i * kStride, ids + (begin + i) * D,
                                       static_cast<float>(least[begin + i]));
  }
}

void compare_products_any(const FloatPoints& points, const double* planes, const std::uint32_t* ids,
                          std::span<const double> least, std::span<ProductBits> bits) {
  call_with_dimension<2, kMaxRank>(points.rank(),
                                   [&](auto d) { compare_products_of<d>(points, planes, ids, least, bits); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

FloatPoints::FloatPoints(std::size_t rank, std::span<const double> coordinates)
    : rank_(rank), values_(coordinates.size() / rank * stride(rank), 0.0f) {
  double reach_sq = 0.0;
  for (std::size_t row = 0; row < coordinates.size() / rank; ++row) {
    double length_sq = 0.0;
    for (std::size_t k = 0; k < rank; ++k) {
      const double entry = coordinates[row * rank + k];
      values_[row * stride(rank) + k] = static_cast<float>(entry);
      length_sq += entry * entry;
    }
    reach_sq = std::max(reach_sq, length_sq);
  }
  reach_ = static_cast<float>(std::sqrt(reach_sq) * (1.0 + 1e-6));
}

void compare_products(const FloatPoints& points, const double* planes, const std::uint32_t* ids,
                      std::span<const double> least, std::span<ProductBits> bits) {
  NDHULL_BEST_OF(compare_products_any)(points, planes, ids, least, bits);
}

}  // namespace ndhull
#endif
