#include "core/membership.h"

#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/membership.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "core/block_elimination-inl.h"
#include "core/blocks.h"
#include "core/dimension_switch.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

template <std::size_t D>
double dot(const double* a, const double* b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < D; ++k) sum = __builtin_fma(a[k], b[k], sum);
  return sum;
}

/// A few simplices from all over the hull, to start climbing from the one whose product is highest: one pass
/// over their planes costs as much as one step and spares several.
template <std::size_t D>
class StartingPlaces {
 public:
  explicit StartingPlaces(const SimplicialComplex& complex) {
    for (std::size_t i = 0; i < kCount; ++i) {
      std::size_t row = i * complex.row_count / kCount;
      while (complex.state[row] != SimplexState::kLive) row = row + 1 < complex.row_count ? row + 1 : 0;
      simplices_[i] = SimplexId{static_cast<std::uint32_t>(row)};
      for (std::size_t k = 0; k < D; ++k) planes_[k * kCount + i] = complex.planes[row * D + k];
    }
  }

  /// The place with the highest product, or `other` when its product is as high.
  SimplexId nearest(const SimplicialComplex& complex, const double* y, SimplexId other) const {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    Lane best = hn::Set(tag, -HUGE_VAL), place_of_best = hn::Zero(tag), places = hn::Iota(tag, 0.0);
    for (std::size_t i = 0; i < kCount; i += lanes) {
      Lane product = hn::Mul(hn::LoadU(tag, planes_ + i), hn::Set(tag, y[0]));
      for (std::size_t k = 1; k < D; ++k) {
        product = hn::MulAdd(hn::LoadU(tag, planes_ + k * kCount + i), hn::Set(tag, y[k]), product);
      }
      place_of_best = hn::IfThenElse(hn::Gt(product, best), places, place_of_best);
      best = hn::Max(best, product);
      places = hn::Add(places, hn::Set(tag, static_cast<double>(lanes)));
    }
    HWY_ALIGN double products[HWY_MAX_BYTES / sizeof(double)], numbers[HWY_MAX_BYTES / sizeof(double)];
    hn::Store(best, tag, products);
    hn::Store(place_of_best, tag, numbers);
    double highest = dot<D>(complex.plane(other).data(), y);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (products[lane] <= highest) continue;
      highest = products[lane];
      other = simplices_[static_cast<std::size_t>(numbers[lane])];
    }
    return other;
  }

 private:
  static constexpr std::size_t kCount = 64;  // a multiple of all vectors' lanes
  double planes_[D * kCount];
  SimplexId simplices_[kCount];
};

/// From `start`, to the neighbour with the highest plane product until none is higher.
template <std::size_t D>
SimplexId climb(const SimplicialComplex& complex, const double* y, SimplexId start) {
  SimplexId at = start;
  double best = dot<D>(complex.plane(at).data(), y);
  for (bool moved = true; moved;) {
    moved = false;
    for (const SimplexId neighbour : complex.neighbours(at)) {
      const double product = dot<D>(complex.plane(neighbour).data(), y);
      if (product > best) {
        best = product;
        at = neighbour;
        moved = true;
      }
    }
  }
  return at;
}

