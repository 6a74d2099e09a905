// What is asked for near rounding, or is the exact hull: widths that growth cannot tell from 0, numbers of
// facets that the exact hull keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

/// Points of a grid of `values` in each coordinate; many share planes with more than they need.
PointSet integers(std::size_t n, std::size_t d, int values, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  PointSet set;
  set.dimension = d;
  for (std::size_t i = 0; i < n * d; ++i)
    set.coordinates.push_back(static_cast<double>(random() % static_cast<std::uint64_t>(values)));
  return set;
}

TEST(NearRoundingLaw, WidthsThatGrowthCannotTellFromZeroGiveTheExactHull) {
  for (const PointSet& set :
       {integers(2000, 5, 7, 5), integers(200, 7, 3, 7), family_points(PointFamily::kLattice, 0, 6, 1)}) {
    const Hull exact = hull_of(set);
    for (const double share : {1e-16, 1e-14, 1e-13, 3e-13, 1e-12, 2e-12, 4e-12}) {
      HullOptions width, outside;
      width.accuracy.width = {share * extent_of(set), false};
      outside.accuracy.outside_width = width.accuracy.width;
      for (const HullOptions& options : {width, outside}) {
        SCOPED_TRACE(std::to_string(set.dimension) + "-d, " + std::to_string(share * 1e12) + "e-12");
        const Hull hull = hull_of(set, options);
        EXPECT_EQ(hull.facet_count(), exact.facet_count());
        EXPECT_LT(hull.max_facet_width, 1e-12 * extent_of(set));
        EXPECT_EQ(hull.chosen.width_asked, width.accuracy.width.value);
      }
    }
    for (const double share : {1e-11, 1e-10, 1e-9}) {  // growth tells these
      HullOptions options;
      options.accuracy.width = {share * extent_of(set), false};
      const Hull hull = hull_of(set, options);
      EXPECT_LE(hull.max_facet_width, share * extent_of(set));
      EXPECT_LE(hull.facet_count(), exact.facet_count());
      expect_approximate_laws(hull, set.view());
    }
  }
}

TEST(NearRoundingLaw, ANumberThatTheExactHullKeepsGivesIt) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const PointSet lattice = family_points(PointFamily::kLattice, 0, 6, 1);
    const PointSet some = integers(2000, 5, 7, 5);
    for (const PointSet* set : {&lattice, &some}) {
      const Hull exact = hull_of(*set);
      for (const std::uint64_t more : {0u, 1u, 10u, 2000u}) {
        HullOptions options{.seed = seed};
        options.accuracy.facets = exact.facet_count() + more;
        const Hull hull = hull_of(*set, options);
        EXPECT_EQ(hull.facet_count(), exact.facet_count()) << more;
        EXPECT_LT(hull.max_facet_width, 1e-12 * extent_of(*set)) << more;
      }
    }
  }
}

/// With five corners: regular, or without symmetry.
PointSet polygon(bool is_regular) {
  PointSet set;
  set.dimension = 2;
  for (const int turn : {0, 1, 3, 2, 1}) {
    const double corner = static_cast<double>(set.rows()) + (is_regular ? 0.0 : 0.1 * turn);
    const double angle = 2.0 * std::numbers::pi * corner / 5.0;
    set.coordinates.insert(set.coordinates.end(),
                           {std::cos(angle), (is_regular ? 1.0 : 1.3) * std::sin(angle)});
  }
  return set;
}

// Each facet of a product of polytopes has the vertices of all of one factor: slabs need not find these.
TEST(NearRoundingLaw, ProductsOfPolytopesHaveNoMoreFacetsThanTheExactHullAndNoWiderOnes) {
  const PointSet simplex = family_points(PointFamily::kGaussian, 5, 4, 3);
  const PointSet interval{1, {0.0, 1.0, 2.0}, ""}, box = product({1, {0.0, 1.7}, ""}, interval);
  const PointSet triangle{2, {0.0, 0.0, 1.0, 0.0, 0.0, 1.0}, ""};
  const PointSet polygons = product(product(polygon(false), box), product(polygon(true), triangle));
  for (const PointSet& set : {product(simplex, simplex), polygons}) {
    const Hull exact = hull_of(set);
    for (const std::uint64_t seed : {1u, 3u}) {
      SCOPED_TRACE(std::to_string(set.dimension) + "-d, seed " + std::to_string(seed));
      for (const std::uint64_t more : {0u, 6u}) {
        HullOptions options{.seed = seed};
        options.accuracy.facets = exact.facet_count() + more;
        const Hull hull = hull_of(set, options);
        EXPECT_LT(hull.max_facet_width, 1e-11) << more;
        EXPECT_LE(hull.facet_count(), options.accuracy.facets);
        EXPECT_EQ(hull.points_outside, 0U);
      }
      for (const double percent : {1.0, 10.0, 12.0, 40.0}) {
        HullOptions options{.seed = seed};
        options.accuracy.width = {percent, true};
        const Hull hull = hull_of(set, options);
        EXPECT_LE(hull.facet_count(), exact.facet_count()) << percent;
        EXPECT_LE(hull.max_facet_width, 0.01 * percent * extent_of(set)) << percent;
      }
    }
  }
}

TEST(NearRoundingLaw, ASegmentsWidthIsComparedWithTheOneAskedFor) {
  const PointSet segment{2, {0.0, 0.0, 1.0, 2.0, 0.25, 0.5}, ""};
  HullOptions options;
  options.accuracy.width = {5.0, true};
  EXPECT_EQ(hull_of(segment, options).chosen.width_asked, 0.05 * 2.0);
}

// Clusters of integers far apart: the slabs of a width near what rounding leaves are wider than the hull's own
// facets.
TEST(NearRoundingLaw, AMissedWidthIsNoWiderThanTheExactHulls) {
  std::mt19937_64 random(4);
  PointSet set;
  set.dimension = 5;
  for (int i = 0; i < 200; ++i)
    for (std::size_t k = 0; k < 5; ++k)
      set.coordinates.push_back(1e8 * static_cast<double>((i % 4 + 1) * static_cast<int>(k + 1) % 5) +
                                static_cast<double>(random() % 100) / 100.0);
  const Hull exact = hull_of(set);
  for (const double width : {1e-3, 0.3, 1.0, 10.0}) {
    HullOptions options;
    options.accuracy.width = {width, false};
    EXPECT_LE(hull_of(set, options).max_facet_width, std::max(width, exact.max_facet_width)) << width;
  }
}

}  // namespace
}  // namespace ndhull
