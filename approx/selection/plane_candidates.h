// Which planes a choice of few among a hull's planes looks at.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "approx/hull.h"

namespace ndhull {

/// Choices of at most so many planes are improved by exchanging one plane for another. With more planes
/// nearly all of the polytope is the hull: points spread over it see too little.
inline constexpr std::size_t kMostExchanged = 100;

/// So many planes are candidates for a choice of `count`, those of the largest facets; all where these do not
/// bound a region.
constexpr std::size_t most_candidates(std::size_t count) {
  constexpr std::size_t kEnough = 20'000;
  return std::max(kEnough, count);
}

/// Facets whose planes are candidates. The largest first, of equal area the lower id.
/// Cost  a sort, and a search for an open direction (approx/geometry/boundedness.h).
std::vector<FacetId> plane_candidates(const Hull& hull, std::size_t count);

}  // namespace ndhull
