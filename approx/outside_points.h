// Points left out by growth that are further above the hull than was asked for.
#pragma once

#include "approx/certified_growth.h"

namespace ndhull {

/// Puts those of growth's left_out() back that are furthest above any simplex, when some are more than
/// `width` above one, and a little more [distance]. They may lie over a simplex that they are near to, and be
/// far above another one whose plane is further from the centre. False when there are none.
///
/// Precondition  locate_left_out() was called since growth ended.
/// Cost  one product of a plane with a point for each of the planes further out, where the gauge of the point
///       allows more than `width`.
bool put_back_above(CertifiedGrowth& growth, double width);

}  // namespace ndhull
