// Delayed coplanar merging (Qhull's Qx taken to its end): simplices that are not clearly convex become one
// facet with one plane. Growth never merges; this runs once on the finished complex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/facets/facet_layout.h"
#include "approx/work_end.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// Groups the simplices into facets.
///
/// Method    A ridge is flat when the opposite vertex of either side is less than `tolerance` below the
///           other's plane. Only where a vertex was shifted can one be: elsewhere every decision was clearer.
///           Seeds are taken by area, largest first: the largest simplex of a flat has its best plane. A
///           facet grows from its seed over neighbours whose vertices are within the tolerance of the seed's
///           plane, so flats do not creep around a curve. Its plane is then fitted to all its vertices (least
///           squares). Where most simplices have a shifted vertex, flats are found a plane at a time first
///           (flat_facets.h). Facets whose vertices all lie in a neighbour's plane are slivers and join it.
/// Shapes    is_shifted: one a point; determinants: one a simplex.
/// Limits    at the end of work slivers stay facets of their own, and the result is cut short.
/// Units     tolerance is a gauge: relative to the distance of the plane from the interior point.
/// Cost      O(s rank^2) for s simplices, plus the fits.
FacetClusters merge_coplanar(const SimplicialComplex& complex, const double* points,
                             std::span<const std::uint8_t> is_shifted, std::span<const double> determinants,
                             double tolerance, const WorkEnd& end = {});

/// The points that are vertices of the merged hull: those whose facets' normals span all dimensions. Points
/// in the middle of a facet, ridge or edge are in the complex but are no vertices. `complex` is as
/// lay_out left it. Returns one flag a point.
std::vector<bool> find_vertices(const SimplicialComplex& complex, const FacetLayout& layout,
                                std::size_t point_count);

/// Adds points to vertices of which shifts have left out some: all of a facet of one simplex, and of a merged
/// one with fewer than rank of them as many more, those in most facets first.
/// `is_vertex`: one flag a point.
/// Cost  O(s rank) for s simplices.
void keep_enough_vertices(const SimplicialComplex& complex, const FacetLayout& layout,
                          std::vector<bool>& is_vertex);

}  // namespace ndhull
