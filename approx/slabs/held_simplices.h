// Planes for simplices that are too wide below any that their own was turned to.
#pragma once

#include "approx/slabs/dual_facets.h"
#include "approx/slabs/width_space.h"

namespace ndhull {

/// Gives simplices of `unfit` planes that hold them. At the rim of a thin hull a simplex' own plane is far
/// below points, and no way of turning it leads to one that is not; those of the facets beside it do: they
/// hold it, or nearly, and are turned to it. Simplices stay facets alone. What is left of `unfit` then, no
/// plane was found for; all of it where slabs were found from stars, which have no tops.
///
/// Shapes  coordinates: points x rank, in the frame.
/// Cost    O(rows), and of each up to four fits, unless another's plane holds it already. How many fits there
///         may be rises with the simplices; what comes after these only gets planes that hold it as they are.
void hold_unfit(const WidthSpace& space, const double* coordinates, double width, DualFacets& facets);

}  // namespace ndhull
