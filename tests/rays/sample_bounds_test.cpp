// Intervals and bounds against closed forms and exact binomial sums.
#include "approx/rays/sample_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ndhull {
namespace {

/// P(X <= k) for X binomial, by its sum.
double binomial_cdf(std::uint64_t k, std::uint64_t n, double p) {
  double sum = 0.0;
  for (std::uint64_t i = 0; i <= k; ++i) {
    const auto x = static_cast<double>(i), rest = static_cast<double>(n - i);
    sum += std::exp(std::lgamma(x + rest + 1.0) - std::lgamma(x + 1.0) - std::lgamma(rest + 1.0) +
                    x * std::log(p) + rest * std::log1p(-p));
  }
  return sum;
}

TEST(ShareIntervalExample, OfNoHitsAndAllHitsHasClosedForms) {
  const ShareInterval none = share_interval(0, 10, 0.95);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 1.0 - std::pow(0.025, 0.1), 1e-12);
  const ShareInterval all = share_interval(10, 10, 0.95);
  EXPECT_NEAR(all.low, std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(all.high, 1.0);
}

TEST(ShareIntervalLaw, EndsLeaveHalfTheRestToEachTail) {
  for (const std::uint64_t n : {1U, 7U, 50U, 400U}) {
    for (std::uint64_t hits = 0; hits <= n; hits += 1 + n / 9) {
      for (const double confidence : {0.5, 0.95, 0.999}) {
        const ShareInterval interval = share_interval(hits, n, confidence);
        const double tail = 0.5 * (1.0 - confidence);
        if (hits < n) {
          EXPECT_NEAR(binomial_cdf(hits, n, interval.high) / tail, 1.0, 1e-7);
        }
        if (hits > 0) {
          // The mirror image: as many misses, with the other probability.
          EXPECT_NEAR(binomial_cdf(n - hits, n, 1.0 - interval.low) / tail, 1.0, 1e-7);
        }
        EXPECT_LT(interval.low, interval.high);
      }
    }
  }
}

TEST(ShareIntervalLaw, ShrinksWithMoreRays) {
  double width = 1.0;
  for (std::uint64_t rays = 100; rays <= 100'000'000; rays *= 10) {
    const ShareInterval interval = share_interval(rays / 100, rays, 0.95);
    EXPECT_LT(interval.low, 0.01);
    EXPECT_GT(interval.high, 0.01);
    EXPECT_LT(interval.high - interval.low, width);
    width = interval.high - interval.low;
  }
}

TEST(UnseenShareLaw, BoundsTheChanceThatAnyFacetIsMissed) {
  EXPECT_EQ(unseen_share_bound(0, 0.95), 1.0);
  double last = 1.0;
  for (std::uint64_t rays = 1; rays <= 1'000'000'000; rays *= 10) {
    const double share = unseen_share_bound(rays, 0.95);
    EXPECT_LE(share, last);
    last = share;
    if (share == 1.0) continue;
    const double chance = std::exp(static_cast<double>(rays) * std::log1p(-share)) / share;
    EXPECT_NEAR(chance, 0.05, 1e-9);
  }
  EXPECT_LT(unseen_share_bound(1000, 0.9), unseen_share_bound(1000, 0.99));
}

TEST(CoverageEstimateLaw, IsNearlyRightWhereAllKindsAreAlike) {
  EXPECT_EQ(coverage_estimate(0, 0, 0), 0.0);
  EXPECT_EQ(coverage_estimate(5, 0, 0), 0.0);
  EXPECT_EQ(coverage_estimate(0, 1, 7), 1.0);
  constexpr double kKinds = 1e9;
  for (double rate = 0.1; rate < 10.0; rate *= 1.3) {
    const double none = std::exp(-rate), one = rate * none, two = 0.5 * rate * one;
    const auto count = [](double share) { return static_cast<std::uint64_t>(kKinds * share); };
    EXPECT_NEAR(coverage_estimate(count(one), count(two), count(1.0 - none - one - two)), 1.0 - none, 0.025)
        << rate;
  }
}

TEST(UnseenEstimateExample, CountsAsChaoDoes) {
  EXPECT_EQ(unseen_estimate(0, 0), 0.0);
  EXPECT_EQ(unseen_estimate(1, 0), 0.0);
  EXPECT_EQ(unseen_estimate(10, 4), 9.0);
}

}  // namespace
}  // namespace ndhull
