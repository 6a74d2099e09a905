// The growth loops, compiled once for each instruction set and each dimension; the best set that the
// machine has is chosen at run time (Highway).
#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/growth_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include "core/cone-inl.h"
#include "core/grower-inl.h"
#include "core/visible_set-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

template <std::size_t D>
GrowthStop run_in_dimension(GrowthWork& work) {
  return Grower<D>(work).run();
}

GrowthStop run_growth(GrowthWork& work) {
  switch (work.rank) {
// clang-format off
#define NDHULL_CASE(D) case D: return run_in_dimension<D>(work);
    NDHULL_CASE(2) NDHULL_CASE(3) NDHULL_CASE(4) NDHULL_CASE(5) NDHULL_CASE(6)
    NDHULL_CASE(7) NDHULL_CASE(8) NDHULL_CASE(9) NDHULL_CASE(10) NDHULL_CASE(11)
    NDHULL_CASE(12) NDHULL_CASE(13) NDHULL_CASE(14) NDHULL_CASE(15) NDHULL_CASE(16)
#undef NDHULL_CASE
        // clang-format on
        default : NDHULL_CHECK(!"rank is checked before growth starts");
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {
HWY_EXPORT(run_growth);

GrowthStop grow(GrowthWork& work) { return HWY_DYNAMIC_DISPATCH(run_growth)(work); }

}  // namespace ndhull
#endif
