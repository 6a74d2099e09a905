#include "bench/expected_facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "approx/hull.h"
#include "core/error.h"

namespace ndhull {
namespace {

constexpr PointFamily kFamilies[] = {PointFamily::kSphere, PointFamily::kBall, PointFamily::kGaussian};

TEST(ExpectedFacetsExample, ASimplexHasOneFacetMoreThanDimensions) {
  for (const PointFamily family : kFamilies) {
    for (std::size_t d = 2; d <= 16; ++d) {
      EXPECT_NEAR(expected_facet_count(family, d, d + 1), static_cast<double>(d + 1), 1e-6);
    }
  }
}

TEST(ExpectedFacetsExample, OnACircleEveryPointBeginsAFacet) {
  for (const std::size_t n : {3U, 10U, 3000U}) {
    EXPECT_NEAR(expected_facet_count(PointFamily::kSphere, 2, n), static_cast<double>(n),
                1e-4 * static_cast<double>(n));
  }
}

TEST(ExpectedFacetsExample, PointsOnASphereIn3dHaveEulersNumberOfFacets) {
  for (const std::size_t n : {4U, 5000U, 1000000U}) {
    const double facets = 2.0 * static_cast<double>(n) - 4.0;
    EXPECT_NEAR(expected_facet_count(PointFamily::kSphere, 3, n), facets, 1e-4 * facets);
  }
}

// Sylvester's problem: the chance that one point is inside the hull of the others. Kendall, Moran.
// Geometrical Probability, 1963; Blatter. Four shots for a convex quadrilateral. Amer. Math. Monthly 115(9),
// 2008.
TEST(ExpectedFacetsExample, SylvestersProblemIsAnsweredAsInTheBooks) {
  using std::numbers::pi;
  EXPECT_NEAR(expected_facet_count(PointFamily::kBall, 2, 4), 4.0 - 35.0 / (12.0 * pi * pi), 1e-7);
  EXPECT_NEAR(expected_facet_count(PointFamily::kBall, 3, 5), 6.0 - 2.0 * 9.0 / 143.0, 1e-7);
  EXPECT_NEAR(expected_facet_count(PointFamily::kGaussian, 2, 4), 3.0 + 6.0 / pi * std::asin(1.0 / 3.0),
              1e-7);
}

// The spread of one count is about 8 % in 5-d and 4 % in 7-d, so that of these means is below 1 %.
TEST(ExpectedFacetsOracle, MeansOfMeasuredHullsAgreeWithinThreePercent) {
  struct Sample {
    std::size_t dimension, count;
    unsigned seeds;
  };
  for (const PointFamily family : kFamilies) {
    for (const Sample& sample : {Sample{5, 150, 100}, Sample{7, 100, 30}}) {
      double facets = 0.0;
      for (unsigned seed = 1; seed <= sample.seeds; ++seed) {
        const PointSet points = generate_points(
            {.family = family, .dimension = sample.dimension, .count = sample.count, .seed = seed});
        facets += static_cast<double>(convex_hull(points.view(), {.threads = 1}).facet_count());
      }
      const double expected = expected_facet_count(family, sample.dimension, sample.count);
      EXPECT_NEAR(facets / sample.seeds / expected, 1.0, 0.03)
          << to_string(family) << ", " << sample.dimension << "-d";
      RecordProperty(std::string(to_string(family)) + std::to_string(sample.dimension),
                     std::to_string(facets / sample.seeds / expected));
    }
  }
}

TEST(ExpectedFacetsExample, OtherFamiliesAreRefused) {
  EXPECT_THROW(expected_facet_count(PointFamily::kCube, 5, 100), Error);
}

}  // namespace
}  // namespace ndhull
