// Vertices and neighbours of the facets that are no mere simplex.
#pragma once

#include <cstddef>
#include <span>

#include "approx/facets/facet_layout.h"
#include "core/complex/simplicial_complex.h"
#include "core/id_rows.h"
#include "core/ids.h"

namespace ndhull {

/// Of the facets that are merged or have a merged neighbour: row f - layout.regular is facet f's. Of a
/// simplicial facet vertices and neighbours as its simplex has them, of a merged one sorted.
struct FacetLists {
  IdRows vertices;    ///< ids of points
  IdRows neighbours;  ///< ids of facets
};

/// `vertices`: those of the hull; other points of the complex are left out.
/// Cost  O(s rank) for s simplices, and 4 bytes a point and a facet for each thread.
FacetLists list_irregular_facets(const SimplicialComplex& complex, const FacetLayout& layout,
                                 std::span<const PointId> vertices, std::size_t point_count);

}  // namespace ndhull
