// Facets without their simplices: the vertices of each and its neighbours, which is all that joining looks at.
#pragma once

#include <cstdint>
#include <vector>

#include "approx/slabs/covering.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

struct FacetCorners {
  std::vector<std::uint32_t> vertices;    ///< rows of the space, ascending
  std::vector<std::uint32_t> neighbours;  ///< facets, ascending, not itself
  /// What its normal counts for in that of a union; 0: as many as there are vertices.
  double weight = 0.0;
};

/// Of each facet of a covering. Cost  each simplex once, by all threads where tables of flags would be large.
std::vector<FacetCorners> corners_of(const SimplicialComplex& complex, const WidthSpace& space,
                                     const Covering& covering);

}  // namespace ndhull
