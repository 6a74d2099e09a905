// The driver. Steps in order, with the file that holds each:
//   1 halfspaces  approx/polytope/halfspace_set      unit normals, distances without cancellation
//   2 region      approx/polytope/halfspace_region   a point inside, the subspace, or proof that there is none
//   3 centre      approx/polytope/region_centre      a point well inside, or a direction without end
//   4 dual hull   approx/polytope/plane_polytope     vertices as facets of the hull of the dual points
//   5 vertices    approx/polytope/polytope_vertices  refined on the planes as given, coincident ones merged
//   6 measure     approx/polytope/polytope_measure   volume, areas
#include "approx/polytope/halfspace_intersection.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "approx/geometry/orthonormal.h"
#include "approx/polytope/halfspace_region.h"
#include "approx/polytope/halfspace_set.h"
#include "approx/polytope/plane_polytope.h"
#include "approx/polytope/polytope_vertices.h"
#include "approx/work_end.h"
#include "core/error.h"
#include "core/linear/dense_views.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// For Limits::share_afterwards, what is done with each vertex: an allowance, not a measurement.
constexpr double kPlaceShare = 3.0;

HullOptions dual_options(const IntersectionOptions& options, const WorkEnd& end) {
  HullOptions dual;
  dual.limits = options.limits;
  dual.limits.max_seconds = end.seconds_left();
  dual.limits.share_afterwards = kPlaceShare;
  dual.seed = options.seed;
  dual.threads = options.threads;
  dual.progress = options.progress;
  dual.stop = options.stop;
  return dual;
}

class Intersector {
 public:
  Intersector(const PointView& rows, const IntersectionOptions& options)
      : halfspaces_(rows), options_(options), end_(options.limits.max_seconds, options.stop) {
    result_.dimension = halfspaces_.dimension();
    result_.halfspace_count = halfspaces_.count();
    if (options.interior_point && options.interior_point->size() != result_.dimension) {
      throw Error(ErrorCode::kUsage, "found an interior point of " +
                                         std::to_string(options.interior_point->size()) +
                                         " coordinates, expected " + std::to_string(result_.dimension));
    }
  }

  HalfspaceIntersection run() {
    const Clock::time_point start = Clock::now();
    region_ = find_region(halfspaces_, options_.interior_point);
    if (region_.empty) {
      describe_empty();
      return std::move(result_);
    }
    describe_region();
    const RegionCentre centre = centre_region(halfspaces_, region_);
    result_.region_seconds = seconds_since(start);
    if (!centre.direction.empty()) {
      describe_direction(centre.direction);
      return std::move(result_);
    }
    result_.kind =
        result_.rank < result_.dimension ? IntersectionKind::kLowerDimensional : IntersectionKind::kBounded;
    if (result_.rank == 0) {
      make_point();
    } else {
      make_polytope(centre.point);
    }
    return std::move(result_);
  }

 private:
  void describe_empty() {
    result_.kind = IntersectionKind::kEmpty;
    VectorXd sum = VectorXd::Zero(static_cast<Index>(result_.dimension));
    for (const WeightedHalfspace& term : region_.proof) {
      result_.proof.push_back({term.halfspace, term.weight});
      sum += term.weight * as_vector(halfspaces_.normal(term.halfspace));
      result_.proof_gap += term.weight * halfspaces_.offset(term.halfspace);
    }
    result_.proof_residual = sum.norm();
  }

  void describe_region() {
    result_.rank = static_cast<std::size_t>(region_.directions.cols());
    result_.interior_point = region_.point;
    result_.inner_radius = region_.radius;
    result_.equalities = region_.equalities;
    if (result_.rank == result_.dimension) return;
    const Index dimension = region_.directions.rows(), rank = region_.directions.cols();
    const Eigen::MatrixXd q = orthonormal_columns(region_.directions, dimension);
    for (Index column = rank; column < dimension; ++column) {
      const VectorXd normal = q.col(column);
      result_.equations.insert(result_.equations.end(), normal.begin(), normal.end());
      result_.equations.push_back(-normal.dot(as_vector(region_.point)));
    }
  }

