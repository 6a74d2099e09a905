// The largest facets against the whole hull, on every kind of input, by both methods.
#include "approx/rays/largest_facets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "approx/geometry/boundedness.h"
#include "core/error.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

std::vector<double> sorted_areas(const Hull& hull) {
  std::vector<double> areas;
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) areas.push_back(hull.area_of(FacetId{id}));
  std::sort(areas.begin(), areas.end(), std::greater<>());
  return areas;
}

VertexSet vertex_ids(const LargestFacet& facet) {
  VertexSet ids;
  for (const PointId id : facet.vertices) ids.push_back(id.value);
  return ids;
}

/// Every facet given is certified: in long double, over all points.
void expect_certified(const LargestFacets& found, const PointSet& set) {
  for (const LargestFacet& facet : found.facets) {
    long double norm_sq = 0.0L;
    for (const double x : facet.normal) norm_sq += static_cast<long double>(x) * x;
    EXPECT_NEAR(static_cast<double>(norm_sq), 1.0, 1e-14);
    const auto distance = [&](std::size_t row) {
      long double sum = facet.centred_offset;
      for (std::size_t k = 0; k < set.dimension; ++k) {
        sum += static_cast<long double>(facet.normal[k]) *
               (static_cast<long double>(set.row(row)[k]) - found.reference[k]);
      }
      return sum;
    };
    for (std::size_t row = 0; row < set.rows(); ++row) EXPECT_LE(distance(row), facet.outer_offset);
    for (const PointId id : facet.vertices) EXPECT_GE(distance(id.value), facet.inner_offset);
    EXPECT_LE(facet.outer_offset - facet.inner_offset, 1e-10 * extent_of(set));
  }
}

TEST(LargestFacetsOracle, RaysFindTheFacetsOfSmallHullsAndTheirAreas) {
  for (const PointFamily family : {PointFamily::kSphere, PointFamily::kGaussian, PointFamily::kCube,
                                   PointFamily::kBall, PointFamily::kCyclic}) {
    for (std::size_t d = 2; d <= 6; ++d) {
      SCOPED_TRACE(std::string(to_string(family)) + " " + std::to_string(d));
      const PointSet set = family_points(family, 25, d, 7);
      const Hull hull = hull_of(set);
      const LargestFacets found = largest_facets(
          set.view(), {.count = hull.facet_count() + 10, .method = LargestMethod::kRays, .rays = 200});
      expect_certified(found, set);
      // All are found: the facets of a hull are connected, and climbs go everywhere when so many are wanted.
      std::vector<VertexSet> sets;
      for (const LargestFacet& facet : found.facets) sets.push_back(vertex_ids(facet));
      std::sort(sets.begin(), sets.end());
      EXPECT_EQ(sets, facet_sets(hull));
      const std::vector<double> areas = sorted_areas(hull);
      ASSERT_EQ(areas.size(), found.facets.size());
      for (std::size_t row = 0; row < areas.size(); ++row) {
        EXPECT_NEAR(found.facets[row].area, areas[row], 1e-9 * areas[row] + 1e-13 * areas[0]);
      }
      EXPECT_EQ(found.is_bounded, std::optional<bool>(true));
    }
  }
}

TEST(LargestFacetsOracle, RaysMergeCoplanarSimplices) {
  struct Case {
    PointFamily family;
    std::size_t count, dimension, facets;
  };
  for (const Case& c : {Case{PointFamily::kCubeCorners, 0, 5, 10}, Case{PointFamily::kCubeCorners, 0, 3, 6},
                        Case{PointFamily::kLattice, 81, 4, 8}, Case{PointFamily::kLattice, 9, 2, 4},
                        Case{PointFamily::kCrossPolytope, 0, 5, 32}, Case{PointFamily::kSimplex, 0, 6, 7}}) {
    SCOPED_TRACE(std::string(to_string(c.family)));
    const PointSet set = family_points(c.family, c.count, c.dimension, 1);
    const Hull hull = hull_of(set);
    ASSERT_EQ(hull.facet_count(), c.facets);
    const LargestFacets found =
        largest_facets(set.view(), {.count = 1000, .method = LargestMethod::kRays, .rays = 300});
    expect_certified(found, set);
    ASSERT_EQ(found.facets.size(), c.facets);
    const std::vector<double> areas = sorted_areas(hull);
    for (std::size_t row = 0; row < areas.size(); ++row) {
      EXPECT_NEAR(found.facets[row].area / areas[row], 1.0, 1e-9);
      EXPECT_TRUE(found.facets[row].area_is_whole);
    }
    std::vector<VertexSet> sets;
    for (const LargestFacet& facet : found.facets) sets.push_back(vertex_ids(facet));
    std::sort(sets.begin(), sets.end());
    EXPECT_EQ(sets, facet_sets(hull));
  }
}

