// Typed 32-bit ids. A facet is never mistaken for a point, and a table indexed by one kind does not
// compile with the other.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

#include "core/error.h"

namespace ndhull {

/// A number among ids and rows that stands for none.
inline constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

/// A place in a table of at most 2^32 - 1 entries.
inline std::uint32_t narrow_id(std::size_t place) {
  NDHULL_CHECK(place < kNone);
  return static_cast<std::uint32_t>(place);
}

/// Index into one kind of table. Kinds never mix; a default Id is "none".
template <class Tag>
struct Id {
  static constexpr std::uint32_t kNone = ndhull::kNone;
  std::uint32_t value = kNone;

  constexpr bool valid() const { return value != kNone; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

/// A row of the input.
using PointId = Id<struct PointTag>;
/// A simplex of the growth complex: d vertices, d neighbours, one dual plane.
using SimplexId = Id<struct SimplexTag>;
/// A facet of the result: one simplex, or a cluster of simplices merged into one plane.
using FacetId = Id<struct FacetTag>;

}  // namespace ndhull