  void describe_direction(const std::vector<double>& direction) {
    result_.kind = IntersectionKind::kUnbounded;
    result_.direction = direction;
    double margin = -1.0;
    for (std::size_t id = 0; id < halfspaces_.count(); ++id) {
      const double product = as_vector(halfspaces_.normal(id)).dot(as_vector(direction));
      margin = std::max(margin, product / halfspaces_.length(id));
    }
    result_.direction_margin = margin;
  }

  void make_point() {
    result_.vertices = region_.point;
    result_.halfspaces_of.begin.push_back(0);
    result_.neighbours_of.begin.push_back(0);
    if (options_.measure) result_.volume = result_.area = 0.0;
  }

  /// The planes about `centre` in coordinates of the subspace; row k is halfspace region_.planes[k].
  PlanesAboutOrigin planes_about(const std::vector<double>& centre) const {
    PlanesAboutOrigin planes;
    planes.rank = result_.rank;
    for (const std::uint32_t id : region_.planes) {
      const VectorXd inside =
          region_.directions.transpose() * as_vector(halfspaces_.normal(id)) / halfspaces_.length(id);
      const double length = inside.norm();
      for (const double value : inside) planes.normals.push_back(value / length);
      planes.heights.push_back(-halfspaces_.distance(id, centre) / length);
    }
    return planes;
  }

  void make_polytope(const std::vector<double>& well_inside) {
    Clock::time_point start = Clock::now();
    std::vector<double> centre = well_inside;
    PlanesAboutOrigin planes = planes_about(centre);
    if (*std::min_element(planes.heights.begin(), planes.heights.end()) <= 0.0) {
      // Only a region no thicker than rounding has a mean of vertices outside.
      centre = region_.point;
      planes = planes_about(centre);
    }
    PlanePolytope polytope = intersect_about_origin(planes, dual_options(options_, end_));
    result_.dual_hull_seconds = seconds_since(start);
    result_.status = result_.measure_status = polytope.status;
    if (!polytope.bounded) {
      if (polytope.status != HullStatus::kComplete) return;  // so few planes that nothing is bounded yet
      throw too_long_a_region();
    }
    start = Clock::now();
    // After a request to stop vertices are placed, and merged in a moment.
    constexpr double kMoment = 0.3;
    const WorkEnd end = options_.stop.stop_requested() ? WorkEnd(kMoment, {}) : end_;
    PolytopeVertices vertices = place_vertices(halfspaces_, region_, centre, planes, polytope, end);
    result_.vertices = std::move(vertices.coordinates);
    result_.halfspaces_of = std::move(vertices.halfspaces);
    result_.neighbours_of = std::move(vertices.neighbours);
    result_.non_redundant = std::move(vertices.non_redundant);
    result_.max_residual = vertices.max_residual;
    result_.vertex_seconds = seconds_since(start);
    if (!options_.measure || polytope.status != HullStatus::kComplete) return;
    start = Clock::now();
    HullOptions within;
    within.limits.max_seconds = end_.seconds_left();
    within.limits.max_memory_bytes = options_.limits.max_memory_bytes;
    within.threads = options_.threads;
    within.stop = options_.stop;
    const PolytopeMeasure measure = measure_polytope(planes, polytope, within);
    result_.measure_status = measure.status;
    if (measure.status == HullStatus::kComplete) {
      result_.volume = measure.volume;
      result_.area = measure.area;
    }
    result_.measure_seconds = seconds_since(start);
  }

  const HalfspaceSet halfspaces_;
  const IntersectionOptions& options_;
  const WorkEnd end_;
  HalfspaceRegion region_;
  HalfspaceIntersection result_;
};

