// How far the outer polytope reaches in a direction u is a linear program: with a_f = normal / height it is
// { z : a_f . z <= 1 }, and u . z <= sum lambda_f whenever sum lambda_f a_f = u, lambda >= 0 (weak duality).
// Any feasible lambda is a bound, so a program that was not solved to its end costs sharpness only.
#include "approx/drawing/shadow.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "approx/geometry/subspace.h"
#include "core/linear/column_table.h"
#include "core/linear/dense_views.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// [ratio] An outer polytope this close to the hull needs no sharper bound: on a page both are one line.
constexpr double kCloseRatio = 1e-4;
constexpr std::size_t kFacetsAtATime = 4096;

/// The outer polytope's reach in directions of the drawing.
class OuterReach {
 public:
  OuterReach(const CentredFacets& facets, const PointView& points, std::span<const PointId> vertices)
      : facets_(facets),
        scales_(Eigen::VectorXd::Zero(rows())),
        poles_(facets.dimension, facets.size()),
        is_known_(facets.size(), false) {
    // Rows in units of the data's own extent: the simplex method's tolerances are relative to 1.
    for (const PointId vertex : vertices) {
      for (std::size_t k = 0; k < facets.dimension; ++k) {
        double& scale = scales_[static_cast<Eigen::Index>(k)];
        scale = std::max(scale, std::abs(points.at(vertex.value, k) - facets.centre[k]));
      }
    }
    for_each_block(facets.size(), kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
      Eigen::VectorXd pole(rows());
      for (std::size_t facet = begin; facet < end; ++facet) {
        const Eigen::Map<const Eigen::VectorXd> normal(facets.normal(facet).data(), rows());
        pole = normal.cwiseProduct(scales_) / (facets.heights[facet] + facets.outer[facet]);
        poles_.set(facet, as_span(pole), 1.0);
      }
    });
    directions_ = subspace_directions(facets.dimension, facets.subspace_equations);
  }

  /// An upper bound of direction . (z - centre) over the outer polytope, infinite when none was found.
  double operator()(const Eigen::VectorXd& direction) {
    // Across the subspace of flat points nothing reaches anywhere.
    Eigen::VectorXd rhs = directions_ * (directions_.transpose() * direction);
    rhs = rhs.cwiseProduct(scales_);
    const double length = rhs.norm();
    if (length == 0.0) return 0.0;
    rhs /= length;
    LpResult result = solve(rhs, [this](const LpQuery& query) { return known_or_best_column(query); });
    // A column that hardly improves can be one that rounding lets no other leave for: with the best it ends.
    if (result.status != LpStatus::kOptimal)
      result = solve(rhs, [this](const LpQuery& query) { return poles_.price(query); });
    const bool is_feasible = result.status == LpStatus::kOptimal ||
                             (result.status == LpStatus::kStalled && result.infeasibility == 0.0);
    return is_feasible ? length * result.objective : kInfinity;
  }

 private:
  Eigen::Index rows() const { return static_cast<Eigen::Index>(facets_.dimension); }

  template <class Search>
  static LpResult solve(const Eigen::VectorXd& rhs, const Search& search) {
    ColumnSimplex program(as_span(rhs));
    return solve_lp(program, search);
  }

  /// Faces of the shadow beside each other are reached by the same facets: those that came in before are tried
  /// first, all others where none of these improves by more than rounding.
  std::optional<LpColumn> known_or_best_column(const LpQuery& query) {
    constexpr double kRounding = 1e-7;  // in parts of the terms
    std::vector<double> multipliers(query.duals.begin(), query.duals.end());
    multipliers.push_back(-query.cost_weight);
    std::size_t best = 0;
    double largest = 0.0;
    for (std::size_t place = 0; place < known_.size(); ++place) {
      const double* const values = known_values_.data() + place * multipliers.size();
      double product = 0.0, size = 0.0;
      for (std::size_t k = 0; k < multipliers.size(); ++k) {
        product += multipliers[k] * values[k];
        size += std::abs(multipliers[k] * values[k]);
      }
      if (product <= largest || product <= kRounding * size) continue;
      largest = product;
      best = known_[place];
    }
    if (largest > 0.0) return poles_.column(best);
    const LpColumn column = poles_.column(poles_.largest_product(multipliers).column);
    if (!is_known_[column.id.value]) {
      is_known_[column.id.value] = true;
      known_.push_back(column.id.value);
      known_values_.insert(known_values_.end(), column.entries.begin(), column.entries.end());
      known_values_.push_back(column.cost);
    }
    return column;
  }

  const CentredFacets& facets_;
  Eigen::VectorXd scales_;
  ColumnTable poles_;  // a column a facet, cost 1
  std::vector<bool> is_known_;
  std::vector<std::size_t> known_;
  std::vector<double> known_values_;  // as in poles_, one after the other
  Eigen::MatrixXd directions_;
};

}  // namespace

