// How far points are from the hull of a few others: the nearest point, with proven bounds on both sides.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ndhull {

/// The nearest point of a hull, as far as it is known.
struct HullDistance {
  double upper = 0.0;                 ///< [distance] proven: the hull has a point no further than this
  double lower = 0.0;                 ///< [distance] proven: it has none nearer
  std::vector<std::uint32_t> places;  ///< points that the nearest one is a combination of
  Eigen::VectorXd weights;            ///< theirs, >= 0
  Eigen::VectorXd gap;                ///< nearest point - point
};

/// Where a search may end early, and what is known before it.
struct DistanceSearch {
  double near_enough = 0.0;  ///< [distance] a point found that is so near will do
  double size = 0.0;         ///< no column, nor the point, is longer; 0: not known
};

/// Distance of `point` from the hull of the columns of `hull`.
///
/// Shapes  hull: dimension x count, count >= 1. start: what was found for fewer of the columns, or empty.
/// Method  Wolfe. Finding the nearest point in a polytope. Math. Programming 11, 1976. It ends at the nearest
///         point but for rounding; bounds hold wherever it ends. lower is the distance of the supporting
///         plane across the gap.
/// Roundoff  included in both bounds; sizes are those of the columns and the point as given, so give them
///         about a point in their midst.
/// Cost    a few times (dimension + 1) rounds of count x dimension multiply-adds and a factorisation of at
///         most dimension + 1 rows.
HullDistance hull_distance(const Eigen::Ref<const Eigen::MatrixXd>& hull,
                           const Eigen::Ref<const Eigen::VectorXd>& point, HullDistance start = {},
                           const DistanceSearch& search = {});

}  // namespace ndhull
