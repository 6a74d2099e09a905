// Hits of uniform rays against the true shares of directions, on hulls that can be built.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <numbers>

#include "approx/rays/largest_facets.h"
#include "core/portable_random.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

/// Share of directions of a triangle seen from `eye`.
/// Source  van Oosterom, Strackee. The solid angle of a plane triangle. IEEE Trans. Biomed. Eng. 30(2), 1983.
double triangle_share(const Eigen::Matrix3d& corners) {
  const Eigen::Vector3d a = corners.col(0), b = corners.col(1), c = corners.col(2);
  const double determinant = std::abs(corners.determinant());
  const double x = a.norm(), y = b.norm(), z = c.norm();
  const double divisor = x * y * z + a.dot(b) * z + a.dot(c) * y + b.dot(c) * x;
  return 2.0 * std::atan2(determinant, divisor) / (4.0 * std::numbers::pi);
}

/// Share of directions of a simplex in any dimension: the mean of |det| / ((d - 1)! area of the unit sphere
/// |x|^d) over points x spread evenly on it. Error some 0.5 %.
double simplex_share(const Eigen::MatrixXd& corners, PortableRandom& random) {
  constexpr int kSamples = 20000;
  const auto d = static_cast<double>(corners.cols());
  const double sphere = 2.0 * std::pow(std::numbers::pi, d / 2.0) / std::tgamma(d / 2.0);
  double sum = 0.0;
  for (int sample = 0; sample < kSamples; ++sample) {
    Eigen::VectorXd weights(corners.cols());
    for (Eigen::Index k = 0; k < weights.size(); ++k) weights[k] = random.exponential();
    sum += std::pow((corners * weights / weights.sum()).norm(), -d);
  }
  return sum / kSamples * std::abs(corners.determinant()) / (std::tgamma(d) * sphere);
}

/// How many standard deviations a chi-square value is off, nearly (Wilson, Hilferty. PNAS 17, 1931).
double chi_square_deviation(double value, double freedom) {
  const double spread = 2.0 / (9.0 * freedom);
  return (std::cbrt(value / freedom) - (1.0 - spread)) / std::sqrt(spread);
}

/// Shares of all facets about a point, by their vertices.
std::map<VertexSet, double> true_shares(const PointSet& set, const std::vector<double>& centre) {
  const Hull hull = hull_of(set);
  std::map<VertexSet, double> shares;
  PortableRandom random(99);
  const auto d = static_cast<Eigen::Index>(set.dimension);
  for (const VertexSet& vertices : facet_sets(hull)) {
    Eigen::MatrixXd corners(d, d);
    for (Eigen::Index column = 0; column < d; ++column) {
      for (Eigen::Index k = 0; k < d; ++k) {
        corners(k, column) =
            set.row(vertices[static_cast<std::size_t>(column)])[static_cast<std::size_t>(k)] -
            centre[static_cast<std::size_t>(k)];
      }
    }
    shares[vertices] = d == 3 ? triangle_share(corners) : simplex_share(corners, random);
  }
  return shares;
}

void expect_unbiased(const PointSet& set, std::uint64_t rays) {
  std::map<VertexSet, double> shares;
  double mean_deviation = 0.0, covered = 0.0, intervals = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const LargestFacets found = largest_facets(
        set.view(), {.count = 1'000'000, .method = LargestMethod::kRays, .rays = rays, .seed = seed});
    ASSERT_EQ(found.sample.rays, rays);
    EXPECT_EQ(found.sample.open_rays, 0U);
    EXPECT_EQ(found.sample.directions, "input");
    if (shares.empty()) {
      shares = true_shares(set, found.interior_point);
      double sum = 0.0;
      for (const auto& [vertices, share] : shares) sum += share;
      EXPECT_NEAR(sum, 1.0, set.dimension == 3 ? 1e-12 : 2e-3);
    }
    EXPECT_EQ(found.facets.size(), shares.size());
    double chi_square = 0.0, freedom = -1.0, rare = 0.0, rare_hits = 0.0;
    std::uint64_t hits = 0;
    for (const LargestFacet& facet : found.facets) {
      VertexSet vertices;
      for (const PointId id : facet.vertices) vertices.push_back(id.value);
      ASSERT_EQ(shares.count(vertices), 1U);
      const double share = shares[vertices];
      covered += share >= facet.share.low && share <= facet.share.high ? 1.0 : 0.0;
      ++intervals;
      hits += facet.hits;
      if (facet.hits == 0) {
        EXPECT_LE(share, found.sample.unseen_share);
      }
      const double expected = share * static_cast<double>(rays);
      const auto counted = static_cast<double>(facet.hits);
      if (expected < 5.0) {  // too few for the distribution: together
        rare += expected;
        rare_hits += counted;
        continue;
      }
      chi_square += (counted - expected) * (counted - expected) / expected;
      ++freedom;
    }
    if (rare >= 5.0) {
      chi_square += (rare_hits - rare) * (rare_hits - rare) / rare;
      ++freedom;
    }
    EXPECT_EQ(hits, rays);
    // One run in 10^4 is further off.
    const double deviation = chi_square_deviation(chi_square, freedom);
    EXPECT_LT(std::abs(deviation), 3.9) << "seed " << seed;
    mean_deviation += deviation / 10.0;
  }
  EXPECT_GE(covered, 0.93 * intervals);  // at least 0.95 are expected
  // The mean of ten has a third of the spread.
  EXPECT_LT(std::abs(mean_deviation), 1.3);
}

TEST(RaySampleLaw, HitsFollowTheSolidAnglesOfASphereSetIn3d) {
  expect_unbiased(family_points(PointFamily::kSphere, 60, 3, 5), 20000);
}

TEST(RaySampleLaw, HitsFollowTheSolidAnglesOfASphereSetIn5d) {
  expect_unbiased(family_points(PointFamily::kSphere, 30, 5, 5), 20000);
}

}  // namespace
}  // namespace ndhull
