// Points left out that would make a facet too wide, before there are facets.
#pragma once

#include <vector>

#include "approx/slabs/width_space.h"
#include "core/complex/membership.h"
#include "core/growth/growth.h"

namespace ndhull {

/// Points that are further above some simplex than a facet may be wide, where no plane of a simplex beside
/// holds it: it would be a facet alone, and too wide, and which simplices will be is known only when all
/// others are covered, in vain then.
///
/// Method   A simplex that no point is too far above has a slab below its own plane and all points. From those
///          that are beside simplices that points are too far above the slab is grown over these. What no
///          slab reaches may still be held by one that begins further away: hardly ever, but at the rim of a
///          thin hull.
/// Shapes   points: point_count x rank, the frame's; left_out: above these simplices by these gauges. Of
///          those that the space has not nothing is said.
/// Units    width: that of the space.
/// Returns  the furthest above each of these simplices, a point once, with one of them each; ascending.
///          Nothing where to know would take long.
/// Cost     climbs over neighbours; products of all planes with the points that may be so far above any, and
///          of the slabs' planes with vertices.
std::vector<LocatedPoint> find_far_above(const GrowthWork& work, const double* points,
                                         const WidthSpace& space, const std::vector<LocatedPoint>& left_out,
                                         double width);

}  // namespace ndhull
