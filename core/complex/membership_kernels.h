// The loops of `membership.h`, with the best instruction set that the machine has.
#pragma once

#include <span>

#include "core/complex/membership.h"

namespace ndhull {

/// Climbs to a simplex for each query and proves the query in its cone, where it is not above the simplex or
/// `proves_outside` says so.
///
/// Shapes  query_points: row located[i].point is query i. located: point is given, simplex, gauge and slack
///         are found.
/// Cost    a product with 64 to 512 planes, O(rank^2) a step of the climb, O(rank^3) a proof; 6 bytes a query.
void locate_in_cones(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                     const double* query_points, bool proves_outside, std::span<LocatedPoint> located);

}  // namespace ndhull
