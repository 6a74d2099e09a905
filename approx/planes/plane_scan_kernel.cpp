// Eight accumulators of one vector each: enough to hide the latency of a multiply-add; coordinates come from
// the first-level cache, where a block of 64 points fits up to 60-d. A store happens only where a lane passes
// the threshold.

#include "approx/planes/plane_scan_kernel.h"

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "approx/planes/plane_scan_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void find_above_in_vectors(const ScanPlanes& planes, const double* HWY_RESTRICT block,
                           std::vector<ScanHit>& hits) {
  const hn::CappedTag<double, 8> tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t group = 8 * lanes;
  const std::size_t dimension = planes.dimension;
  HWY_ALIGN double values[kScanBlock];
  for (std::size_t row = 0; row < planes.offsets.size(); ++row) {
    const double* HWY_RESTRICT normal = planes.normals.data() + row * dimension;
    const auto offset = hn::Set(tag, planes.offsets[row]);
    const auto threshold = hn::Set(tag, planes.thresholds[row]);
    for (std::size_t begin = 0; begin < kScanBlock; begin += group) {
      auto v0 = offset, v1 = offset, v2 = offset, v3 = offset;
      auto v4 = offset, v5 = offset, v6 = offset, v7 = offset;
      const double* HWY_RESTRICT x = block + begin;
      for (std::size_t k = 0; k < dimension; ++k, x += kScanBlock) {
        const auto factor = hn::Set(tag, normal[k]);
        v0 = hn::MulAdd(factor, hn::LoadU(tag, x), v0);
        v1 = hn::MulAdd(factor, hn::LoadU(tag, x + lanes), v1);
        v2 = hn::MulAdd(factor, hn::LoadU(tag, x + 2 * lanes), v2);
        v3 = hn::MulAdd(factor, hn::LoadU(tag, x + 3 * lanes), v3);
        v4 = hn::MulAdd(factor, hn::LoadU(tag, x + 4 * lanes), v4);
        v5 = hn::MulAdd(factor, hn::LoadU(tag, x + 5 * lanes), v5);
        v6 = hn::MulAdd(factor, hn::LoadU(tag, x + 6 * lanes), v6);
        v7 = hn::MulAdd(factor, hn::LoadU(tag, x + 7 * lanes), v7);
      }
      // Comparisons, not a maximum: a NaN compares false and must not get lost.
      const auto low01 = hn::And(hn::Le(v0, threshold), hn::Le(v1, threshold));
      const auto low23 = hn::And(hn::Le(v2, threshold), hn::Le(v3, threshold));
      const auto low45 = hn::And(hn::Le(v4, threshold), hn::Le(v5, threshold));
      const auto low67 = hn::And(hn::Le(v6, threshold), hn::Le(v7, threshold));
      if (hn::AllTrue(tag, hn::And(hn::And(low01, low23), hn::And(low45, low67)))) continue;
      hn::Store(v0, tag, values);
      hn::Store(v1, tag, values + lanes);
      hn::Store(v2, tag, values + 2 * lanes);
      hn::Store(v3, tag, values + 3 * lanes);
      hn::Store(v4, tag, values + 4 * lanes);
      hn::Store(v5, tag, values + 5 * lanes);
      hn::Store(v6, tag, values + 6 * lanes);
      hn::Store(v7, tag, values + 7 * lanes);
      for (std::size_t i = 0; i < group; ++i) {
        if (values[i] <= planes.thresholds[row]) continue;
        hits.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(begin + i), values[i]});
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void find_above(const ScanPlanes& planes, const double* block, std::vector<ScanHit>& hits) {
  NDHULL_BEST_OF(find_above_in_vectors)(planes, block, hits);
}
}  // namespace ndhull
#endif
