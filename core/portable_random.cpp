// Series after exact range reduction: the logarithm by the inverse hyperbolic tangent, sine and cosine by
// Taylor's series on an eighth of a turn.

#include "core/portable_random.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.h"

namespace ndhull {

std::size_t PortableRandom::below(std::size_t count) {
  NDHULL_CHECK(count >= 1);
  // Values above the largest multiple of count would make small remainders more likely.
  const std::uint64_t range = count;
  const std::uint64_t excess = (std::numeric_limits<std::uint64_t>::max() % range + 1) % range;
  std::uint64_t value = 0;
  do value = engine_();
  while (value > std::numeric_limits<std::uint64_t>::max() - excess);
  return static_cast<std::size_t>(value % range);
}

double PortableRandom::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_normal_;
  }
  double x = 0.0;
  double y = 0.0;
  double norm_sq = 0.0;
  do {
    x = symmetric();
    y = symmetric();
    norm_sq = x * x + y * y;
  } while (norm_sq >= 1.0 || norm_sq == 0.0);
  const double factor = std::sqrt(-2.0 * portable_log(norm_sq) / norm_sq);
  spare_normal_ = y * factor;
  has_spare_ = true;
  return x * factor;
}

double PortableRandom::exponential() { return -portable_log(1.0 - unit()); }

double portable_log(double value) {
  int exponent = 0;
  double fraction = std::frexp(value, &exponent);  // exact, in [1/2, 1)
  if (fraction < std::numbers::sqrt2 / 2) {
    fraction *= 2.0;
    --exponent;
  }
  // log f = 2 atanh z with |z| <= 0.1716; the first term left out is below 2 z^27 / 27 = 1.6e-22.
  const double z = (fraction - 1.0) / (fraction + 1.0);
  const double z_sq = z * z;
  double series = 0.0;
  for (int k = 25; k >= 3; k -= 2) series = (series + 1.0 / k) * z_sq;
  return exponent * std::numbers::ln2 + (2.0 * z + 2.0 * z * series);
}

CirclePoint portable_circle(std::uint64_t numerator, std::uint64_t denominator) {
  NDHULL_CHECK(denominator >= 1 && denominator < std::uint64_t{1} << 60);
  // Eighths of a turn in whole numbers: the angle is (octant + rest / denominator) / 8 turns.
  const std::uint64_t eighths = 8 * (numerator % denominator);
  const std::uint64_t octant = eighths / denominator;
  std::uint64_t rest = eighths % denominator;
  if (octant % 2 == 1) rest = denominator - rest;  // odd octants run back from the next axis
  const double angle = std::numbers::pi / 4 * (static_cast<double>(rest) / static_cast<double>(denominator));
  const double angle_sq = angle * angle;
  // Taylor to angle^20 / 20!: below 3.3e-21 left out for angles up to pi / 4.
  double cosine = 1.0;
  double sine = 1.0;
  for (int k = 18; k >= 2; k -= 2) {
    cosine = 1.0 - cosine * angle_sq / (k * (k - 1));
    sine = 1.0 - sine * angle_sq / (k * (k + 1));
  }
  sine *= angle;
  if (octant % 4 == 1 || octant % 4 == 2) std::swap(cosine, sine);
  if (octant >= 2 && octant < 6) cosine = -cosine;
  if (octant >= 4) sine = -sine;
  return {cosine, sine};
}

}  // namespace ndhull
