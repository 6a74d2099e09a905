// Four directions by two vectors of points at a time: eight sums hide the latency of an addition. Points are
// looked at one by one only where one of them is beyond the extreme so far.
#include "approx/reduction/direction_extremes_kernel.h"

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "approx/reduction/direction_extremes_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Looks at single products, of the points from `first` on.
void raise_by(const float* products, std::size_t lanes, std::size_t first, std::span<const std::uint32_t> ids,
              DirectionExtreme& extreme) {
  for (std::size_t lane = 0; lane < lanes && first + lane < ids.size(); ++lane)
    if (products[lane] > extreme.product) extreme = {products[lane], ids[first + lane]};
}

/// kCount directions from `directions` on.
template <std::size_t kCount>
HWY_INLINE void raise_group(const float* HWY_RESTRICT columns, std::size_t rank,
                            std::span<const std::uint32_t> ids, const float* HWY_RESTRICT directions,
                            DirectionExtreme* extremes) {
  const hn::CappedTag<float, 16> tag;
  const std::size_t lanes = hn::Lanes(tag);
  HWY_ALIGN float products[2 * HWY_MAX_BYTES / sizeof(float)];
  for (std::size_t first = 0; first < ids.size(); first += 2 * lanes) {
    hn::Vec<decltype(tag)> low[kCount], high[kCount];
    for (std::size_t one = 0; one < kCount; ++one) low[one] = high[one] = hn::Zero(tag);
    for (std::size_t k = 0; k < rank; ++k) {
      const float* HWY_RESTRICT x = columns + k * kExtremeTile + first;
      const auto x_low = hn::LoadU(tag, x), x_high = hn::LoadU(tag, x + lanes);
      for (std::size_t one = 0; one < kCount; ++one) {
        const auto u = hn::Set(tag, directions[one * rank + k]);
        low[one] = hn::Add(low[one], hn::Mul(u, x_low));
        high[one] = hn::Add(high[one], hn::Mul(u, x_high));
      }
    }
    for (std::size_t one = 0; one < kCount; ++one) {
      const auto is_beyond = hn::Gt(hn::Max(low[one], high[one]), hn::Set(tag, extremes[one].product));
      if (hn::AllFalse(tag, is_beyond)) continue;
      hn::Store(low[one], tag, products);
      hn::Store(high[one], tag, products + lanes);
      raise_by(products, 2 * lanes, first, ids, extremes[one]);
    }
  }
}

void raise_in_vectors(const float* columns, std::size_t rank, std::span<const std::uint32_t> ids,
                      const float* directions, std::span<DirectionExtreme> extremes) {
  constexpr std::size_t kGroup = 4;
  std::size_t done = 0;
  for (; done + kGroup <= extremes.size(); done += kGroup)
    raise_group<kGroup>(columns, rank, ids, directions + done * rank, extremes.data() + done);
  for (; done < extremes.size(); ++done)
    raise_group<1>(columns, rank, ids, directions + done * rank, extremes.data() + done);
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void raise_extremes(const float* columns, std::size_t rank, std::span<const std::uint32_t> ids,
                    const float* directions, std::span<DirectionExtreme> extremes) {
  NDHULL_BEST_OF(raise_in_vectors)(columns, rank, ids, directions, extremes);
}
}  // namespace ndhull
#endif
