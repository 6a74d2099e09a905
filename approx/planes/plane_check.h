// Is every point below every plane? The question an outer plane has to answer, asked of any planes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/ids.h"
#include "core/points.h"

namespace ndhull {

/// What a check of planes found. The decisions are exact: a point on a plane is not above it, one the last
/// bit of a coordinate further out is.
struct PlaneCheck {
  std::uint64_t pairs = 0;      ///< points x planes
  std::uint64_t above = 0;      ///< pairs with the point strictly above the plane
  double worst_distance = 0.0;  ///< [distance] of the worst pair, positive above; > 0 exactly when above > 0
  PointId worst_point;          ///< none without pairs; of equal pairs the one with the lowest ids
  std::size_t worst_plane = 0;  ///< row of `planes`
};

/// Tests every point against every halfspace a.x + b <= 0.
///
/// Shapes   planes: any number of rows of points.dimension + 1: a of any length but zero, b.
/// Threads  0: all cores. The result does not depend on it.
/// Throws   Error kBadHalfspace a row with a = 0, kUsage a row length that does not divide planes,
///          kTooManyPoints 2^32 - 1 rows of points or more.
/// Cost     points x planes x dimension multiplications in vectors; points are not copied but for blocks of
///          4096, read once for each 4096 planes. A pair within rounding of its plane costs microseconds.
PlaneCheck check_planes(const PointView& points, std::span<const double> planes, unsigned threads = 0);

}  // namespace ndhull