/// Gauge bound from the coordinates lambda of y in its simplex, one query a lane. See the proof in the
/// header.
template <std::size_t D>
void prove_block(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                 const double* query_points, LocatedPoint* block) {
  const Tag tag;
  const std::size_t lanes = hn::Lanes(tag);
  HWY_ALIGN double entries[D * (D + 1) * HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto vertices = complex.vertices(block[lane].simplex);
    for (std::size_t i = 0; i <= D; ++i) {
      const double* row = i < D ? points + std::size_t{vertices[i].value} * D
                                : query_points + std::size_t{block[lane].point.value} * D;
      for (std::size_t k = 0; k < D; ++k) entries[(k * (D + 1) + i) * lanes + lane] = row[k];
    }
  }
  Lane matrix[D][D + 1], lambda[D];
  for (std::size_t k = 0; k < D; ++k) {
    for (std::size_t i = 0; i <= D; ++i) matrix[k][i] = hn::Load(tag, entries + (k * (D + 1) + i) * lanes);
  }
  eliminate<D>(matrix, lambda);
  Lane sum = hn::Zero(tag), negative = sum, residual = sum, magnitude = sum;
  for (std::size_t i = 0; i < D; ++i) {
    sum = hn::Add(sum, hn::Max(lambda[i], hn::Zero(tag)));
    negative = hn::Add(negative, hn::Max(hn::Neg(lambda[i]), hn::Zero(tag)));
    magnitude = hn::Add(magnitude, hn::Abs(lambda[i]));
  }
  for (std::size_t k = 0; k < D; ++k) {
    Lane rest = hn::Load(tag, entries + (k * (D + 1) + D) * lanes);
    for (std::size_t i = 0; i < D; ++i)
      rest = hn::NegMulAdd(hn::Load(tag, entries + (k * (D + 1) + i) * lanes), lambda[i], rest);
    residual = hn::Add(residual, hn::Abs(rest));
  }
  // The residual is itself computed: its error is at most gamma_{D+1} of the terms' sizes, taken twice.
  constexpr double kGamma = 2.0 * (D + 2) * 0x1p-53;
  const Lane reach = hn::Set(tag, ball.reach), unit = hn::Set(tag, 1.0 / ball.inner_radius);
  residual =
      hn::MulAdd(hn::Set(tag, kGamma * D), hn::Mul(reach, hn::Add(magnitude, hn::Set(tag, 1.0))), residual);
  const Lane covered = hn::Mul(unit, hn::MulAdd(negative, reach, residual));
  HWY_ALIGN double gauge[HWY_MAX_BYTES / sizeof(double)], slack[HWY_MAX_BYTES / sizeof(double)];
  hn::Store(hn::Sub(hn::Add(sum, covered), hn::Set(tag, 1.0)), tag, gauge);
  hn::Store(covered, tag, slack);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const bool solved = std::isfinite(gauge[lane]);
    block[lane].gauge = solved ? gauge[lane] : HUGE_VAL;
    block[lane].slack = solved ? slack[lane] : HUGE_VAL;
  }
}

// Each query starts where the one before it ended, each block of queries at the first simplex. A vector of
// those to prove is solved at a time.
template <std::size_t D>
void locate_all(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                const double* query_points, bool proves_outside, std::span<LocatedPoint> located) {
  constexpr std::size_t kQueriesInBlock = 512;
  const std::size_t lanes = hn::Lanes(Tag());
  SimplexId first{0};
  while (complex.state[first.value] != SimplexState::kLive) ++first.value;  // growth leaves free rows
  const StartingPlaces<D> places(complex);
  for_each_block(located.size(), kQueriesInBlock, [&](std::size_t begin, std::size_t end) {
    LocatedPoint block[HWY_MAX_BYTES / sizeof(double)];
    std::size_t query_of[HWY_MAX_BYTES / sizeof(double)];
    std::size_t used = 0;
    const auto prove = [&] {
      for (std::size_t lane = used; lane < lanes; ++lane) block[lane] = block[used - 1];
      prove_block<D>(complex, points, ball, query_points, block);
      for (std::size_t lane = 0; lane < used; ++lane) located[query_of[lane]] = block[lane];
      used = 0;
    };
    SimplexId start = first;
    for (std::size_t i = begin; i < end; ++i) {
      const double* y = query_points + std::size_t{located[i].point.value} * D;
      start = climb<D>(complex, y, places.nearest(complex, y, start));
      located[i].simplex = start;
      if (!proves_outside) {
        const double height = dot<D>(complex.plane(start).data(), y) - 1.0;
        located[i].gauge = height;
        if (height > 0.0) continue;
      }
      block[used] = located[i];
      query_of[used++] = i;
      if (used == lanes) prove();
    }
    if (used > 0) prove();
  });
}

