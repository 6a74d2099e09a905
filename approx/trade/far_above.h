// Points left out that would make a facet too wide, before there are facets.
#pragma once

#include <vector>

#include "approx/slabs/width_space.h"
#include "core/complex/membership.h"
#include "core/growth/growth.h"

namespace ndhull {

/// Points that are further above some simplex than a facet may be wide: that simplex could not be a facet
/// alone, and which simplices will be is known only when all others are covered, in vain then.
///
/// Method   The gauge of a point is linear in the dual vertices of simplices. So climbing over neighbours
///          ends where it is largest, as the simplex method does, and the simplices where it is more than a
///          bound hang together with that one.
/// Shapes   points: point_count x rank, the frame's; left_out: above these simplices by these gauges. Of
///          those that the space has not nothing is said.
/// Units    width: that of the space.
/// Returns  with such a simplex each, the largest gauge of `left_out` first.
/// Limits   the last are not looked at when simplices have been a quarter as often as there are, and 4,096
///          times.
std::vector<LocatedPoint> find_far_above(const GrowthWork& work, const double* points,
                                         const WidthSpace& space, std::vector<LocatedPoint> left_out,
                                         double width);

}  // namespace ndhull
