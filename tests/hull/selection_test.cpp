// Selections of facets: closed forms, brute force, and regions that their outer planes bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/geometry/boundedness.h"
#include "approx/polytope/outer_volume.h"
#include "approx/selection/facet_selection.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

/// A box with sides 1, 2, 3 .. d: its facets have d different areas, each twice.
PointSet box(std::size_t d) {
  PointSet corners = cube(d).points;
  std::vector<double> sides(d);
  std::iota(sides.begin(), sides.end(), 1.0);
  for (double& side : sides) side *= 0.5;  // the cube's own sides are 2
  return axis_scaled(corners, sides);
}

std::vector<double> normals_of(const Hull& hull, const std::vector<FacetId>& facets) {
  std::vector<double> normals;
  for (const FacetId facet : facets) {
    const auto normal = hull.normal(facet);
    normals.insert(normals.end(), normal.begin(), normal.end());
  }
  return normals;
}

bool contains(const std::vector<FacetId>& facets, FacetId facet) {
  return std::binary_search(facets.begin(), facets.end(), facet);
}

TEST(SelectionExample, TheLargestFacetsOfABoxAreThoseAcrossItsShortestSide) {
  for (std::size_t d = 2; d <= 6; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    const Hull hull = hull_of(box(d));
    double largest = 1.0;
    for (std::size_t side = 2; side <= d; ++side) largest *= static_cast<double>(side);
    const FacetSelection two = select_facets(hull, {.largest = 2});
    ASSERT_EQ(two.facets.size(), 2U);
    for (const FacetId facet : two.facets) {
      EXPECT_NEAR(hull.area_of(facet), largest, 1e-12 * largest);
      EXPECT_NEAR(std::abs(hull.normal(facet)[0]), 1.0, 1e-14);
    }
    EXPECT_FALSE(two.bounded);
    // Facets across the side of length k have the area largest / k.
    const FacetSelection half = select_facets(hull, {.min_area = 0.4 * largest});
    EXPECT_EQ(half.facets.size(), 4U);
    EXPECT_EQ(half.bounded, d == 2);
    EXPECT_EQ(select_facets(hull, {.min_area = 0.9 * largest}).facets, two.facets);
  }
}

TEST(SelectionExample, OneFacetOfACubeAndAllThatItNeeds) {
  const Hull hull = hull_of(cube(4).points);
  const FacetSelection one = select_facets(hull, {.largest = 1});
  ASSERT_EQ(one.facets.size(), 1U);
  EXPECT_FALSE(one.bounded);
  EXPECT_EQ(one.added, 0U);
  ASSERT_EQ(one.open_direction.size(), 4U);
  const auto normal = hull.normal(one.facets[0]);
  EXPECT_LE(std::inner_product(normal.begin(), normal.end(), one.open_direction.begin(), 0.0), 1e-14);
  const FacetSelection closed = select_facets(hull, {.largest = 1, .bounded = true});
  EXPECT_EQ(closed.facets.size(), 8U);
  EXPECT_EQ(closed.added, 7U);
  EXPECT_TRUE(closed.bounded);
  EXPECT_TRUE(closed.open_direction.empty());
}

TEST(SelectionExample, MostMergedAreTheFlats) {
  // A prism over a heptagon: its two ends are made of 5 triangles, its sides of 2 each.
  PointSet prism;
  prism.dimension = 3;
  for (int k = 0; k < 14; ++k) {
    const double angle = 0.1 + std::acos(-1.0) * 2.0 * (k % 7) / 7.0;
    for (const double value : {std::cos(angle), std::sin(angle), k < 7 ? 0.0 : 1.0})
      prism.coordinates.push_back(value);
  }
  const Hull hull = hull_of(prism);
  ASSERT_EQ(hull.facet_count(), 9U);
  const FacetSelection ends = select_facets(hull, {.most_merged = 2});
  ASSERT_EQ(ends.facets.size(), 2U);
  for (const FacetId facet : ends.facets) EXPECT_NEAR(std::abs(hull.normal(facet)[2]), 1.0, 1e-14);
}

