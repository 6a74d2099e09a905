// Facets of many simplices, a plane at a time: where nearly all simplices are in flats, as on a cube, this
// reads each simplex once and no neighbour.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// The simplices whose vertices all are in one plane.
struct FlatFacet {
  std::uint32_t seed;  ///< the simplex whose plane it is
  std::vector<std::uint32_t> simplices;
  std::vector<PointId> points;  ///< their vertices, ascending
};

/// Finds flats of at least rank + 1 points.
///
/// Method  The plane of the largest simplex in no flat yet (to a factor of two in the square of the area) is
///         tried on all vertices of the complex; those within `tolerance` have a bit for it. A simplex is in
///         the first of the planes whose bits all its vertices have, if the seed can be reached over others
///         of it. Ends when planes with no further point have become many, so a hull with few flats costs
///         little; what is left over is for a search along ridges.
/// Shapes  determinants: one a simplex. Returned: cluster_of, one a simplex, is the index of its flat facet,
///         FacetId::kNone for none.
/// Units   tolerance is a gauge.
/// Cost    O(s rank) for s simplices and each 64 flats; O(v rank) a plane tried, v the vertices.
std::vector<FlatFacet> find_flat_facets(const SimplicialComplex& complex, const double* points,
                                        std::span<const double> determinants, double tolerance,
                                        std::vector<std::uint32_t>& cluster_of);

}  // namespace ndhull
