// Areas are computed in the frame. A facet of area A_f on the plane a.y = 1 has the cone A_f / (|a| rank),
// and cones have the ratio of the map's determinant to those in input units; with the height h of the centre
// below the plane in input units the area is rank cone / h.
#include "approx/rays/ray_facets.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "approx/geometry/orthonormal.h"
#include "approx/hull.h"
#include "core/linear/dense_solve.h"
#include "core/linear/dense_views.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;

/// Simplices of a hull within a plane after which its area is that of a part. Some seconds in 15-d.
constexpr std::uint64_t kMaxSimplicesInPlane = 1'000'000;
/// Ridges that are walked over, of a facet that has more.
constexpr std::size_t kMaxRidges = 1024;

}  // namespace

/// The points of a facet in coordinates within its plane, and their hull.
struct FacetGeometry::InPlane {
  std::vector<double> coordinates;  // points x hull.dimension
  Hull hull;

  Eigen::Map<const Eigen::RowVectorXd> point(PointId id) const {
    return {coordinates.data() + id.value * hull.dimension, static_cast<Index>(hull.dimension)};
  }
  /// The vertices of the largest simplex of a ridge.
  std::span<const PointId> largest_simplex(FacetId ridge) const {
    std::span<const PointId> found;
    double largest = -1.0;
    for (const SimplexId simplex : hull.simplices_of(ridge)) {
      const std::span<const PointId> vertices = hull.simplices().vertices(simplex);
      RowMatrix edges(static_cast<Index>(vertices.size()) - 1, static_cast<Index>(hull.dimension));
      for (std::size_t k = 1; k < vertices.size(); ++k)
        edges.row(static_cast<Index>(k) - 1) = point(vertices[k]) - point(vertices[0]);
      const double size = SquareFactors(edges * edges.transpose()).determinant();
      if (size <= largest) continue;
      largest = size;
      found = vertices;
    }
    return found;
  }
  PointId furthest_below(FacetId ridge) const {
    const Eigen::Map<const Eigen::VectorXd> normal(hull.normal(ridge).data(),
                                                   static_cast<Index>(hull.dimension));
    return *std::ranges::min_element(hull.vertices, {}, [&](PointId id) { return point(id).dot(normal); });
  }
};

FacetGeometry::FacetGeometry(const RayShooter& shooter, double max_seconds)
    : shooter_(shooter), max_seconds_(max_seconds) {
  volume_scale_ = volume_scale(shooter.frame());
  const Frame& frame = shooter.frame();
  const auto rank = static_cast<Index>(frame.rank);
  const RowMatrix identity = RowMatrix::Identity(rank, rank);
  std::vector<double> lengths(frame.rank);
  to_input_.resize(rank, static_cast<Index>(frame.dimension));
  NormalMap(frame).map(identity.data(), frame.rank, to_input_.data(), lengths.data());
  for (Index row = 0; row < rank; ++row) to_input_.row(row) *= lengths[static_cast<std::size_t>(row)];
}

FacetGeometry::InPlane FacetGeometry::project(const RayFacet& facet) const {
  const FramePoints points = shooter_.points();
  const auto rank = static_cast<Index>(points.rank);
  const Eigen::Map<const Eigen::VectorXd> plane(facet.plane.data(), rank);
  // The first column of Q is along the normal, the others span the plane.
  const Eigen::MatrixXd axes = orthonormal_columns(plane, rank).rightCols(rank - 1);
  const RowMatrix all = points.rows_of(facet.points);
  const RowMatrix within = (all.rowwise() - all.row(0)) * axes;
  InPlane result;
  result.coordinates.assign(within.data(), within.data() + within.size());
  HullOptions options;
  options.limits.max_facets = kMaxSimplicesInPlane;
  options.limits.max_seconds = max_seconds_;
  options.certifies_planes = false;  // those of ridges are not used
  options.threads = static_cast<unsigned>(tbb::this_task_arena::max_concurrency());
  result.hull = convex_hull(
      PointView::row_major(result.coordinates.data(), facet.points.size(), points.rank - 1), options);
  return result;
}

