// The growth loops, compiled once for each instruction set and each dimension; the best set that the
// machine has is chosen at run time (Highway).
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/growth/growth_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include "core/dimension_switch.h"
#include "core/growth/cone-inl.h"
#include "core/growth/grower-inl.h"
#include "core/growth/grower_tables-inl.h"
#include "core/growth/match-inl.h"
#include "core/growth/partition-inl.h"
#include "core/growth/regions-inl.h"
#include "core/growth/shared_search-inl.h"
#include "core/growth/visible_set-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

template <std::size_t D>
GrowthStop run_in_dimension(GrowthWork& work) {
  auto grower = std::static_pointer_cast<Grower<D>>(std::exchange(work.grower, nullptr));
  if (!grower || !grower->may_go_on()) grower = std::make_shared<Grower<D>>(work);
  const GrowthStop stop = grower->run();
  if (stop == GrowthStop::kPaused || stop == GrowthStop::kNoOutsidePoints) work.grower = std::move(grower);
  return stop;
}

GrowthStop run_growth(GrowthWork& work) {
  return call_with_dimension<2, kMaxRank>(work.rank, [&](auto d) { return run_in_dimension<d>(work); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

GrowthStop grow(GrowthWork& work) {
  const GrowthStop stop = NDHULL_BEST_OF(run_growth)(work);
  work.gauges = OutsideHeights();
  if (stop == GrowthStop::kNoOutsidePoints) {
    forget_outside(work);
    work.parting.begin_anew();  // what comes next are other points
  }
  return stop;
}

}  // namespace ndhull
#endif
