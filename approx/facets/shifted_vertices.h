// Vertices of a hull whose points were shifted while it grew, and whose coplanar facets are not known.
#pragma once

#include <vector>

#include "core/growth/growth.h"

namespace ndhull {

/// Which points are vertices: the corners of the complex but those that lie in the hull of the others, to
/// some 1e-11. A point that was shifted may be a corner though it lies on an edge or a face. Of several such
/// corners one is left out after the other, while it is in the hull of those that are left.
///
/// Cost  a product of each pair of corners, in single precision; for each that is not the furthest along the
///       mean normal of its simplices a linear program or two with a column for each corner. In parallel.
std::vector<bool> find_vertices_of_shifted(const GrowthWork& work);

}  // namespace ndhull
