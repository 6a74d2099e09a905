// How many planes a choice of few among a hull's planes looks at.
#pragma once

#include <cstddef>

namespace ndhull {

/// The planes of the largest facets that are candidates; more when these do not bound a region.
inline constexpr std::size_t kMostCandidates = 20'000;
/// Choices of at most so many planes are improved by exchanging one plane for another. With more planes
/// nearly all of the polytope is the hull: points spread over it see too little.
inline constexpr std::size_t kMostExchanged = 100;

}  // namespace ndhull
