// Targets for hulls of few large facets: found whole, and joined where a width lets them.
#include <gtest/gtest.h>

#include "core/portable_random.h"
#include "tests/approximate/approximate_laws.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

Hull with_width(const PointSet& set, double width) {
  HullOptions options;
  options.accuracy.width = {width};
  return hull_of(set, options);
}

Hull with_facets(const PointSet& set, std::uint64_t facets) {
  HullOptions options;
  options.accuracy.facets = facets;
  return hull_of(set, options);
}

bool is_described(const Hull& hull) { return hull.statistics.created_facets > 0; }

PointSet points_in(std::size_t dimension, std::size_t count, std::uint64_t seed) {
  PointSet set;
  set.dimension = dimension;
  PortableRandom random(seed);
  for (std::size_t i = 0; i < count * dimension; ++i) set.coordinates.push_back(random.symmetric());
  return set;
}

TEST(DescribedJoinLaw, WidthsAndAreasAreThoseOfTheSimplices) {
  // A 7-d product of a solid, a polygon and a square, some points on the faces of others.
  const PointSet set = product(product(points_in(3, 9, 1), points_in(2, 7, 2)),
                               product(points_in(1, 3, 3), points_in(1, 2, 4)));
  const Hull exact = hull_of(set);
  std::size_t before = exact.facet_count() + 1;
  bool has_joined = false;
  for (const double width : {1e-6, 0.05, 0.2, 0.4, 0.8}) {
    SCOPED_TRACE(width);
    const Hull hull = with_width(set, width);
    EXPECT_TRUE(is_described(hull));
    expect_approximate_laws(hull, set.view());
    EXPECT_LE(hull.max_facet_width, width);
    EXPECT_LE(hull.facet_count(), exact.facet_count());
    EXPECT_LE(hull.facet_count(), before);
    before = hull.facet_count();
    EXPECT_NEAR(hull.volume, exact.volume, 1e-9 * exact.volume);
    EXPECT_NEAR(hull.area, exact.area, 1e-9 * exact.area);
    has_joined = has_joined || hull.facet_count() < exact.facet_count();
  }
  EXPECT_TRUE(has_joined);
}

// A square with a corner cut off by little, times a cube: that facet goes first, and nothing else changes.
TEST(DescribedJoinExample, AnEdgeCutOffByLittleGoes) {
  PointSet square;
  square.dimension = 2;
  square.coordinates = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.99, 0.99, 1.0};
  const PointSet set = product(square, cube(5).points);
  EXPECT_EQ(hull_of(set).facet_count(), 15u);
  const Hull hull = with_width(set, 0.02);
  EXPECT_TRUE(is_described(hull));
  EXPECT_EQ(hull.facet_count(), 14u);
  EXPECT_LE(hull.max_facet_width, 0.01);
  expect_approximate_laws(hull, set.view());
}

TEST(DescribedJoinLaw, AsManyFacetsAsTheHullHasAreItsOwn) {
  for (const NamedPolytope& polytope : {cube(8), grid(3, 6), product_of_simplices(3, 4)}) {
    SCOPED_TRACE(polytope.name);
    for (const std::uint64_t more : {0u, 1u, 100u}) {
      const Hull hull = with_facets(polytope.points, polytope.facets + more);
      EXPECT_EQ(hull.facet_count(), polytope.facets);
      EXPECT_LT(hull.max_facet_width, 1e-12 * extent_of(polytope.points));
    }
    const Hull fewer = with_facets(polytope.points, polytope.facets - 1);
    EXPECT_LT(fewer.facet_count(), polytope.facets);
    expect_approximate_laws(fewer, polytope.points.view());
  }
}

TEST(DescribedJoinLaw, FewerFacetsThanTheHullHasAreJoined) {
  const PointSet set = product(product(points_in(3, 9, 1), points_in(2, 7, 2)), points_in(2, 8, 3));
  const Hull exact = hull_of(set);
  double narrower = 0.0;
  for (std::uint64_t facets = exact.facet_count() - 1; facets > exact.rank + 3; facets -= 2) {
    SCOPED_TRACE(facets);
    const Hull hull = with_facets(set, facets);
    EXPECT_TRUE(is_described(hull));
    EXPECT_LE(hull.facet_count(), facets);
    EXPECT_GE(hull.max_facet_width, narrower);
    narrower = hull.max_facet_width;
    expect_approximate_laws(hull, set.view());
    EXPECT_NEAR(hull.area, exact.area, 1e-9 * exact.area);
  }
  EXPECT_GT(narrower, 0.01);
}

// Whoever asks for simplices, as --verify does, gets those of the same hull.
TEST(DescribedJoinLaw, SimplicesChangeNothing) {
  const PointSet set = product(points_in(3, 8, 5), product(points_in(2, 6, 6), points_in(2, 6, 7)));
  for (const double width : {0.1, 0.5}) {
    HullOptions options;
    options.accuracy.width = {width};
    const Hull hull = hull_of(set, options);
    options.wants_simplices = true;
    EXPECT_EQ(facet_sets(hull), facet_sets(hull_of(set, options)));
  }
}

}  // namespace
}  // namespace ndhull
