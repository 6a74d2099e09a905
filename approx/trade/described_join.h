// Whole facets joined for a width, where simplices were never made.
#pragma once

#include <cstddef>
#include <span>

#include "approx/facets/described_hull.h"
#include "approx/slabs/width_space.h"

namespace ndhull {

/// Of more facets than this pairs are not looked at.
inline constexpr std::size_t kMostDescribedJoined = 1024;

/// The sum of |R a| over the facets, a being a facet's area vector: a multiple of the area that they have
/// projected onto their planes.
///
/// Shapes  factor: rank x rank, R.
double surface_of(const DescribedHull& hull, std::span<const double> factor);

/// Facets that are no wider than `width`: pairs of neighbours become one, the narrowest first (join_facets).
/// At least rank + 1 stay, and their outer planes bound a region. The hull stays as it is when no two join.
///
/// Shapes  space: of the hull's vertices and no other point.
/// Cost    as join_facets: a fit for each pair of neighbours that may fit.
void join_described(DescribedHull& hull, const WidthSpace& space, double width);

/// The same until there are so many facets, at least rank + 1. False, and the hull is as it was: their planes
/// bound no region.
bool join_described_to(DescribedHull& hull, const WidthSpace& space, std::size_t facets);

}  // namespace ndhull
