// From hulls to planes and back to points.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "approx/planes/written_planes.h"
#include "approx/polytope/halfspace_intersection.h"
#include "tests/hull/hull_support.h"

namespace ndhull {

/// Rows normal, offset.
struct PlaneRows {
  std::size_t dimension = 0;
  std::vector<double> values;
  std::size_t count() const { return values.size() / (dimension + 1); }
};

/// The facets' own planes, as option `n` prints them.
inline PlaneRows exact_planes(const Hull& hull) {
  PlaneRows rows{hull.dimension, {}};
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
    const auto normal = hull.normal(FacetId{id});
    rows.values.insert(rows.values.end(), normal.begin(), normal.end());
    rows.values.push_back(hull.offset(FacetId{id}));
  }
  return rows;
}

/// The planes that `ndhull hull --planes` writes: no point is above one.
inline PlaneRows outer_planes(const Hull& hull, const PointView& points) {
  PlaneRows rows{hull.dimension, std::vector<double>(hull.facet_count() * (hull.dimension + 1))};
  const WrittenPlanes planes(hull, points, PlaneKind::kOuter);
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id)
    planes.fill(FacetId{id}, {rows.values.data() + id * (hull.dimension + 1), hull.dimension + 1});
  return rows;
}

inline HalfspaceIntersection intersect_planes(const PlaneRows& planes,
                                              const IntersectionOptions& options = {}) {
  return intersect_halfspaces(
      PointView::row_major(planes.values.data(), planes.count(), planes.dimension + 1), options);
}

/// [distance] From the vertices of the region to the points, each to its nearest: the largest.
inline double furthest_vertex(const HalfspaceIntersection& region, const PointSet& points) {
  double furthest = 0.0;
  for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < points.rows(); ++row) {
      double distance = 0.0;
      for (std::size_t k = 0; k < points.dimension; ++k)
        distance = std::hypot(distance, points.row(row)[k] - region.vertices[vertex * points.dimension + k]);
      nearest = std::min(nearest, distance);
    }
    furthest = std::max(furthest, nearest);
  }
  return furthest;
}

/// The same from the points, all of which are vertices, to the vertices of the region.
inline double furthest_point(const PointSet& points, const HalfspaceIntersection& region) {
  double furthest = 0.0;
  for (std::size_t row = 0; row < points.rows(); ++row) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex) {
      double distance = 0.0;
      for (std::size_t k = 0; k < points.dimension; ++k)
        distance = std::hypot(distance, points.row(row)[k] - region.vertices[vertex * points.dimension + k]);
      nearest = std::min(nearest, distance);
    }
    furthest = std::max(furthest, nearest);
  }
  return furthest;
}

}  // namespace ndhull
