// An approximate hull without its complex: vertices first, then their stars, then facets of these.
//
// Idea. Growth makes all simplices that are between the vertices, and of large inputs in 7-d and up these are
// what takes memory. Which points have to be vertices is known without them: those left out are less than a
// given distance from the hull of the others (approx/reduction/kept_points.h, which proves it). Of a hull of
// which the vertices are known, simplices come star by star (core/growth/vertex_stars.h), and facets are
// found among rows of vertices (approx/slabs/row_cover.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "approx/growth/certified_growth.h"
#include "approx/slabs/row_cover.h"
#include "core/ids.h"

namespace ndhull {

/// Beyond this the nearest points of so many vertices' hull take more time than all simplices.
inline constexpr std::size_t kMostStarVertices = std::size_t{1} << 14;

struct StarHull {
  std::vector<PointId> vertices;  ///< as the facets number them
  RowFacets facets;
  std::uint64_t simplices = 0;
  double distance = 0.0;     ///< [distance] proven: all points are within this of the vertices' hull
  int surface_exponent = 0;  ///< facets.surface times 2^surface_exponent is a multiple of an area
};

/// [bytes] A simplex in a list of rows without neighbours; and a facet while facets become more: planes, areas
/// and vertices, then the facet table beside them.
constexpr std::uint64_t star_row_bytes(std::size_t rank) { return 2 * (rank - 1) + 1; }
constexpr std::uint64_t star_facet_bytes(std::size_t rank) { return 48 * rank + 200; }

/// Goes on from the vertices that growth has: a hull whose facets are no wider than `width`. Points less than
/// `enough` from the hull, which is less than `width`, may be left out.
///
/// Shapes  factor: gradient_factor of the frame and the length unit; area_factor: the same in input units,
///         scaled as wanted (RowFacets::surface).
/// Returns nothing where that is not to be had: data are degenerate, facets bound no region, simplices or
///         facets are more than memory allows, or a stop was requested. Growth is as it was, but that points
///         were located.
std::optional<StarHull> find_star_hull(CertifiedGrowth& growth, std::span<const double> factor,
                                       std::span<const double> area_factor, double width, double enough);

}  // namespace ndhull
