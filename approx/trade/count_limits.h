// What a search for a number of facets may cost.
#pragma once

#include <algorithm>
#include <cstdint>

#include "approx/slabs/slab_cover.h"

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
/// Simplices that steps of the width about the narrowest found may meet, again for each. Where facets hold
/// hundreds of simplices they find hardly anything.
inline constexpr std::uint64_t kMostProbed = 90'000;
/// Coverings of the search, and what takes off the last tenth.
inline constexpr CoverEffort kPlainCover{.final_fit_steps = 0};
inline constexpr CoverEffort kHarderCover{.choices = 2, .refits = 2};

}  // namespace ndhull