/// The power of two about which the planes' distances from the origin lie, where it is so far from 1 that
/// squares and products of lengths are no doubles; 0 where it is not, or where distances differ so much that
/// offsets would lose digits by scaling.
int length_exponent(const PointView& rows) {
  constexpr int kPlain = 300;
  const std::size_t dimension = rows.dimension - 1;
  std::optional<int> exponent;
  for (std::size_t row = 0; row < rows.rows; ++row) {
    double largest = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) largest = std::max(largest, std::abs(rows.at(row, k)));
    const double offset = rows.at(row, dimension);
    if (!(largest > 0.0) || offset == 0.0 || !std::isfinite(largest) || !std::isfinite(offset)) continue;
    const int here = std::ilogb(offset) - std::ilogb(largest);
    exponent = std::max(exponent.value_or(here), here);
  }
  if (!exponent || std::abs(*exponent) <= kPlain) return 0;
  for (std::size_t row = 0; row < rows.rows; ++row) {
    const double offset = rows.at(row, dimension);
    if (std::ldexp(std::ldexp(offset, -*exponent), *exponent) != offset) return 0;
  }
  return *exponent;
}

/// Multiplies every length of the result by 2^exponent. Volumes that are no doubles then are left out.
void scale_lengths(HalfspaceIntersection& result, int exponent) {
  const auto scale = [exponent](double& length) { length = std::ldexp(length, exponent); };
  std::for_each(result.interior_point.begin(), result.interior_point.end(), scale);
  std::for_each(result.vertices.begin(), result.vertices.end(), scale);
  for (std::size_t end = result.dimension; end < result.equations.size(); end += result.dimension + 1)
    scale(result.equations[end]);
  scale(result.inner_radius);
  scale(result.proof_gap);
  scale(result.max_residual);
  for (const double coordinate : result.vertices) {
    if (!std::isfinite(coordinate)) throw too_long_a_region();
  }
  const auto scale_measure = [exponent](std::optional<double>& measure, std::size_t dimension) {
    if (!measure) return;
    measure = std::ldexp(*measure, exponent * static_cast<int>(dimension));
    if (*measure == 0.0 || !std::isfinite(*measure)) measure.reset();
  };
  if (result.rank == 0) return;
  scale_measure(result.volume, result.rank);
  scale_measure(result.area, result.rank - 1);
}

HalfspaceIntersection intersect(const PointView& halfspaces, const IntersectionOptions& options) {
  const int exponent = length_exponent(halfspaces);
  if (exponent == 0) {
    HalfspaceIntersection result = Intersector(halfspaces, options).run();
    scale_lengths(result, 0);
    return result;
  }
  IntersectionOptions scaled_options = options;
  if (options.interior_point && options.interior_point->size() + 1 == halfspaces.dimension) {
    find_region(HalfspaceSet(halfspaces), options.interior_point);  // throws if it is not inside
    for (double& coordinate : *scaled_options.interior_point) coordinate = std::ldexp(coordinate, -exponent);
  }
  const std::size_t columns = halfspaces.dimension;
  std::vector<double> rows(halfspaces.rows * columns);
  for (std::size_t row = 0; row < halfspaces.rows; ++row) {
    double* const out = rows.data() + row * columns;
    halfspaces.copy_row(row, out);
    out[columns - 1] = std::ldexp(out[columns - 1], -exponent);
  }
  HalfspaceIntersection result =
      Intersector(PointView::row_major(rows.data(), halfspaces.rows, columns), scaled_options).run();
  scale_lengths(result, exponent);
  return result;
}

}  // namespace

std::string_view to_string(IntersectionKind kind) {
  switch (kind) {
    case IntersectionKind::kBounded: return "bounded";
    case IntersectionKind::kUnbounded: return "unbounded";
    case IntersectionKind::kEmpty: return "empty";
    case IntersectionKind::kLowerDimensional: return "lower_dimensional";
  }
  return "unknown";
}

HalfspaceIntersection intersect_halfspaces(const PointView& halfspaces, const IntersectionOptions& options) {
  HalfspaceSet::check_shape(halfspaces);
  if (halfspaces.rows == 0) throw Error(ErrorCode::kEmptyInput, "found no halfspaces, expected one or more");
  return arena_of(options.threads).execute([&] { return intersect(halfspaces, options); });
}

}  // namespace ndhull