TEST(SelectionLaw, OptionsAreIntersectedAndNoneDroppedIsBetter) {
  // Points of a ball rounded to a lattice have facets of many areas, of one simplex or many.
  PointSet points = family_points(PointFamily::kBall, 400, 4, 3);
  for (double& value : points.coordinates) value = std::round(4.0 * value);
  const Hull hull = hull_of(points);
  const auto simplices = [&hull](FacetId facet) { return hull.simplices_of(facet).size(); };
  const auto area = [&hull](FacetId facet) { return hull.area_of(facet); };
  ASSERT_GT(hull.facet_count(), 40U);
  for (const std::uint64_t count : {1U, 7U, 30U}) {
    const auto largest = select_facets(hull, {.largest = count}).facets;
    const auto merged = select_facets(hull, {.most_merged = count}).facets;
    ASSERT_EQ(largest.size(), count);
    ASSERT_EQ(merged.size(), count);
    double smallest = HUGE_VAL;
    std::size_t fewest = SIZE_MAX;
    for (const FacetId facet : largest) smallest = std::min(smallest, area(facet));
    for (const FacetId facet : merged) fewest = std::min(fewest, simplices(facet));
    for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
      EXPECT_TRUE(contains(largest, FacetId{id}) || area(FacetId{id}) <= smallest);
      EXPECT_TRUE(contains(merged, FacetId{id}) || simplices(FacetId{id}) <= fewest);
    }
    const double limit = 1.0000001 * smallest;
    const auto both =
        select_facets(hull, {.largest = count, .min_area = limit, .most_merged = 2 * count}).facets;
    const auto more_merged = select_facets(hull, {.most_merged = 2 * count}).facets;
    std::vector<FacetId> expected;
    for (const FacetId facet : largest) {
      if (area(facet) >= limit && contains(more_merged, facet)) expected.push_back(facet);
    }
    EXPECT_EQ(both, expected);
    EXPECT_TRUE(std::is_sorted(largest.begin(), largest.end()));
  }
  EXPECT_EQ(select_facets(hull, {.largest = 1'000'000}).facets.size(), hull.facet_count());
  EXPECT_TRUE(select_facets(hull, {.largest = 1'000'000}).bounded);
  EXPECT_TRUE(select_facets(hull, {.min_area = HUGE_VAL}).facets.empty());
}

TEST(SelectionLaw, TiesDoNotDependOnThreads) {
  const PointSet points = cube(6).points;
  for (const std::uint64_t count : {1U, 5U, 11U}) {
    std::vector<FacetId> first;
    for (const unsigned threads : {1U, 2U, 4U}) {
      const Hull hull = hull_of(points, {.threads = threads});
      const auto facets = select_facets(hull, {.largest = count, .most_merged = count}).facets;
      if (threads == 1) first = facets;
      EXPECT_EQ(facets, first);
    }
  }
}

TEST(SelectionLaw, FewLargestFacetsAreCompletedToARegion) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Hull hull = hull_of(family_points(PointFamily::kSphere, 200, 5, seed));
    for (std::uint64_t count = 1; count <= 6; ++count) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(count) + " largest");
      const FacetSelection open = select_facets(hull, {.largest = count});
      const FacetSelection closed = select_facets(hull, {.largest = count, .bounded = true});
      EXPECT_TRUE(closed.bounded);
      EXPECT_EQ(closed.facets.size(), open.facets.size() + closed.added);
      EXPECT_TRUE(
          std::includes(closed.facets.begin(), closed.facets.end(), open.facets.begin(), open.facets.end()));
      EXPECT_EQ(closed.added == 0, open.bounded);
      if (!open.bounded) {
        const std::vector<double> normals = normals_of(hull, open.facets);
        for (std::size_t row = 0; row < open.facets.size(); ++row) {
          EXPECT_LE(std::inner_product(open.open_direction.begin(), open.open_direction.end(),
                                       normals.begin() + static_cast<std::ptrdiff_t>(5 * row), 0.0),
                    1e-12);
        }
      }
      EXPECT_TRUE(find_open_direction(normals_of(hull, closed.facets), 5).bounded);
      const OuterVolume outer = outer_volume(hull, closed.facets, {.max_facets = 1'000'000});
      ASSERT_TRUE(outer.volume) << outer.reason;
      EXPECT_GT(*outer.volume, hull.volume);
    }
  }
}

TEST(SelectionExample, FlatHullsAndPoints) {
  const Hull flat = hull_of(embedded(cube(3).points, 5, 9));
  const FacetSelection closed = select_facets(flat, {.largest = 2, .bounded = true});
  EXPECT_EQ(closed.facets.size(), 6U);
  EXPECT_TRUE(closed.bounded);
  EXPECT_FALSE(select_facets(flat, {.largest = 2}).bounded);
  const Hull point = hull_of({.dimension = 3, .coordinates = {1.0, 2.0, 3.0}});
  const FacetSelection none = select_facets(point, {.largest = 2});
  EXPECT_TRUE(none.facets.empty());
  EXPECT_TRUE(none.bounded);
}

TEST(SelectionRegression, AreasBeyondTheRangeOfDoublesAreTheLargest) {
  PointSet points = box(3);
  for (double& value : points.coordinates) value *= 1e160;
  const Hull hull = hull_of(points);
  EXPECT_EQ(select_facets(hull, {.largest = 2}).facets.size(), 2U);
  EXPECT_EQ(select_facets(hull, {.min_area = 1e300}).facets.size(), 6U);
}

}  // namespace
}  // namespace ndhull
