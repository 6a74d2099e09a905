#include "approx/slabs/slab_bits_kernel.h"

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "approx/slabs/slab_bits_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Tag>
void intersect_in(Tag tag, const std::uint64_t* HWY_RESTRICT bits, std::size_t words,
                  const std::uint16_t* HWY_RESTRICT ids, std::size_t size, std::size_t count,
                  std::uint64_t* HWY_RESTRICT out) {
  for (std::size_t i = 0; i < count; ++i, ids += size, out += words) {
    for (std::size_t w = 0; w < words; w += hn::Lanes(tag)) {
      auto common = hn::LoadU(tag, bits + ids[0] * words + w);
      for (std::size_t k = 1; k < size; ++k)
        common = hn::And(common, hn::LoadU(tag, bits + ids[k] * words + w));
      hn::StoreU(common, tag, out + w);
    }
  }
}

void intersect_rows_any(const std::uint64_t* bits, std::size_t words, const std::uint16_t* ids,
                        std::size_t size, std::size_t count, std::uint64_t* out) {
  if (words % 8 == 0) {
    intersect_in(hn::CappedTag<std::uint64_t, 8>(), bits, words, ids, size, count, out);
  } else {
    intersect_in(hn::CappedTag<std::uint64_t, 4>(), bits, words, ids, size, count, out);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void intersect_rows(const std::uint64_t* bits, std::size_t words, const std::uint16_t* ids, std::size_t size,
                    std::size_t count, std::uint64_t* out) {
  NDHULL_BEST_OF(intersect_rows_any)(bits, words, ids, size, count, out);
}

}  // namespace ndhull
#endif