double FacetGeometry::area_of(double determinant, const std::vector<double>& plane) const {
  const Eigen::Map<const Eigen::VectorXd> a(plane.data(), to_input_.rows());
  const double per_height = (to_input_.transpose() * a).stableNorm();
  // In many dimensions the scale may be no double where the area is one.
  const double scaled =
      determinant * per_height / (std::tgamma(static_cast<double>(plane.size())) * volume_scale_.ratio);
  return std::ldexp(scaled, -volume_scale_.exponent);
}

std::vector<double> FacetGeometry::fit_plane(const std::vector<std::uint32_t>& points) const {
  const RowMatrix rows = shooter_.points().rows_of(points);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.rows());
  const PivotedFactors factors(rows);
  Eigen::VectorXd plane = factors.solve(ones);
  plane += factors.solve(ones - rows * plane);  // one step of refinement
  return {plane.data(), plane.data() + plane.size()};
}

RayFacet FacetGeometry::make_facet(const WalkResult& walk) const {
  const std::size_t rank = shooter_.points().rank;
  RayFacet facet;
  facet.points = walk.on_plane;
  facet.vertices = walk.on_plane;
  const bool is_simplex = facet.points.size() == rank;
  facet.plane = is_simplex ? walk.plane : fit_plane(facet.points);
  facet.area = area_of(std::abs(walk.determinant), facet.plane);
  if (is_simplex) return facet;
  if (rank - 1 > kMaxRank) {
    facet.area_is_whole = false;
    return facet;
  }
  const InPlane within = project(facet);
  if (within.hull.rank + 1 < rank) return facet;  // thinner than roundoff: the simplex is all there is
  facet.area_is_whole = within.hull.status == HullStatus::kComplete;
  facet.vertices.clear();
  for (const PointId id : within.hull.vertices) facet.vertices.push_back(facet.points[id.value]);
  // determinant of the facet's cone = (rank - 1)! area height, height = 1 / |a|
  const Eigen::Map<const Eigen::VectorXd> plane(facet.plane.data(), static_cast<Index>(rank));
  const double determinant = within.hull.volume * std::tgamma(static_cast<double>(rank)) / plane.norm();
  facet.area = area_of(determinant, facet.plane);
  return facet;
}

std::optional<std::vector<WalkTask>> FacetGeometry::ridge_walks(const RayFacet& facet) const {
  const std::size_t rank = shooter_.points().rank;
  std::vector<WalkTask> walks;
  if (facet.vertices.size() == rank) {
    for (std::size_t place = 0; place < rank; ++place) {
      walks.push_back({.direction = {}, .basis = facet.vertices, .place = place});
    }
    return walks;
  }
  if (rank - 1 > kMaxRank) return walks;
  const InPlane within = project(facet);
  const Hull& hull = within.hull;
  if (hull.status == HullStatus::kTimeLimit) return std::nullopt;
  if (hull.rank + 1 < rank) return walks;
  if (hull.rank < 2) {
    // A segment: each end is a ridge.
    if (hull.vertices.size() != 2) return walks;
    const std::vector<std::uint32_t> ends = {facet.points[hull.vertices[0].value],
                                             facet.points[hull.vertices[1].value]};
    walks.push_back({.direction = {}, .basis = ends, .place = 0});
    walks.push_back({.direction = {}, .basis = ends, .place = 1});
    return walks;
  }
  std::vector<FacetId> ridges;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) ridges.push_back(FacetId{row});
  std::stable_sort(ridges.begin(), ridges.end(),
                   [&hull](FacetId a, FacetId b) { return hull.area_of(a) > hull.area_of(b); });
  if (ridges.size() > kMaxRidges) ridges.resize(kMaxRidges);
  for (const FacetId ridge : ridges) {
    WalkTask task{.direction = {}, .basis = {}, .place = rank - 1};
    for (const PointId id : within.largest_simplex(ridge)) task.basis.push_back(facet.points[id.value]);
    task.basis.push_back(facet.points[within.furthest_below(ridge).value]);
    walks.push_back(std::move(task));
  }
  return walks;
}

}  // namespace ndhull
