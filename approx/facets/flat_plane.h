// The plane of a facet with more points than it takes to determine one.
#pragma once

#include <cstddef>
#include <span>

#include "core/ids.h"

namespace ndhull {

/// Replaces a dual plane in the frame by the one with the least sum of (a.y - 1)^2 over points that lie in it
/// up to rounding. Kept only when it is no wider than the plane given: a thin flat does not determine all
/// coordinates of its plane.
///
/// Shapes  points: rows of `rank` numbers; plane: rank.
void fit_flat_plane(const double* points, std::size_t rank, std::span<const PointId> ids, double* plane);

}  // namespace ndhull
