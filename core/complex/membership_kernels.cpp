#include "core/complex/membership_kernels.h"

#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/complex/membership_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "core/counting_order.h"
#include "core/dimension_switch.h"
#include "core/linear/block_elimination-inl.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

template <std::size_t D>
double dot(const double* a, const double* b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < D; ++k) sum = __builtin_fma(a[k], b[k], sum);
  return sum;
}

/// Some simplices from all over the hull, to start climbing from the one whose product is highest: a pass over
/// their planes costs as much as a step or some, and spares several.
template <std::size_t D>
class StartingPlaces {
 public:
  explicit StartingPlaces(const SimplicialComplex& complex)
      : count_(std::clamp(complex.row_count / kRowsOfPlace / kLeast * kLeast, kLeast, kMost)),
        planes_(D * count_),
        simplices_(count_) {
    for (std::size_t i = 0; i < count_; ++i) {
      std::size_t row = i * complex.row_count / count_;
      while (complex.state[row] != SimplexState::kLive) row = row + 1 < complex.row_count ? row + 1 : 0;
      simplices_[i] = SimplexId{static_cast<std::uint32_t>(row)};
      for (std::size_t k = 0; k < D; ++k) planes_[k * count_ + i] = complex.planes[row * D + k];
    }
  }

  std::size_t count() const { return count_; }
  SimplexId simplex(std::size_t place) const { return simplices_[place]; }

  /// The place with the highest product.
  std::size_t nearest(const double* y) const {
    const Tag tag;
    const std::size_t lanes = hn::Lanes(tag);
    Lane best = hn::Set(tag, -HUGE_VAL), place_of_best = hn::Zero(tag), places = hn::Iota(tag, 0.0);
    for (std::size_t i = 0; i < count_; i += lanes) {
      Lane product = hn::Mul(hn::LoadU(tag, planes_.data() + i), hn::Set(tag, y[0]));
      for (std::size_t k = 1; k < D; ++k) {
        product = hn::MulAdd(hn::LoadU(tag, planes_.data() + k * count_ + i), hn::Set(tag, y[k]), product);
      }
      place_of_best = hn::IfThenElse(hn::Gt(product, best), places, place_of_best);
      best = hn::Max(best, product);
      places = hn::Add(places, hn::Set(tag, static_cast<double>(lanes)));
    }
    HWY_ALIGN double products[HWY_MAX_BYTES / sizeof(double)], numbers[HWY_MAX_BYTES / sizeof(double)];
    hn::Store(best, tag, products);
    hn::Store(place_of_best, tag, numbers);
    std::size_t lane = 0;
    for (std::size_t other = 1; other < lanes; ++other)
      if (products[other] > products[lane]) lane = other;
    return static_cast<std::size_t>(numbers[lane]);
  }

 private:
  // The least is a multiple of all vectors' lanes; the most has numbers of 16 bits.
  static constexpr std::size_t kLeast = 64, kMost = 512, kRowsOfPlace = 1024;

  std::size_t count_;
  std::vector<double> planes_;  // D x count
  std::vector<SimplexId> simplices_;
};

/// Of each query the place nearest to it.
template <std::size_t D>
std::vector<std::uint16_t> nearest_places(const StartingPlaces<D>& places, const double* query_points,
                                          std::span<const LocatedPoint> queries) {
  constexpr std::size_t kQueriesInBlock = 1024;
  std::vector<std::uint16_t> place_of(queries.size());
  for_each_block(queries.size(), kQueriesInBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      place_of[i] =
          static_cast<std::uint16_t>(places.nearest(query_points + std::size_t{queries[i].point.value} * D));
  });
  return place_of;
}

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

// Each query starts at its place or where the one before it ended, whichever is higher. A vector of those to
// prove is solved at a time.
template <std::size_t D>
void locate_all(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                const double* query_points, bool proves_outside, std::span<LocatedPoint> located) {
  constexpr std::size_t kQueriesInBlock = 512, kAhead = 8;
  const std::size_t lanes = hn::Lanes(Tag());
  const StartingPlaces<D> places(complex);
  // Those nearest to the same place together: what they climb over is in cache then.
  const std::vector<std::uint16_t> place_of = nearest_places<D>(places, query_points, located);
  const std::vector<std::uint32_t> order = counting_order<std::uint16_t>(place_of, places.count());
  const auto query_at = [&](std::size_t i) {
    return query_points + std::size_t{located[order[i]].point.value} * D;
  };
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
    SimplexId start = places.simplex(place_of[order[begin]]);
    for (std::size_t i = begin; i < end; ++i) {
      if (i + 2 * kAhead < end) prefetch(&located[order[i + 2 * kAhead]]);
      if (i + kAhead < end) prefetch(query_at(i + kAhead), D);
      const double* y = query_at(i);
      const SimplexId place = places.simplex(place_of[order[i]]);
      if (dot<D>(complex.plane(place).data(), y) > dot<D>(complex.plane(start).data(), y)) start = place;
      start = climb<D>(complex, y, start);
      LocatedPoint& query = located[order[i]];
      query.simplex = start;
      if (!proves_outside) {
        const double height = dot<D>(complex.plane(start).data(), y) - 1.0;
        query.gauge = height;
        if (height > 0.0) continue;
      }
      block[used] = query;
      query_of[used++] = order[i];
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

void locate_in_cones(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                     const double* query_points, bool proves_outside, std::span<LocatedPoint> located) {
  NDHULL_BEST_OF(locate_any)(complex, points, ball, query_points, proves_outside, located);
}

}  // namespace ndhull
#endif
