#include "approx/rays/sample_bounds.h"

#include <cmath>
#include <initializer_list>

namespace ndhull {
namespace {

/// Halvings of an interval of doubles until its ends are neighbours, or nearly.
constexpr int kHalvings = 200;

/// The continued fraction of the incomplete beta function, by the modified method of Lentz.
/// Source  DLMF 8.17.22; Thompson, Barnett. J. Comput. Phys. 64, 1986.
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr int kMostTerms = 10000;
  double c = 1.0, d = 1.0 - (a + b) * x / (a + 1.0);
  d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
  double value = d;
  for (int m = 1; m <= kMostTerms; ++m) {
    const double k = m;
    double last_factor = 1.0;
    for (const double term : {k * (b - k) * x / ((a + 2.0 * k - 1.0) * (a + 2.0 * k)),
                              -(a + k) * (a + b + k) * x / ((a + 2.0 * k) * (a + 2.0 * k + 1.0))}) {
      d = 1.0 + term * d;
      d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1.0 + term / c;
      if (std::abs(c) < kTiny) c = kTiny;
      last_factor = c * d;
      value *= last_factor;
    }
    if (std::abs(last_factor - 1.0) < 1e-15) break;
  }
  return value;
}

/// log |Gamma(x)| for x > 0. std::lgamma writes a global; Stirling's series from 8 on does not.
/// Source  DLMF 5.11.1; the first term left out is below 1e-12 there.
double log_gamma(double x) {
  double shift = 0.0;
  for (; x < 8.0; x += 1.0) shift += std::log(x);
  const double y = 1.0 / (x * x);
  const double series =
      (1.0 / 12 - y * (1.0 / 360 - y * (1.0 / 1260 - y * (1.0 / 1680 - y * (1.0 / 1188))))) / x;
  return (x - 0.5) * std::log(x) - x + 0.918938533204672742 + series - shift;
}

/// Regularised incomplete beta function: P(X >= a) for X binomial with a + b - 1 trials of probability x.
double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

/// The x at which a rising function of it reaches `value`.
template <class Function>
double where_reached(const Function& function, double value) {
  double low = 0.0, high = 1.0;
  for (int step = 0; step < kHalvings && low < high; ++step) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (function(middle) < value ? low : high) = middle;
  }
  return high;
}

}  // namespace

ShareInterval share_interval(std::uint64_t hits, std::uint64_t rays, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  const auto h = static_cast<double>(hits), rest = static_cast<double>(rays - hits);
  ShareInterval interval;
  if (hits > 0) {
    interval.low = where_reached([&](double x) { return incomplete_beta(h, rest + 1.0, x); }, tail);
  }
  if (hits < rays) {
    interval.high = where_reached([&](double x) { return incomplete_beta(h + 1.0, rest, x); }, 1.0 - tail);
  }
  return interval;
}

double unseen_share_bound(std::uint64_t rays, double confidence) {
  if (rays == 0) return 1.0;
  // -log of (1 - x)^rays / x rises with x.
  const double wanted = -std::log(1.0 - confidence);
  const double x = where_reached(
      [&](double share) { return std::log(share) - static_cast<double>(rays) * std::log1p(-share); }, wanted);
  return x < 1.0 ? x : 1.0;
}

double coverage_estimate(std::uint64_t once, std::uint64_t twice, std::uint64_t more) {
  const std::uint64_t meetings = once + 2 * twice + 3 * more;
  return meetings == 0 ? 0.0 : 1.0 - static_cast<double>(once) / static_cast<double>(meetings);
}

double unseen_estimate(std::uint64_t once, std::uint64_t twice) {
  const auto one = static_cast<double>(once);
  return once == 0 ? 0.0 : one * (one - 1.0) / (2.0 * (static_cast<double>(twice) + 1.0));
}

}  // namespace ndhull