TEST(LargestFacetsLaw, RaysCertifyWhatTheyFindOnDegenerateInputs) {
  for (std::size_t d = 2; d <= 5; ++d) {
    for (const DegenerateCase& input : degenerate_cases(50, d, 10 + d)) {
      SCOPED_TRACE(input.description + ", d " + std::to_string(d));
      const Hull hull = hull_of(input.points);
      const LargestFacets found = largest_facets(
          input.points.view(), {.count = 10, .method = LargestMethod::kRays, .rays = 300, .bounded = true});
      EXPECT_EQ(found.rank, hull.rank);
      EXPECT_EQ(found.sample.open_rays, 0U);
      expect_certified(found, input.points);
      if (hull.rank == 0) continue;
      EXPECT_EQ(found.is_bounded, std::optional<bool>(true));
      const std::vector<double> areas = sorted_areas(hull);
      ASSERT_EQ(found.largest_count, std::min<std::size_t>(10, areas.size()));
      // Rounding decides which of two nearly coplanar simplices are one facet: the largest are clear.
      EXPECT_NEAR(found.facets[0].area / areas[0], 1.0, 1e-6);
    }
  }
}

TEST(LargestFacetsOracle, AutoGivesTheFacetsOfTheHull) {
  for (std::size_t d = 5; d <= 7; ++d) {
    const PointSet set = family_points(PointFamily::kSphere, 80, d, d);
    const Hull hull = hull_of(set);
    const LargestFacets found = largest_facets(set.view(), {.count = 20});
    EXPECT_EQ(found.method, LargestMethod::kHull);
    EXPECT_EQ(found.status, LargestStatus::kComplete);
    EXPECT_EQ(found.sample.rays, 0U);
    const std::vector<double> areas = sorted_areas(hull);
    ASSERT_EQ(found.facets.size(), 20U);
    for (std::size_t row = 0; row < 20; ++row) EXPECT_EQ(found.facets[row].area, areas[row]);
    expect_certified(found, set);
  }
}

/// The hull of 300 points in 8-d has about 600,000 facets; here a smaller one, without looking at the clock.
TEST(LargestFacetsOracle, RaysFindMostOfTheLargestOfManyFacets) {
  const PointSet set = family_points(PointFamily::kGaussian, 400, 7, 3);
  const std::vector<double> areas = sorted_areas(hull_of(set));
  double recall = 0.0, estimate = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const LargestFacets found =
        largest_facets(set.view(), {.count = 20, .method = LargestMethod::kRays, .seed = seed});
    const auto hit = std::count_if(found.facets.begin(), found.facets.end(), [&](const LargestFacet& facet) {
      return facet.area >= areas[19] * (1.0 - 1e-9);
    });
    recall += static_cast<double>(hit) / 200.0;
    estimate += found.sample.recall.value() / 10.0;
    EXPECT_LT(found.sample.facets_found, areas.size() / 2);
  }
  EXPECT_GE(recall, 0.9);
  EXPECT_NEAR(estimate, recall, 0.1);
}

TEST(LargestFacetsExample, AutoTakesRaysWhereNoHullCanBeBuilt) {
  const PointSet set = family_points(PointFamily::kGaussian, 2000, 20, 3);
  const LargestFacets found = largest_facets(set.view(), {.count = 5, .rays = 20, .bounded = true});
  EXPECT_EQ(found.method, LargestMethod::kRays);
  EXPECT_EQ(found.status, LargestStatus::kRayLimit);
  EXPECT_EQ(found.sample.rays, 20U);
  EXPECT_EQ(found.largest_count, 5U);
  EXPECT_GE(found.facets.size(), 21U);  // fewer planes bound no region
  EXPECT_EQ(found.is_bounded, std::optional<bool>(true));
  expect_certified(found, set);
}

TEST(LargestFacetsExample, ThirtyDimensionsAreNotTooMany) {
  const PointSet set = family_points(PointFamily::kGaussian, 300, 30, 3);
  const LargestFacets found = largest_facets(set.view(), {.count = 3, .rays = 10});
  EXPECT_EQ(found.largest_count, 3U);
  expect_certified(found, set);
  const PointSet simplex = family_points(PointFamily::kSimplex, 0, 30, 1);
  const LargestFacets all = largest_facets(simplex.view(), {.count = 100, .rays = 50});
  ASSERT_EQ(all.largest_count, 31U);
  // sqrt(30) / 29! and 1 / 29!
  EXPECT_NEAR(all.facets[0].area * std::tgamma(30.0), std::sqrt(30.0), 1e-9);
  EXPECT_NEAR(all.facets[30].area * std::tgamma(30.0), 1.0, 1e-9);
}

