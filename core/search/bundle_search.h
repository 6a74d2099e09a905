// How far along each of many directions do many points reach, where directions that are near each other come
// together? The products that outer offsets of hulls of many vertices are made of.
//
// Idea. The facets around a vertex have normals of about one direction, and no point is above their planes but
// a few near them. So directions are taken in bundles: a cone of normals, and how far the points must reach
// along its axis to be above any of the planes. A tree lists these points once for the bundle; each direction
// is then multiplied with the listed ones alone, in single precision, vectors of directions at a time. Where
// as many may be the highest as the facet has vertices, these are. All bounds include their own rounding, so
// the result is the same, digit for digit, as that of all products.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/search/highest_dots.h"
#include "core/search/point_tree.h"

namespace ndhull {

/// Largest dot product of each normal with any of the points.
///
/// Shapes  normals: facets x dimension; order: each facet once, those with near normals one after the other;
///         largest: one a facet. The own vertices are among the points.
/// Error   as for highest_dots with PointGroups.
/// Cost    where `order` goes by a vertex of each facet, a fifth to a tenth of a search in the tree for each
///         (20,000 points of a sphere in 4-d to 6-d); where normals that come together are not near each
///         other, such a search.
void highest_dots(const PointTree& tree, std::span<const double> normals,
                  std::span<const std::uint32_t> order, const OwnDots& own, std::span<double> largest);

}  // namespace ndhull
