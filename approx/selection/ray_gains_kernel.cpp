// Four vectors of planes at once hide the latency of the sums. Most planes are behind the first plane of a
// ray: that is known from the four products, and nothing else is done then.

#include "approx/selection/ray_gains_kernel.h"

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "approx/selection/ray_gains_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void add_gains_in_vectors(const double* HWY_RESTRICT planes, std::size_t rank, const RayChanges& changes,
                          double* HWY_RESTRICT gains) {
  const hn::CappedTag<double, 8> tag;
  using Vector = hn::Vec<decltype(tag)>;
  const std::size_t lanes = hn::Lanes(tag);
  for (std::size_t begin = 0; begin < kGainBlock; begin += 4 * lanes) {
    for (std::size_t ray = 0; ray < changes.count(); ++ray) {
      const double* HWY_RESTRICT direction = changes.directions.data() + ray * rank;
      const double* HWY_RESTRICT x = planes + begin;
      auto a = hn::Zero(tag), b = a, c = a, d = a;
      for (std::size_t k = 0; k < rank; ++k, x += kGainBlock) {
        const auto factor = hn::Set(tag, direction[k]);
        a = hn::Add(a, hn::Mul(factor, hn::LoadU(tag, x)));
        b = hn::Add(b, hn::Mul(factor, hn::LoadU(tag, x + lanes)));
        c = hn::Add(c, hn::Mul(factor, hn::LoadU(tag, x + 2 * lanes)));
        d = hn::Add(d, hn::Mul(factor, hn::LoadU(tag, x + 3 * lanes)));
      }
      const auto lower = hn::Set(tag, changes.lower[ray]);
      if (hn::AllFalse(tag, hn::Gt(hn::Max(hn::Max(a, b), hn::Max(c, d)), lower))) continue;
      const auto upper = hn::Set(tag, changes.upper[ray]), sign = hn::Set(tag, changes.sign[ray]);
      const auto difference = hn::Set(tag, changes.difference[ray]),
                 shorter = hn::Set(tag, changes.shorter[ray]);
      const auto add = [&](Vector slope, double* HWY_RESTRICT to) {
        const auto length = hn::Div(hn::Set(tag, 1.0), slope);
        auto content = length;
        for (std::size_t k = 1; k < rank; ++k) content = hn::Mul(content, length);
        const auto between = hn::Sub(difference, hn::Mul(sign, hn::Sub(content, shorter)));
        const auto change = hn::IfThenElse(hn::Ge(slope, upper), difference, between);
        hn::StoreU(hn::Add(hn::LoadU(tag, to), hn::IfThenElseZero(hn::Gt(slope, lower), change)), tag, to);
      };
      add(a, gains + begin);
      add(b, gains + begin + lanes);
      add(c, gains + begin + 2 * lanes);
      add(d, gains + begin + 3 * lanes);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void add_ray_gains(const double* planes, std::size_t rank, const RayChanges& changes, double* gains) {
  NDHULL_BEST_OF(add_gains_in_vectors)(planes, rank, changes, gains);
}

}  // namespace ndhull
#endif