// The scale of a 50-d volume is no double where coordinates are a million; areas are.
TEST(LargestFacetsLaw, AreasScaleInFiftyDimensions) {
  constexpr std::size_t kDimension = 50;
  constexpr int kExponent = 20;
  PointSet set = family_points(PointFamily::kGaussian, 120, kDimension, 3);
  LargestOptions options;
  options.method = LargestMethod::kRays;
  options.count = 5;
  options.rays = 50;
  const LargestFacets small = largest_facets(set.view(), options);
  for (double& coordinate : set.coordinates) coordinate = std::ldexp(coordinate, kExponent);
  const LargestFacets large = largest_facets(set.view(), options);
  ASSERT_EQ(small.facets.size(), large.facets.size());
  for (std::size_t id = 0; id < small.facets.size(); ++id) {
    EXPECT_EQ(vertex_ids(small.facets[id]), vertex_ids(large.facets[id]));
    EXPECT_GT(small.facets[id].area, 0.0);
    EXPECT_NEAR(std::ldexp(small.facets[id].area, kExponent * (static_cast<int>(kDimension) - 1)) /
                    large.facets[id].area,
                1.0, 1e-9);
  }
}

TEST(LargestFacetsLaw, SameBytesForAnyNumberOfThreads) {
  const PointSet set = family_points(PointFamily::kGaussian, 5000, 9, 4);
  const LargestFacets one =
      largest_facets(set.view(), {.count = 30, .method = LargestMethod::kRays, .rays = 600, .threads = 1});
  const LargestFacets three =
      largest_facets(set.view(), {.count = 30, .method = LargestMethod::kRays, .rays = 600, .threads = 3});
  ASSERT_EQ(one.facets.size(), three.facets.size());
  for (std::size_t row = 0; row < one.facets.size(); ++row) {
    EXPECT_EQ(one.facets[row].normal, three.facets[row].normal);
    EXPECT_EQ(one.facets[row].outer_offset, three.facets[row].outer_offset);
    EXPECT_EQ(one.facets[row].area, three.facets[row].area);
    EXPECT_EQ(one.facets[row].hits, three.facets[row].hits);
  }
}

TEST(LargestFacetsExample, MinAreaLeavesSmallerOnesOut) {
  const PointSet set = family_points(PointFamily::kSphere, 40, 4, 4);
  const std::vector<double> areas = sorted_areas(hull_of(set));
  for (const LargestMethod method : {LargestMethod::kHull, LargestMethod::kRays}) {
    const LargestFacets found =
        largest_facets(set.view(), {.count = 1000, .min_area = areas[7] * (1.0 - 1e-9), .method = method});
    EXPECT_EQ(found.largest_count, 8U);
  }
}

TEST(LargestFacetsExample, AStopRequestLeavesAnAnswer) {
  std::stop_source stop;
  stop.request_stop();
  const PointSet set = family_points(PointFamily::kSphere, 100, 6, 4);
  const LargestFacets found =
      largest_facets(set.view(), {.method = LargestMethod::kRays, .stop = stop.get_token()});
  EXPECT_EQ(found.status, LargestStatus::kInterrupted);
  EXPECT_EQ(found.sample.rays, 0U);
  EXPECT_TRUE(found.facets.empty());
}

// Some thousand simplices each: all areas take seconds.
TEST(LargestFacetsLaw, FacetsOfManyPointsHaveAreasOfPartsWhereTimeIsShort) {
  PointSet set = family_points(PointFamily::kCube, 90, 12, 5);
  for (double& x : set.coordinates) x = x < 0.0 ? 0.0 : 1.0;
  const LargestFacets found =
      largest_facets(set.view(), {.count = 1000, .method = LargestMethod::kRays, .max_seconds = 0.3});
  EXPECT_EQ(found.status, LargestStatus::kTimeLimit);
  ASSERT_GT(found.facets.size(), 0u);
  expect_certified(found, set);
  std::size_t parts = 0;
  for (const LargestFacet& facet : found.facets) {
    EXPECT_GT(facet.area, 0.0);
    parts += facet.area_is_whole ? 0u : 1u;
  }
  EXPECT_GT(parts, 0u);
}

TEST(LargestFacetsExample, TooManyDimensionsAreAnError) {
  const PointSet set = family_points(PointFamily::kGaussian, 100, 65, 1);
  try {
    largest_facets(set.view());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kDimensionTooHigh);
  }
}

}  // namespace
}  // namespace ndhull
