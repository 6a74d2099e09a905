// The first simplex: points that are far from each other's span.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/points.h"

namespace ndhull {

/// In scaled coordinates z = scale (x - middle).
struct GreedySimplex {
  std::vector<PointId> points;     ///< rank + 1
  std::vector<double> directions;  ///< rank x dimension, orthonormal, in z
};

/// Takes the point furthest from the mean, then again and again the point furthest from the affine span so
/// far (QR with column pivoting), of equally far ones the first.
///
/// Shapes     middle, scale: one a column. tolerance: a distance from the span, in z, that is the rounding of
///            the input.
/// Cost       O(n d rank) time, shared out among threads; 8 n (d + 1) bytes of scratch. The same for any
///            number of threads and any instruction set.
GreedySimplex choose_simplex(const PointView& points, std::span<const double> middle,
                             std::span<const double> scale, double tolerance);

}  // namespace ndhull
