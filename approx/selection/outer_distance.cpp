#include "approx/selection/outer_distance.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/geometry/boundedness.h"
#include "approx/geometry/hull_distance.h"
#include "approx/geometry/subspace.h"
#include "approx/polytope/outer_volume.h"
#include "core/dense_views.h"
#include "core/stopwatch.h"

namespace ndhull {
namespace {

using Eigen::Index;

constexpr std::size_t kMostNearestPoints = 2000;
// Where the outer polytope's size is limited so is what comes after: multiplications, a second or less each.
constexpr double kAffordableHeights = 4e9, kAffordableNearest = 4e8;

/// Vertices whose products with all planes are held at once.
constexpr Index kVertexBlock = 256;

/// The hull's vertices as columns, about its interior point, in the coordinates of its outer planes.
Eigen::MatrixXd vertex_columns(const Hull& hull, const PointView& points) {
  const Eigen::MatrixXd directions = subspace_directions(hull.dimension, hull.subspace_equations);
  Eigen::MatrixXd columns(directions.cols(), static_cast<Index>(hull.vertices.size()));
  Eigen::VectorXd row(static_cast<Index>(hull.dimension));
  for (std::size_t vertex = 0; vertex < hull.vertices.size(); ++vertex) {
    for (std::size_t k = 0; k < hull.dimension; ++k)
      row[static_cast<Index>(k)] = points.at(hull.vertices[vertex].value, k) - hull.interior_point[k];
    columns.col(static_cast<Index>(vertex)) = directions.transpose() * row;
  }
  return columns;
}

/// No point of the hull on the ray through a vertex is further from it than this; nothing once time is up.
template <class IsLate>
std::optional<std::vector<double>> most_distances(const Eigen::Map<const RowMatrix>& vertices,
                                                  const PlanesAboutOrigin& hull_planes,
                                                  const IsLate& is_late) {
  const Eigen::Map<const RowMatrix> normals = as_rows(hull_planes.normals, hull_planes.rank);
  const Eigen::Map<const Eigen::VectorXd> heights(hull_planes.heights.data(), normals.rows());
  std::vector<double> most(static_cast<std::size_t>(vertices.rows()));
  Eigen::MatrixXd products;
  for (Index begin = 0; begin < vertices.rows(); begin += kVertexBlock) {
    if (is_late()) return std::nullopt;
    const Index used = std::min(kVertexBlock, vertices.rows() - begin);
    products.noalias() = normals * vertices.middleRows(begin, used).transpose();
    for (Index k = 0; k < used; ++k) {
      const double gauge = (products.col(k).array() / heights.array()).maxCoeff();
      most[static_cast<std::size_t>(begin + k)] =
          gauge > 1.0 ? vertices.row(begin + k).norm() * (1.0 - 1.0 / gauge) : 0.0;
    }
  }
  return most;
}

}  // namespace

OuterDistance outer_distance(const Hull& hull, const PointView& points, std::span<const FacetId> facets,
                             std::uint64_t max_simplices, unsigned threads, const std::stop_token& stop,
                             double max_seconds) {
  if (hull.rank == 0) return {0.0, 0.0, ""};
  const Clock::time_point start = Clock::now();
  const auto is_late = [&] { return max_seconds > 0.0 && seconds_since(start) > max_seconds; };
  const OuterDistance late{std::nullopt, 0.0, "it would take longer than the limit on seconds"};
  const PlanesAboutOrigin planes = outer_planes_about_interior(hull, facets);
  if (!find_open_direction(planes.normals, planes.rank).bounded)
    return {std::nullopt, 0.0, "the outer planes do not bound a region"};
  HullOptions options;
  options.wants_partial = false;
  options.limits.max_facets = max_simplices;
  options.limits.max_seconds = max_seconds;
  options.threads = threads;
  options.stop = stop;
  const PlanePolytope polytope = intersect_about_origin(planes, options);
  if (polytope.status == HullStatus::kInterrupted) return {std::nullopt, 0.0, "interrupted"};
  if (polytope.status == HullStatus::kTimeLimit) return late;
  if (polytope.status != HullStatus::kComplete || !polytope.bounded) {
    return {std::nullopt, 0.0,
            "the outer polytope has more than about " + std::to_string(max_simplices) + " vertices"};
  }
  const double rank = static_cast<double>(planes.rank);
  const double heights =
      static_cast<double>(polytope.vertices.size()) * static_cast<double>(hull.facet_count());
  if (max_simplices > 0 && heights > kAffordableHeights)
    return {std::nullopt, 0.0, "vertices times facets are too many to be compared"};
  std::size_t most_nearest = kMostNearestPoints;
  if (max_simplices > 0) {
    const double affordable = kAffordableNearest / (rank * static_cast<double>(hull.vertices.size()));
    most_nearest = std::min(most_nearest, static_cast<std::size_t>(std::max(affordable, 20.0)));
  }
  // What is below all outer planes is in the hull once it is scaled by 1 - margin about the interior point:
  // then it is below all inner planes.
  const PlanesAboutOrigin all = outer_planes_about_interior(hull, {});
  double margin = 0x1p-52 * (rank + 4.0);  // rounding of a gauge
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    margin = std::max(margin, (hull.outer_offset(facet) - hull.inner_offset(facet)) *
                                  hull.input_per_length_unit(facet) / all.heights[row]);
  }
  const Eigen::Map<const RowMatrix> vertices = as_rows(polytope.vertices, planes.rank);
  std::optional<std::vector<double>> found = most_distances(vertices, all, is_late);
  if (!found) return late;
  std::vector<double>& most = *found;
  for (std::size_t vertex = 0; vertex < most.size(); ++vertex)
    most[vertex] += margin * vertices.row(static_cast<Index>(vertex)).norm();
  std::vector<std::uint32_t> order(most.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&most](std::uint32_t a, std::uint32_t b) {
    return most[a] != most[b] ? most[a] > most[b] : a < b;
  });
  const Eigen::MatrixXd columns = vertex_columns(hull, points);
  OuterDistance result{0.0, 0.0, ""};
  for (std::size_t k = 0; k < order.size() && most[order[k]] > *result.distance; ++k) {
    if (k == most_nearest || is_late()) {
      result.distance = most[order[k]];
      break;
    }
    const HullDistance nearest = hull_distance(columns, vertices.row(order[k]).transpose());
    result.distance = std::max(*result.distance, nearest.upper);
    result.lower = std::max(result.lower, nearest.lower);
  }
  return result;
}

}  // namespace ndhull
