// Lanes of a vector moved to its front. Included once per target by sources that list what they find.
//
// hn::Compress does that, but where there is no instruction for it gcc 12 copies Highway's table of a
// kilobyte to the stack at each call: half of the time of a loop that lists what is near.

#if defined(NDHULL_CHOSEN_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_CHOSEN_LANES_INL_H_
#undef NDHULL_CHOSEN_LANES_INL_H_
#else
#define NDHULL_CHOSEN_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "core/machine/lane_orders.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Targets with longer vectors have the instruction.
#define NDHULL_HAS_COMPRESS (HWY_MAX_BYTES > 32)

/// A choice of the lanes of a vector of 32-bit ids: those whose bits are set.
template <class Tag>
class ChosenLanes {
 public:
  /// No bit behind the last lane is set.
  HWY_INLINE ChosenLanes(Tag tag, std::uint32_t bits) : choice_(make(tag, bits)) {}

  /// The chosen lanes first, in their order; what follows them may be anything.
  HWY_INLINE hn::Vec<Tag> to_front(hn::Vec<Tag> ids) const {
#if NDHULL_HAS_COMPRESS
    return hn::Compress(ids, choice_);
#else
    return hn::TableLookupLanes(ids, choice_);
#endif
  }

 private:
  static HWY_INLINE auto make(Tag tag, std::uint32_t bits) {
#if NDHULL_HAS_COMPRESS
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(tag, bytes);
#else
    const hn::Rebind<std::uint8_t, Tag> order_tag;
    return hn::IndicesFromVec(tag, hn::PromoteTo(tag, hn::LoadU(order_tag, kLaneOrders[bits].data())));
#endif
  }

  decltype(make(Tag(), 0)) choice_;
};

#undef NDHULL_HAS_COMPRESS

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
