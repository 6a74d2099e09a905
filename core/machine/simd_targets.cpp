#include "core/machine/simd_targets.h"

namespace ndhull {
namespace {

#if defined(__x86_64__)
// What Highway's code for these sets may use, but for F16C and LZCNT, which each machine with AVX2, FMA and
// BMI2 has.
SimdTarget find_best_target() {
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
                        __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
  const bool has_avx3 = has_avx2 && __builtin_cpu_supports("avx512f") != 0 &&
                        __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                        __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512cd") != 0;
  return has_avx3 ? SimdTarget::kAvx3 : has_avx2 ? SimdTarget::kAvx2 : SimdTarget::kBaseline;
}
#else
SimdTarget find_best_target() { return SimdTarget::kBaseline; }
#endif

}  // namespace

SimdTarget best_simd_target() {
  static const SimdTarget best = find_best_target();
  return best;
}

}  // namespace ndhull