void locate_any(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                const double* query_points, bool proves_outside, std::span<LocatedPoint> located) {
  call_with_dimension<2, kMaxRank>(complex.rank, [&](auto d) {
    locate_all<d>(complex, points, ball, query_points, proves_outside, located);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {
HWY_EXPORT(locate_any);

namespace {

using Vector = Eigen::VectorXd;

/// Products so near the highest may belong to the simplex that the ray leaves through. One shift of growth.
constexpr double kTied = 1e-12;
/// Products that looking for better simplices everywhere may cost.
constexpr double kSearchProducts = 1e10;

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
        useful_(useful),
        rank_(static_cast<Eigen::Index>(complex.rank)) {}

  /// Is the proof as good as is wanted? Inside, or outside by what it says and no less.
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
    result.lambda = columns.partialPivLu().solve(y);
    if (!result.lambda.allFinite()) return result;
    const double positive = result.lambda.cwiseMax(0.0).sum();
    const double negative = (-result.lambda).cwiseMax(0.0).sum();
    const double n = static_cast<double>(rank_);
    const double computed = 2.0 * (n + 2.0) * 0x1p-53 * n * ball_.reach * (1.0 + positive + negative);
    const double residual = (y - columns * result.lambda).lpNorm<1>() + computed;
    result.slack = (negative * ball_.reach + residual) / ball_.inner_radius;
    result.gauge = positive + result.slack - 1.0;
    return result;
  }

  const SimplicialComplex& complex_;
  const double* points_;
  HullBall ball_;
  double useful_;
  Eigen::Index rank_;
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
  const auto size = static_cast<Eigen::Index>(rank);
  double longest_dual = 0.0;
  for (std::size_t omitted = 0; omitted <= rank; ++omitted) {
    Eigen::MatrixXd rows(size, size);
    for (std::size_t from = 0, row = 0; from <= rank; ++from) {
      if (from == omitted) continue;
      rows.row(static_cast<Eigen::Index>(row++)) =
          Eigen::Map<const Eigen::RowVectorXd>(points + std::size_t{simplex[from].value} * rank, size);
    }
    longest_dual = std::max(longest_dual, rows.partialPivLu().solve(Vector::Ones(size)).norm());
  }
  // The frame keeps the simplex well shaped (condition about 1e6 at the worst): the solve's error is far
  // below.
  ball.inner_radius = 0.999 / longest_dual;
  return ball;
}

std::vector<LocatedPoint> try_inside(const SimplicialComplex& complex, const double* points,
                                     const HullBall& ball, std::span<const PointId> queries) {
  std::vector<LocatedPoint> located = unlocated(queries);
  HWY_DYNAMIC_DISPATCH(locate_any)(complex, points, ball, points, false, located);
  return located;
}

void try_inside(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                const double* query_points, std::span<LocatedPoint> located) {
  for (std::uint32_t row = 0; row < located.size(); ++row)
    located[row] = {PointId{row}, SimplexId{0}, HUGE_VAL, HUGE_VAL};
  HWY_DYNAMIC_DISPATCH(locate_any)(complex, points, ball, query_points, false, located);
}

std::vector<LocatedPoint> prove_inside(const SimplicialComplex& complex, const double* points,
                                       const HullBall& ball, std::span<const PointId> queries, double useful,
                                       std::uint64_t& searched_all) {
  std::vector<LocatedPoint> located = unlocated(queries);
  HWY_DYNAMIC_DISPATCH(locate_any)(complex, points, ball, points, true, located);
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
  if (products > kSearchProducts) return located;
  for_each_block(unsettled.size(), 1,
                 [&](std::size_t begin, std::size_t) { walker.search_all(located[unsettled[begin]]); });
  searched_all += unsettled.size();
  return located;
}

}  // namespace ndhull
#endif
