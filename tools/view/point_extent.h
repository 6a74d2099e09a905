// How far points reach along their columns.
#pragma once

#include "core/points.h"

namespace ndhull {

/// Largest minus smallest coordinate, of the column where that is most. [input units] Finite points, at least
/// one. Cost  one pass.
double largest_extent(const PointView& points);

}  // namespace ndhull
