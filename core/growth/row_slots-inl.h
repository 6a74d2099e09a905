// Where in a row of ids something stands. Included once per target by growth_kernels.cpp.

#if defined(NDHULL_ROW_SLOTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_ROW_SLOTS_INL_H_
#undef NDHULL_ROW_SLOTS_INL_H_
#else
#define NDHULL_ROW_SLOTS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A vector of ids: a row of up to eight, half of a longer one.
template <std::size_t D>
using RowTag = hn::CappedTag<std::uint32_t, (D <= 4 ? 4 : 8)>;

template <std::size_t D>
constexpr std::uint32_t kAllSlots = (1u << D) - 1;

/// Which half of a row of the topology.
enum class RowHalf { kVertices, kNeighbours };

/// Where a vector that holds a whole half begins, in ids before that half. What is behind the row may belong
/// to another thread; before the neighbours are the row's own vertices, behind the vertices its neighbours.
template <std::size_t D, RowHalf kHalf>
HWY_INLINE std::size_t lanes_before() {
  const std::size_t lanes = hn::Lanes(RowTag<D>());
  return kHalf == RowHalf::kNeighbours && lanes > D ? lanes - D : 0;
}

/// One bit for each entry of a half row for which the comparison of vectors holds. Bits behind D may be set.
/// `row`: of the topology.
template <std::size_t D, RowHalf kHalf, class Compare>
HWY_INLINE std::uint32_t slots_where(const std::uint32_t* row, const Compare& compare) {
  const RowTag<D> tag;
  const std::size_t lanes = hn::Lanes(tag), before = lanes_before<D, kHalf>();
  const std::uint32_t* half = row + (kHalf == RowHalf::kNeighbours ? D - before : 0);
  std::uint32_t bits = 0;
  for (std::size_t part = 0; part < D; part += lanes) {
    // A last part that is not full overlaps the one before.
    const std::size_t begin = part > 0 && part + lanes > D ? D - lanes : part;
    std::uint8_t bytes[8];
    hn::StoreMaskBits(tag, compare(hn::LoadU(tag, half + begin)), bytes);
    std::uint32_t of_part = bytes[0];
    // Not to be kept in a mask register: gcc 12 saves that as one byte and reads four back, where it has to
    // save it across a call.
    asm("" : "+r"(of_part));
    bits |= of_part << begin;
  }
  return bits >> before;
}

/// Slot of `value` in a half row that contains it.
template <std::size_t D, RowHalf kHalf>
HWY_INLINE std::uint32_t slot_of(const std::uint32_t* row, std::uint32_t value) {
  const RowTag<D> tag;
  const auto wanted = hn::Set(tag, value);
  return static_cast<std::uint32_t>(
      __builtin_ctz(slots_where<D, kHalf>(row, [&](auto ids) HWY_ATTR { return hn::Eq(ids, wanted); })));
}

/// Calls visit(tag, begin) for vectors that cover a row of D values. The last one may overlap the one before:
/// nothing behind the row is touched.
template <class T, std::size_t D, class Visit>
HWY_INLINE void for_row(const Visit& visit) {
  constexpr std::size_t kMost = D >= 8 ? 8 : D >= 4 ? 4 : 2;
  const hn::CappedTag<T, kMost> tag;
  const std::size_t lanes = hn::Lanes(tag);
  for (std::size_t begin = 0; begin + lanes <= D; begin += lanes) visit(tag, begin);
  if (D % lanes != 0) visit(tag, D - lanes);
}

/// Fetches a row of the topology.
template <std::size_t D>
HWY_INLINE void fetch_row(const std::uint32_t* topology, std::uint32_t row) {
  const std::uint32_t* entries = topology + std::size_t{row} * 2 * D;
  __builtin_prefetch(entries);
  if (D > 8 || (D & (D - 1)) != 0) __builtin_prefetch(entries + 2 * D - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
