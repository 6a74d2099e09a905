// Small facets join a neighbour below a plane between the two.
#pragma once

#include <cstddef>

#include "approx/slabs/dual_facets.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// Facets of up to `most_simplices` simplices join a neighbour where both are less than `width` below one of
/// the planes between theirs, the last ones first. Neighbours are tried in the order of what the vertices
/// across the ridges leave of the segment. Lists of vertices are lost.
///
/// Shapes  coordinates: point_count x rank, in the frame. gradient_factor: rank x rank.
/// Order   facets stay in theirs.
/// Cost    two products for each ridge of the small facets, and for each vertex of the few pairs that may
///         fit, by all threads; the joins themselves by one. The same facets for any number of threads.
void join_along_segments(const SimplicialComplex& complex, const double* coordinates,
                         std::span<const double> gradient_factor, std::size_t point_count, double width,
                         std::size_t most_simplices, DualFacets& facets);

}  // namespace ndhull
