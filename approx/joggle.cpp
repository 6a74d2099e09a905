#include "approx/joggle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/error.h"
#include "core/frame.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

constexpr double kUnit = 0x1p-52;
// Qhull's ratios, so that the same input is joggled by as much.
constexpr double kDefaultRatio = 30'000.0;
constexpr double kGrowth = 10.0;
constexpr unsigned kSameSizeTries = 2;
constexpr double kMostOfExtent = 0.01;
constexpr unsigned kMostTries = 50;

/// Largest absolute value and extent of each column.
struct Columns {
  explicit Columns(const PointView& points) {
    for (std::size_t column = 0; column < points.dimension; ++column) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (std::size_t row = 0; row < points.rows; ++row) {
        low = std::min(low, points.at(row, column));
        high = std::max(high, points.at(row, column));
      }
      largest = std::max({largest, high, -low});
      sum += std::max(high, -low);
      extent = std::max(extent, high - low);
    }
  }
  double largest = 0.0, sum = 0.0, extent = 0.0;
};

double relative_roundoff(std::size_t dimension) {
  const auto d = static_cast<double>(dimension);
  return kUnit * (d * std::sqrt(d) + 1.0);
}

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// The furthest that a row of `joggled` is from its point. Steps are in parts of the longest, as a power of
/// two, since squares of tiny ones are 0; the factor covers the rounding of differences, squares, sum and root.
double furthest_moved(const PointView& points, const std::vector<double>& joggled) {
  const auto step = [&](std::size_t row, std::size_t k) {
    return joggled[row * points.dimension + k] - points.at(row, k);
  };
  double longest = 0.0;
  for (std::size_t row = 0; row < points.rows; ++row)
    for (std::size_t k = 0; k < points.dimension; ++k) longest = std::max(longest, std::abs(step(row, k)));
  if (longest == 0.0) return 0.0;
  const int exponent = std::ilogb(longest);
  double furthest_sq = 0.0;
  for (std::size_t row = 0; row < points.rows; ++row) {
    double sum = 0.0;
    for (std::size_t k = 0; k < points.dimension; ++k) {
      const double part = std::ldexp(step(row, k), -exponent);
      sum += part * part;
    }
    furthest_sq = std::max(furthest_sq, sum);
  }
  const double furthest = std::sqrt(furthest_sq) * (1.0 + static_cast<double>(points.dimension + 4) * kUnit);
  return std::ldexp(furthest, exponent);
}

/// Of which coordinates move; `roundoff`: of the points.
double size_of(const JoggleOptions& joggle, double roundoff) {
  constexpr double kMost = 1e300;
  const double size = joggle.size == 0.0 ? kDefaultRatio * roundoff : joggle.size;
  if (size >= roundoff && size <= kMost) return size;
  throw Error(ErrorCode::kUsage, "joggle: found a size of " + brief(size) +
                                     ", expected at least the rounding of a distance, " + brief(roundoff) +
                                     ", and a finite one; give more, or none for the default of " +
                                     brief(kDefaultRatio * roundoff));
}

}  // namespace

double joggle_roundoff(const PointView& points) {
  const Columns columns(points);
  const auto d = static_cast<double>(points.dimension);
  return kUnit * (1.01 * d * std::min(std::sqrt(d) * columns.largest, columns.sum) + columns.largest);
}

double default_joggle(const PointView& points) { return kDefaultRatio * joggle_roundoff(points); }

bool has_precision_problem(const Hull& hull) {
  return hull.rank < hull.dimension || hull.statistics.shifted_points > 0 ||
         hull.statistics.rejected_insertions > 0;
}

HullOptions watched_options(const HullOptions& options, std::size_t dimension) {
  HullOptions watched = options;
  watched.shift = relative_roundoff(dimension);
  watched.triangulate = options.accuracy.is_exact();
  return watched;
}

std::vector<double> joggled_points(const PointView& points, double size, std::uint64_t seed) {
  PortableRandom random(seed);
  std::vector<double> joggled(points.rows * points.dimension);
  for (std::size_t row = 0; row < points.rows; ++row) {
    double* const out = joggled.data() + row * points.dimension;
    points.copy_row(row, out);
    for (std::size_t k = 0; k < points.dimension; ++k) out[k] += size * random.symmetric();
  }
  return joggled;
}

JoggledHull joggled_hull(const PointView& points, const HullOptions& options, const JoggleOptions& joggle) {
  const double roundoff = joggle_roundoff(points);
  if (!(roundoff < HUGE_VAL)) fit_frame(points);  // says what is wrong with the points
  JoggledHull result;
  result.size = size_of(joggle, roundoff);
  const HullOptions watched = watched_options(options, points.dimension);
  const double most = std::max(result.size, kMostOfExtent * Columns(points).extent);
  for (;; ++result.retries) {
    if (result.retries >= kSameSizeTries) result.size = std::min(kGrowth * result.size, most);
    if (result.retries == kMostTries) {
      throw Error(ErrorCode::kUsage, "joggle: found a precision problem in " + std::to_string(kMostTries) +
                                         " tries up to a size of " + brief(result.size) +
                                         ", expected none; merge coplanar facets instead (no joggle)");
    }
    result.points = joggled_points(points, result.size, joggle.seed + result.retries);
    result.hull =
        convex_hull(PointView::row_major(result.points.data(), points.rows, points.dimension), watched);
    const bool is_ended = result.hull.status != HullStatus::kComplete;
    if (is_ended || !has_precision_problem(result.hull)) break;
  }
  result.moved = furthest_moved(points, result.points);
  result.hull.widen(result.moved);
  return result;
}

std::uint64_t count_precision_problems(const PointView& points, const HullOptions& options,
                                       const JoggleOptions& joggle, std::uint64_t runs) {
  const HullOptions watched = watched_options(options, points.dimension);
  const double size = size_of(joggle, joggle_roundoff(points));
  std::uint64_t problems = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const std::vector<double> joggled = joggled_points(points, size, joggle.seed + run);
    const Hull hull =
        convex_hull(PointView::row_major(joggled.data(), points.rows, points.dimension), watched);
    if (has_precision_problem(hull)) ++problems;
  }
  return problems;
}

}  // namespace ndhull
