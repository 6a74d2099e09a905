// One coordinate has a density proportional to (1-h^2)^g on [-1, 1], with g = (d-3)/2 on the sphere and
// (d-1)/2 in the ball; points in the plane's section are of the same kind in a ball of radius r =
// (1-h^2)^(1/2), so the simplex's volume gives r^(d-1). With h = sin t the coordinate's density in t is cos^a
// t, a = 2g + 1, and the plane's is cos^b t with b = 2 (d g + (d-1)/2) + 1 = d a. For normal points the
// section does not depend on h: a = 1, b = d of exp(-t^2/2). So in all three the plane's density is the
// coordinate's to the power d.
#include "bench/expected_facets.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"

namespace ndhull {
namespace {

// Midpoints; the integrands are smooth, so the midpoint rule is accurate far beyond its order.
constexpr std::size_t kCells = 200000;
// exp(-t^2/2) is then below 1e-40.
constexpr double kNormalRange = 14.0;

struct Coordinate {
  double half_range = 0.0;            // t from -half_range to half_range
  std::vector<double> log_densities;  // at the midpoints, up to a constant
};

Coordinate coordinate_of(PointFamily family, std::size_t dimension) {
  Coordinate coordinate;
  const bool is_normal = family == PointFamily::kGaussian;
  coordinate.half_range = is_normal ? kNormalRange : 0.5 * std::numbers::pi;
  const double power = static_cast<double>(family == PointFamily::kSphere ? dimension - 2 : dimension);
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    const double t =
        coordinate.half_range * ((2.0 * static_cast<double>(cell) + 1.0) / static_cast<double>(kCells) - 1.0);
    coordinate.log_densities.push_back(is_normal ? -0.5 * t * t : power * std::log(std::cos(t)));
  }
  return coordinate;
}

double log_binomial(double n, double k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

}  // namespace

bool has_expected_facet_count(PointFamily family) {
  return family == PointFamily::kSphere || family == PointFamily::kBall || family == PointFamily::kGaussian;
}

double expected_facet_count(PointFamily family, std::size_t dimension, std::size_t count) {
  if (!has_expected_facet_count(family)) {
    throw Error(ErrorCode::kUsage,
                "no expected number of facets is known for this family: it is for sphere, ball and gaussian");
  }
  const auto d = static_cast<double>(dimension), n = static_cast<double>(count);
  const Coordinate coordinate = coordinate_of(family, dimension);
  double total = 0.0, plane_total = 0.0;
  for (const double log_density : coordinate.log_densities) {
    total += std::exp(log_density);
    plane_total += std::exp(d * log_density);
  }
  // From the top, so that what is above keeps its digits where it is little.
  const double log_subsets = log_binomial(n, d);
  double above = 0.0, expected = 0.0;
  for (std::size_t cell = kCells; cell-- > 0;) {
    const double log_density = coordinate.log_densities[cell];
    const double half = 0.5 * std::exp(log_density) / total;
    above += half;
    const double log_below = std::log1p(-std::fmin(above, 1.0 - 1e-300));
    expected += std::exp(log_subsets + d * log_density + (n - d) * log_below) / plane_total;
    above += half;
  }
  return 2.0 * expected;
}

}  // namespace ndhull
