#include "tools/qhull/open_intersection.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ndhull {
namespace {

std::span<const double> row_of(const HalfspaceFile& file, std::size_t id) {
  return {file.rows.data() + id * (file.dimension + 1), file.dimension + 1};
}

double value_at(std::span<const double> row, std::span<const double> point) {
  double sum = row.back();
  for (std::size_t k = 0; k < point.size(); ++k) sum += row[k] * point[k];
  return sum;
}

double length_of_normal(std::span<const double> row) {
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < row.size(); ++k) length = std::hypot(length, row[k]);
  return length;
}

}  // namespace

OpenIntersection open_intersection(const HalfspaceFile& halfspaces, const std::vector<double>& interior_point,
                                   const HullOptions& options) {
  const std::size_t dimension = halfspaces.dimension;
  OpenIntersection result;
  result.dual_points.reserve(halfspaces.count * dimension);
  for (std::size_t id = 0; id < halfspaces.count; ++id) {
    const auto row = row_of(halfspaces, id);
    const double depth = -value_at(row, interior_point);
    for (std::size_t k = 0; k < dimension; ++k) result.dual_points.push_back(row[k] / depth);
  }
  result.hull =
      convex_hull(PointView::row_major(result.dual_points.data(), halfspaces.count, dimension), options);
  if (result.hull.rank < dimension) return result;
  result.points.assign(result.hull.facet_count() * dimension, kNoIntersectionPoint);
  for (std::uint32_t id = 0; id < result.hull.facet_count(); ++id) {
    const FacetId facet{id};
    // A plane that passes the origin within rounding passes through it: its point is at infinity.
    const double offset = result.hull.offset(facet);
    if (!(offset < -result.hull.roundoff)) {
      ++result.open_facets;
      continue;
    }
    const std::span<double> point(result.points.data() + id * dimension, dimension);
    const auto normal = result.hull.normal(facet);
    for (std::size_t k = 0; k < dimension; ++k) point[k] = interior_point[k] - normal[k] / offset;
    for (const PointId vertex : result.hull.vertices_of(facet)) {
      const auto row = row_of(halfspaces, vertex.value);
      result.max_residual =
          std::max(result.max_residual, std::abs(value_at(row, point)) / length_of_normal(row));
    }
  }
  return result;
}

}  // namespace ndhull
