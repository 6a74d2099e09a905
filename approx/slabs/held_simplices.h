// Planes for simplices that are too wide below any that their own was turned to.
#pragma once

#include "approx/slabs/dual_facets.h"
#include "approx/slabs/width_space.h"

namespace ndhull {

/// Gives simplices of `unfit` planes that hold them. At the rim of a thin hull a simplex' own plane is far below
/// points, and no way of turning it leads to one that is not; those of the facets beside it do: they hold it, or
/// nearly, and are turned to it. Simplices stay facets alone. What is left of `unfit` then, no plane was found for.
///
/// Shapes  coordinates: points x rank, in the frame.
/// Cost    of each a fit from one plane, unless another's holds it already. After too many in vain no more are
///         tried.
void hold_unfit(const WidthSpace& space, const double* coordinates, double width, DualFacets& facets);

}  // namespace ndhull
