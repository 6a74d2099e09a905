// Which instruction sets the loops are compiled for, and which of them runs. Included before
// <hwy/foreach_target.h>.
//
// Three are enough on x86-64: what every machine has, AVX2 and AVX-512. Elsewhere there is one, that of the
// compiler's target. Highway is used by its headers alone: its library measures a clock when it is loaded, 3
// ms that a process with a small hull would take twice as long for.
#pragma once

#if defined(__x86_64__)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#else
#define HWY_COMPILE_ONLY_STATIC
#endif
#define HWY_IS_DEBUG_BUILD 0  // failed checks would call the library

#include <type_traits>

namespace ndhull {

/// The instruction sets that loops are compiled for on x86-64.
enum class SimdTarget { kBaseline, kAvx2, kAvx3 };

/// The best that this machine has; the system has to keep its registers too.
SimdTarget best_simd_target();

/// One function, compiled for each of the sets; null: the compiler could not.
template <class Function>
Function* best_of(Function* baseline, std::type_identity_t<Function>* avx2,
                  std::type_identity_t<Function>* avx3) {
  const SimdTarget best = best_simd_target();
  if (best == SimdTarget::kAvx3 && avx3 != nullptr) return avx3;
  if (best >= SimdTarget::kAvx2 && avx2 != nullptr) return avx2;
  return baseline;
}

}  // namespace ndhull

/// The function of the best set, to be called. Once per source (HWY_ONCE), in the namespace around
/// HWY_NAMESPACE.
#define NDHULL_BEST_OF(function) \
  ::ndhull::best_of(&HWY_STATIC_DISPATCH(function), HWY_CHOOSE_AVX2(function), HWY_CHOOSE_AVX3(function))
