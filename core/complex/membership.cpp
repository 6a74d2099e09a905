#include "core/complex/membership.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/complex/membership_kernels.h"
#include "core/linear/dense_solve.h"
#include "core/linear/simplex_planes.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Vector = Eigen::VectorXd;

/// Products so near the highest may belong to the simplex that the ray leaves through. One shift of growth.
constexpr double kTied = 1e-12;

/// Coordinates of y in the simplex's cone, with the gauge they prove.
struct ConeCoordinates {
  Vector lambda;
  double gauge = HUGE_VAL;
  double slack = HUGE_VAL;
};

class Walker {
 public:
  Walker(const SimplicialComplex& complex, const double* points, const HullBall& ball, double useful)
      : complex_(complex),
        points_(points),
        ball_(ball),
        rank_(static_cast<Eigen::Index>(complex.rank)),
        useful_(std::max(useful, 2.0 * rounding(2.0) / ball.inner_radius)) {}

  /// Is the proof as good as is wanted, or as it can be? Inside, or outside by what it says and no less.
  bool is_settled(const LocatedPoint& located) const {
    return located.gauge <= useful_ || located.slack <= useful_;
  }

  /// Walks from the located simplex across the ridge opposite the most negative coordinate. Degenerate
  /// complexes can make that turn in circles, so the steps are bounded and the best simplex is kept.
  void walk(LocatedPoint& located) const {
    const std::size_t step_limit = 64 + 8 * complex_.rank;
    SimplexId at = located.simplex;
    for (std::size_t step = 0; step < step_limit && !is_settled(located); ++step) {
      const ConeCoordinates coordinates = coordinates_of(located.point, at);
      take_better(located, at, coordinates);
      Eigen::Index lowest = 0;
      if (!coordinates.lambda.allFinite()) return;
      if (coordinates.lambda.minCoeff(&lowest) >= 0.0) return;
      at = complex_.neighbours(at)[static_cast<std::size_t>(lowest)];
    }
  }

  /// Tries the simplices with the highest products of all: among them is the one that the ray leaves through.
  void search_all(LocatedPoint& located) const {
    const Eigen::Map<const Vector> y(points_ + std::size_t{located.point.value} * complex_.rank, rank_);
    double best = -HUGE_VAL;
    std::vector<std::pair<double, std::uint32_t>> products;
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      if (complex_.state[row] != SimplexState::kLive) continue;
      const double product = y.dot(Eigen::Map<const Vector>(complex_.plane(SimplexId{row}).data(), rank_));
      if (product < best - kTied) continue;
      best = std::max(best, product);
      products.emplace_back(product, row);
    }
    for (const auto& [product, row] : products) {
      if (product < best - kTied) continue;
      take_better(located, SimplexId{row}, coordinates_of(located.point, SimplexId{row}));
      if (is_settled(located)) return;
    }
  }

 private:
  static void take_better(LocatedPoint& located, SimplexId simplex, const ConeCoordinates& coordinates) {
    if (!(coordinates.gauge < located.gauge)) return;
    located.gauge = coordinates.gauge;
    located.slack = coordinates.slack;
    located.simplex = simplex;
  }

  ConeCoordinates coordinates_of(PointId point, SimplexId simplex) const {
    Eigen::MatrixXd columns(rank_, rank_);
    const auto vertices = complex_.vertices(simplex);
    for (Eigen::Index i = 0; i < rank_; ++i) {
      const std::uint32_t id = vertices[static_cast<std::size_t>(i)].value;
      columns.col(i) = Eigen::Map<const Vector>(points_ + std::size_t{id} * complex_.rank, rank_);
    }
    const Eigen::Map<const Vector> y(points_ + std::size_t{point.value} * complex_.rank, rank_);
    ConeCoordinates result;
    result.lambda = SquareFactors(columns).solve(y);
    if (!result.lambda.allFinite()) return result;
    const double positive = result.lambda.cwiseMax(0.0).sum();
    const double negative = (-result.lambda).cwiseMax(0.0).sum();
    const double residual = (y - columns * result.lambda).lpNorm<1>() + rounding(1.0 + positive + negative);
    result.slack = (negative * ball_.reach + residual) / ball_.inner_radius;
    result.gauge = positive + result.slack - 1.0;
    return result;
  }

  /// Of a residual of terms of this sum of sizes, in reaches. In a hull that is thin somewhere its slack can be
  /// more than a shift in any simplex.
  double rounding(double sizes) const {
    const double n = static_cast<double>(rank_);
    return 2.0 * (n + 2.0) * 0x1p-53 * n * ball_.reach * sizes;
  }

  const SimplicialComplex& complex_;
  const double* points_;
  HullBall ball_;
  Eigen::Index rank_;
  double useful_;
};

std::vector<LocatedPoint> unlocated(std::span<const PointId> queries) {
  std::vector<LocatedPoint> located;
  located.reserve(queries.size());
  for (const PointId query : queries) located.push_back({query, SimplexId{0}, HUGE_VAL, HUGE_VAL});
  return located;
}

}  // namespace

HullBall find_ball(std::size_t rank, const double* points, std::size_t point_count,
                   std::span<const PointId> simplex) {
  HullBall ball;
  double longest_sq = 0.0;
  for (std::size_t row = 0; row < point_count; ++row) {
    double length_sq = 0.0;
    for (std::size_t k = 0; k < rank; ++k) length_sq += points[row * rank + k] * points[row * rank + k];
    longest_sq = std::max(longest_sq, length_sq);
  }
  ball.reach = std::sqrt(longest_sq) * (1.0 + 1e-14);
  double longest_dual = 0.0;
  for (const Vector& plane : simplex_planes(points, rank, simplex))
    longest_dual = std::max(longest_dual, plane.norm());
  // The frame keeps the simplex well shaped (condition about 1e6 at the worst): the solve's error is far
  // below.
  ball.inner_radius = 0.999 / longest_dual;
  return ball;
}

std::vector<LocatedPoint> try_inside(const SimplicialComplex& complex, const double* points,
                                     const HullBall& ball, std::span<const PointId> queries) {
  std::vector<LocatedPoint> located = unlocated(queries);
  locate_in_cones(complex, points, ball, points, false, located);
  return located;
}

void try_inside(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                const double* query_points, std::span<LocatedPoint> located) {
  for (std::uint32_t row = 0; row < located.size(); ++row)
    located[row] = {PointId{row}, SimplexId{0}, HUGE_VAL, HUGE_VAL};
  locate_in_cones(complex, points, ball, query_points, false, located);
}

std::vector<LocatedPoint> prove_inside(const SimplicialComplex& complex, const double* points,
                                       const HullBall& ball, std::span<const PointId> queries, double useful,
                                       std::uint64_t& searched_all, double most_products) {
  std::vector<LocatedPoint> located = unlocated(queries);
  locate_in_cones(complex, points, ball, points, true, located);
  const Walker walker(complex, points, ball, useful);
  for_each_block(located.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!walker.is_settled(located[i])) walker.walk(located[i]);
  });
  std::vector<std::size_t> unsettled;
  for (std::size_t i = 0; i < located.size(); ++i)
    if (!walker.is_settled(located[i])) unsettled.push_back(i);
  const double products =
      static_cast<double>(unsettled.size()) * static_cast<double>(complex.row_count * complex.rank);
  if (products > most_products) return located;
  for_each_block(unsettled.size(), 1,
                 [&](std::size_t begin, std::size_t) { walker.search_all(located[unsettled[begin]]); });
  searched_all += unsettled.size();
  return located;
}

}  // namespace ndhull
