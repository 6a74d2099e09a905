// Where the frame of walks has its centre: inside the hull, in the middle of points that are far out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "approx/rays/cone_walk.h"
#include "core/ids.h"

namespace ndhull {

/// The radius of the ball about the frame's centre in a simplex, the ids of whose rank + 1 points are given.
/// Precondition  the centre is inside the simplex.
double inner_radius(const FramePoints& points, std::span<const PointId> simplex);

/// For each of some hundred directions, the same ones for any points, and their opposites the furthest of the
/// first `count` points. Cost  that many products with all points, in single precision; all threads.
std::vector<std::uint32_t> furthest_along_directions(const FramePoints& points, std::size_t count);

}  // namespace ndhull
