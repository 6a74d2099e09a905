// The lanes of a mask as the bits of a number. Included once per target by sources that list what they find.

#if defined(NDHULL_MASK_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_MASK_BITS_INL_H_
#undef NDHULL_MASK_BITS_INL_H_
#else
#define NDHULL_MASK_BITS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Bit i: lane i. (Highway 1.0 has that for its own use only.)
template <class Tag>
HWY_INLINE std::uint64_t bits_of_mask(Tag tag, hn::Mask<Tag> mask) {
  std::uint8_t bytes[8] = {};  // as many bits as there are lanes
  hn::StoreMaskBits(tag, mask, bytes);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; 8 * i < hn::MaxLanes(tag); ++i) bits |= std::uint64_t{bytes[i]} << (8 * i);
  return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per target
