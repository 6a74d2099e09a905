// What closes a region that wide facets leave open. Of a hull that is thin beside their width few slabs hold
// all simplices, and their planes may all face the same two ways.
#pragma once

#include <cstddef>
#include <vector>

#include "approx/geometry/boundedness.h"
#include "approx/slabs/covering.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// Do the facets' planes bound a region that is not a thousand times the hull? Of more
/// than kSurelyBounded facets: yes.
/// Cost  find_open_direction (approx/geometry/boundedness.h), then find_far_reach.
bool bounds_region(const SimplicialComplex& complex, const WidthSpace& space, const Covering& covering);

/// Facets of the hull of all points of a WidthSpace, which growth may have left out points of. They are
/// facets however the hull grows.
struct HullFacets {
  double width = 0.0;  ///< [distance] so far points may be above a simplex that is a facet alone
  std::vector<std::vector<PointId>> vertices;  ///< rank of each facet, ascending
  std::vector<PointId>
      missing;  ///< ascending; of the facets that were wanted last, those that growth left out
};

/// Makes the facets bound a region: where a direction is open, the simplex that faces it most becomes a facet
/// of its own. Returns how many it took; they are few, since each closes a direction. Of more
/// than kSurelyBounded facets none is looked for.
///
/// `known`   Instead of simplices that points are too far above, which growth left out: the facets of the
///           hull of all points along the open directions. One that is no simplex of the complex yet closes
///           nothing: its points are `missing`, and the covering is to be made again when growth has taken
///           them in. Those found stay known, so that they are looked for once.
/// Shapes    coordinates: points x rank, in the frame.
/// Not promised  that a direction is closed where points share planes: the facet found there may be divided
///           into other simplices, and the one that faces it most is taken, however far points are above it.
/// Cost      of bounds_region for each, and a product for each simplex; for each facet looked for a linear
///           program with a column for each point, and a look at each simplex.
std::size_t close_open_directions(const SimplicialComplex& complex, const WidthSpace& space,
                                  const double* coordinates, HullFacets* known, Covering& covering);

}  // namespace ndhull
