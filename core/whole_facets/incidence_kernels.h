// Bits of points on facets: which facets meet in a ridge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// Two of the facets that were compared, lower place first.
struct FacetPair {
  std::uint32_t first, second;
};

/// Among facets that all contain one point, those that share a ridge at it.
///
/// Method  Two facets share a ridge exactly when no third contains all points that they have in common: what
///         one facet has in common with another is largest then. So largest first, what is within none of
///         those found is found.
/// Shapes  rows: each `words` words, bit i: point i is in the facet. `least`: points that a ridge has at
///         least.
/// Returns the number of words compared, about; the pairs in `pairs`.
/// Cost    O(f^2) words for f facets, and for each pair with enough points in common as many as one has
///         neighbours.
/// Source  Fukuda, Prodon. Double description method revisited. 1996 (the combinatorial test).
std::uint64_t find_ridges(std::span<const std::uint64_t* const> rows, std::size_t words, std::size_t least,
                          std::vector<FacetPair>& pairs);

}  // namespace ndhull
