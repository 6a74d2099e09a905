// Intersections without end as Qhull has them: the hull of the dual points, some of whose facets are no
// points.
#pragma once

#include <cstddef>
#include <vector>

#include "approx/hull.h"
#include "core/points.h"
#include "tools/io/halfspace_reader.h"

namespace ndhull {

/// The hull of dual points a / -(a.p + b) about an interior point p. The origin is not inside of it where the
/// intersection has no end: a facet that the origin is in the plane of, or above, stands for no point.
struct OpenIntersection {
  std::vector<double> dual_points;  ///< a row a halfspace
  Hull hull;                        ///< of these; their ids are those of the halfspaces
  std::vector<double> points;       ///< a row a facet, kNoIntersectionPoint throughout where it has none
  std::size_t open_facets = 0;      ///< facets without a point
  double max_residual = 0.0;        ///< [distance] of a point from a plane it is on

  PointView dual_view() const {
    return PointView::row_major(dual_points.data(), hull.point_count, hull.dimension);
  }
};

/// What Qhull prints for each coordinate of a point that is nowhere (qh_INFINITE).
inline constexpr double kNoIntersectionPoint = -10.101;

/// Takes the dual about `interior_point`, which is strictly inside all halfspaces, and the points that its
/// facets stand for. Which of the halfspaces are vertices of the hull depends on that point, as in Qhull.
///
/// Throws  Error as convex_hull does. Where the dual points span fewer dimensions there are no points: see
///         hull.rank.
OpenIntersection open_intersection(const HalfspaceFile& halfspaces, const std::vector<double>& interior_point,
                                   const HullOptions& options);

}  // namespace ndhull
