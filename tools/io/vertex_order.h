// The halfspaces at a vertex of an intersection, and the vertices beside it, in the order of Qhull's formats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/polytope/halfspace_intersection.h"

namespace ndhull {

/// The neighbours of a vertex; where as many halfspaces as dimensions meet, the i-th one is not in the i-th of
/// them, as Fn goes with Fv. Elsewhere, and where rounding hides which halfspaces two vertices share,
/// ascending.
std::vector<std::uint32_t> opposite_neighbours(const HalfspaceIntersection& intersection, std::size_t vertex);

/// The halfspaces at a vertex, oriented as `i` has them: where as many as dimensions meet, the same way round
/// at all vertices; of more in 3-d once round. Of more in other dimensions, and of flat intersections,
/// ascending.
std::vector<std::uint32_t> oriented_halfspaces(const HalfspaceIntersection& intersection, std::size_t vertex);

}  // namespace ndhull
