// What a search for a number of facets may cost.
#pragma once

#include <algorithm>
#include <cstdint>

namespace ndhull {

/// Simplices that are worth growing for so many facets where points left out are nearly as far outside as a
/// facet may be wide. Covering them takes about as long as growing them did.
constexpr std::uint64_t most_worth_growing(std::uint64_t facets) {
  return std::clamp<std::uint64_t>(160 * facets, 1'000'000, 2'500'000);
}
/// The same where points are further outside than facets of a coarse hull are wide.
constexpr std::uint64_t most_where_far(std::uint64_t facets) {
  return std::max<std::uint64_t>(2'000'000, most_worth_growing(facets));
}
/// Simplices that are covered, counted again for each covering, until what there is is taken. On wine (11-d),
/// where each round finds more points that a facet has to have, that is 5 to 20 s.
constexpr std::uint64_t most_covered(std::uint64_t facets) { return 8 * most_worth_growing(facets); }
/// Disjoint slabs take this part of the time of overlapping ones, at most.
inline constexpr std::uint64_t kDisjointQuicker = 2;

}  // namespace ndhull