double outer_ratio(const CentredFacets& facets) {
  double ratio = 1.0;
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    const double least = facets.heights[facet] + facets.inner[facet];
    if (!(least > 0.0)) return kInfinity;
    ratio = std::max(ratio, (facets.heights[facet] + facets.outer[facet]) / least);
  }
  return ratio;
}

std::vector<double> coordinates_along(const DrawingAxes& axes, const PointView& points,
                                      std::span<const PointId> ids) {
  std::vector<double> coordinates;
  coordinates.reserve(ids.size() * axes.count());
  for (const PointId id : ids) {
    for (std::size_t axis = 0; axis < axes.count(); ++axis) {
      double value = 0.0;
      for (std::size_t k = 0; k < axes.dimension; ++k) {
        value += axes.measure(axis)[k] * (points.at(id.value, k) - axes.centre[k]);
      }
      coordinates.push_back(value);
    }
  }
  return coordinates;
}

std::optional<Shadow> hull_shadow(const CentredFacets& facets, const PointView& points,
                                  std::span<const PointId> vertices, const DrawingAxes& axes,
                                  const WorkEnd& end) {
  const std::vector<double> projected = coordinates_along(axes, points, vertices);
  std::optional<Shell> inner =
      shell_of_points(PointView::row_major(projected.data(), vertices.size(), axes.count()));
  if (!inner.has_value()) return std::nullopt;
  const double ratio = outer_ratio(facets);
  std::optional<OuterReach> reach;
  if (ratio - 1.0 > kCloseRatio && !end.is_here()) reach.emplace(facets, points, vertices);
  const auto dimension = static_cast<Eigen::Index>(axes.dimension);
  const Eigen::Map<const Eigen::MatrixXd> measures(axes.measures.data(), dimension,
                                                   static_cast<Eigen::Index>(axes.count()));
  Shadow shadow;
  std::vector<double> normals, heights;
  for (const Shell::Face& face : inner->faces) {
    const Point3& corner = inner->corners[face.corners.front()];
    const double height = std::inner_product(corner.begin(), corner.end(), face.normal.begin(), 0.0);
    const Eigen::Map<const Eigen::VectorXd> normal(face.normal.data(),
                                                   static_cast<Eigen::Index>(axes.count()));
    normals.insert(normals.end(), normal.begin(), normal.end());
    double outer = ratio * height;
    if (reach.has_value() && !end.is_here()) outer = std::min(outer, (*reach)(measures * normal));
    heights.push_back(std::max(outer, height));
    shadow.margins.push_back(heights.back() / height - 1.0);
  }
  const bool is_bounded =
      std::all_of(heights.begin(), heights.end(), [](double h) { return std::isfinite(h); });
  if (is_bounded) shadow.outer = bounded_by_planes(normals, heights, axes.count());
  shadow.inner = std::move(*inner);
  return shadow;
}

}  // namespace ndhull
