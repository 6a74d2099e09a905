#include "approx/selection/outer_distance.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/geometry/boundedness.h"
#include "approx/geometry/hull_distance.h"
#include "approx/geometry/subspace.h"
#include "approx/polytope/outer_volume.h"
#include "core/linear/dense_views.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Eigen::Index;

// Where the outer polytope's size is limited so is what comes after: multiplications, some tenths of a
// second.
constexpr double kAffordable = 5e8;
/// Rounds of a search for a nearest point, each a product with all vertices of the hull: what most take that
/// end early.
constexpr double kSearchRounds = 8.0;

/// Vertices whose products with all planes are held at once.
constexpr std::size_t kVertexBlock = 16;
/// Vertices between two looks at the clock, and those whose nearest points are looked for side by side.
constexpr std::size_t kVerticesAtATime = 2048, kSearchesAtATime = 64;

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

/// What is below all outer planes is in the hull once it is scaled by 1 - margin about the interior point:
/// then it is below all inner planes.
double margin_of(const Hull& hull, const PlanesAboutOrigin& planes) {
  double margin = 0x1p-52 * (static_cast<double>(planes.rank) + 4.0);  // rounding of a gauge
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    margin = std::max(margin, (hull.outer_offset(facet) - hull.inner_offset(facet)) *
                                  hull.input_per_length_unit(facet) / planes.heights[row]);
  }
  return margin;
}

/// No vertex is further from the hull than this: on the ray through it the hull ends where a facet's plane
/// does. What time was too short for is as far as from the interior point.
std::vector<double> most_by_gauges(const Hull& hull, const Eigen::Map<const RowMatrix>& vertices,
                                   const Eigen::VectorXd& lengths, const WorkEnd& end) {
  const PlanesAboutOrigin planes = outer_planes_about_interior(hull, {});
  const double margin = margin_of(hull, planes);
  const Eigen::Map<const RowMatrix> normals = as_rows(planes.normals, planes.rank);
  const Eigen::Map<const Eigen::VectorXd> heights(planes.heights.data(), normals.rows());
  std::vector<double> most(lengths.begin(), lengths.end());
  for (std::size_t first = 0; first < most.size() && !end.is_here(); first += kVerticesAtATime) {
    for_each_block(
        std::min(kVerticesAtATime, most.size() - first), kVertexBlock, [&](std::size_t from, std::size_t to) {
          const auto begin = static_cast<Index>(first + from), used = static_cast<Index>(to - from);
          const Eigen::MatrixXd products = normals * vertices.middleRows(begin, used).transpose();
          for (Index k = 0; k < used; ++k) {
            const double gauge = (products.col(k).array() / heights.array()).maxCoeff();
            double& of_vertex = most[static_cast<std::size_t>(begin + k)];
            of_vertex *= (gauge > 1.0 ? 1.0 - 1.0 / gauge : 0.0) + margin;
          }
        });
  }
  return most;
}

}  // namespace

OuterDistance outer_distance(const Hull& hull, const PointView& points, std::span<const FacetId> facets,
                             const Limits& limits, unsigned threads, const std::stop_token& stop) {
  if (hull.rank == 0) return {0.0, 0.0, ""};
  const WorkEnd end(limits.max_seconds, stop);
  const auto none = [&limits](HullStatus status) {
    return OuterDistance{std::nullopt, 0.0, reason_of_end(status, limits)};
  };
  const std::size_t count = facets.empty() ? hull.facet_count() : facets.size();
  const HullStatus before = limit_before_outer_polytope(hull.rank, count, limits);
  if (before != HullStatus::kComplete) return none(before);
  const PlanesAboutOrigin planes = outer_planes_about_interior(hull, facets);
  if (!find_open_direction(planes.normals, planes.rank).bounded) return none(HullStatus::kComplete);
  HullOptions options;
  options.wants_partial = false;
  options.limits = limits;
  options.limits.max_seconds = end.seconds_left();
  options.threads = threads;
  options.stop = stop;
  const PlanePolytope polytope = intersect_about_origin(planes, options);
  if (polytope.status != HullStatus::kComplete || !polytope.bounded) return none(polytope.status);
  const Eigen::Map<const RowMatrix> vertices = as_rows(polytope.vertices, planes.rank);
  const Eigen::VectorXd lengths = vertices.rowwise().norm() * (1.0 + 0x1p-50);  // their rounding
  const double vertex_work = static_cast<double>(planes.rank) * static_cast<double>(vertices.rows());
  const double gauge_work = vertex_work * static_cast<double>(hull.facet_count());
  const double search_work = vertex_work * kSearchRounds * static_cast<double>(hull.vertices.size());
  if (limits.max_facets > 0 && std::min(gauge_work, search_work) > kAffordable)
    return {std::nullopt, 0.0, "vertices are too many to be compared with the hull"};
  // The gauges settle most vertices. Where facets are many it is less work to look for all nearest points.
  std::vector<double> most(lengths.begin(), lengths.end());
  if (gauge_work < search_work) most = most_by_gauges(hull, vertices, lengths, end);
  std::vector<std::uint32_t> order(most.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&most](std::uint32_t a, std::uint32_t b) {
    return most[a] != most[b] ? most[a] > most[b] : a < b;
  });
  const Eigen::MatrixXd columns = vertex_columns(hull, points);
  const double size = std::sqrt(columns.colwise().squaredNorm().maxCoeff());
  const std::size_t affordable = limits.max_facets > 0
                                     ? static_cast<std::size_t>(kAffordable / (search_work / vertex_work))
                                     : order.size();
  OuterDistance result{0.0, 0.0, ""};
  std::vector<HullDistance> nearest(kSearchesAtATime);
  for (std::size_t first = 0; first < order.size() && most[order[first]] > *result.distance;
       first += kSearchesAtATime) {
    if (first >= affordable || end.is_here()) {
      result.distance = most[order[first]];
      break;
    }
    const double near_enough = *result.distance;
    const std::size_t used = std::min(kSearchesAtATime, order.size() - first);
    for_each_block(used, 1, [&](std::size_t place, std::size_t) {
      const Index vertex = order[first + place];
      nearest[place] = hull_distance(columns, vertices.row(vertex).transpose(), {},
                                     {.near_enough = near_enough, .size = std::max(size, lengths[vertex])});
    });
    for (std::size_t place = 0; place < used; ++place) {
      result.distance = std::max(*result.distance, nearest[place].upper);
      result.lower = std::max(result.lower, nearest[place].lower);
    }
  }
  return result;
}

}  // namespace ndhull
