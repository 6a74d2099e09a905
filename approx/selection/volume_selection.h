// The n outer planes of a hull that enclose little: the largest facets are often neighbours, and leave
// spikes.
#pragma once

#include <cstddef>
#include <vector>

#include "approx/hull.h"
#include "approx/work_end.h"

namespace ndhull {

/// Chooses `count` facets such that the polytope below their outer planes has a small volume; it is bounded.
///
/// Method   By rays (volume_rays.h). Up to 100 planes also by points: planes are added to rank + 1 that bound
///          a region, always the one that cuts most off. What a plane cuts off shrinks as others are added,
///          so most planes need not be looked at again (Minoux. Accelerated greedy algorithms. 1978). Volumes
///          are counts of points spread evenly over the polytope by hit and run (Smith. Operations Research
///          32, 1984): those not cut off stay evenly spread. Planes are exchanged one by one afterwards. Then
///          volumes are computed, where that takes few vertices, of these choices and of the `count` largest
///          facets if they bound a region: the least is taken.
/// Result   ascending. More than `count` where so few bound nothing: a box needs all its sides.
///          Deterministic, whatever the threads, unless `end` comes first: then planes that are missing are
///          those of the largest facets.
/// Throws   Error kUsage when count <= rank: so few planes bound nothing.
/// Cost     planes looked at (the 20,000 of largest area) times rays, 4,000 to 60,000, a few times; up to 100
///          planes as well times 2,000 to 20,000 points once, and 1,000 points for each exchange: seconds.
std::vector<FacetId> choose_for_volume(const Hull& hull, std::size_t count, const WorkEnd& end = {});

}  // namespace ndhull
