// The hull of points that are all looked at: steps 1 to 5 of the driver (convex_hull.cpp).
#pragma once

#include "approx/growth/begun_hull.h"
#include "approx/hull.h"
#include "core/machine/stopwatch.h"
#include "core/points.h"

namespace ndhull {

/// `start`: of the whole call. `input_bytes`: of the input that these points were kept of, or are.
/// `begun`: null, or a hull of some of the points that growth goes on from; only for exact growth without a
/// limit on facets.
Hull build_hull(const PointView& points, const HullOptions& options, Clock::time_point start,
                double input_bytes, BegunHull* begun = nullptr);

}  // namespace ndhull
