// Points that are no vertices, each with the facet it belongs to: Qhull's options Qc and Qi.
#pragma once

#include <cstddef>
#include <vector>

#include "approx/hull.h"
#include "core/points.h"

namespace ndhull {

/// Which points are kept.
struct AttachOptions {
  bool coplanar = false;  ///< within its facet's inner and outer plane, or less than `depth` below the facet
  bool interior = false;  ///< all others
  double depth = 0.0;     ///< [distance, input units]
};

/// A point that is no vertex.
struct AttachedPoint {
  PointId point;
  FacetId facet;  ///< the one that the point is furthest above, or least below
};

/// Looks up the facet of each point that is no vertex of the hull; in the order of the points.
/// Cost  points x facets x dimension multiplications, as distances_to_planes. A hull without facets has none.
std::vector<AttachedPoint> attach_points(const Hull& hull, const PointView& points,
                                         const AttachOptions& options, unsigned threads = 0);

}  // namespace ndhull
