// Which hulls may have few exact facets, and hulls that are the same however they are asked for.
#include "approx/facets/exact_facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"
#include "tests/prepared_growth.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

struct GrownSet {
  explicit GrownSet(const PointSet& set) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    start_growth(work, frame.simplex, FirstPoints());
    grow(work);
  }
  std::uint64_t simplices() const { return work.complex.row_count - work.free_count; }
  std::uint64_t exact() const { return count_exact_facets(work, coordinates.data()); }
  bool may_be(std::uint64_t most) const { return may_be_few_facets(work, coordinates.data(), most); }
  bool shares() const { return shares_planes(work, coordinates.data()); }

  std::vector<double> coordinates;
  GrowthWork work;
};

PointSet gridded(const FamilySize& shape, double step) {
  PointSet set = family_points(shape.family, shape.n, shape.d, 5);
  for (double& entry : set.coordinates) entry = std::round(entry / step);
  return set;
}

TEST(ExactFacets, FewAreForeseenWhereSimplicesAreCoplanar) {
  const PointSet cube = family_points(PointFamily::kCubeCorners, 0, 6, 1);
  const PointSet polygon = family_points(PointFamily::kSphere, 12, 2, 3);
  for (const PointSet& set : {cube, rotated(cube, 7), product(product(polygon, polygon), polygon)}) {
    const GrownSet grown(set);
    EXPECT_TRUE(grown.shares());
    EXPECT_TRUE(grown.may_be(grown.exact()));
    EXPECT_LT(10 * grown.exact(), grown.simplices());
  }
}

// As of answers to questions: facets of some dozen simplices are common, and the hull has hundreds of them.
TEST(ExactFacets, ManyAreForeseenOfRatings) {
  const GrownSet grown(gridded({PointFamily::kCube, 3000, 5}, 0.3));
  EXPECT_TRUE(grown.shares());
  EXPECT_LT(3 * grown.exact(), grown.simplices());
  EXPECT_TRUE(grown.may_be(grown.exact()));
  EXPECT_FALSE(grown.may_be(grown.exact() / 3));
}

// Nearly all points of a grid lie on the plane of some simplex when they are added, and are shifted; few
// ridges of the hull are flat for all that.
TEST(ExactFacets, ManyAreForeseenOnAGrid) {
  for (const PointSet& set :
       {gridded({PointFamily::kCube, 1000, 6}, 0.07), gridded({PointFamily::kCube, 500, 7}, 0.2)}) {
    const GrownSet grown(set);
    EXPECT_GE(4 * grown.work.shifted_points.size(), grown.work.counters.insertions);
    EXPECT_LT(grown.exact(), grown.simplices());
    EXPECT_TRUE(grown.may_be(grown.exact()));
    EXPECT_FALSE(grown.may_be(grown.exact() / 2));
  }
}

TEST(ExactFacets, AllSimplicesAreForeseenOfGeneralPoints) {
  const GrownSet grown(family_points(PointFamily::kSphere, 200, 5, 1));
  EXPECT_FALSE(grown.shares());
  EXPECT_TRUE(grown.may_be(grown.simplices()));
  EXPECT_FALSE(grown.may_be(grown.simplices() - 1));
}

// Growth pauses where it does for others, also for who wants simplices.
TEST(WidthLaw, SimplicesAreThoseOfTheSameHull) {
  const PointSet set = family_points(PointFamily::kSphere, 800, 7, 1);
  HullOptions options;
  options.accuracy.width = {12.0, true};
  const Hull hull = hull_of(set, options);
  options.wants_simplices = true;
  const Hull with_simplices = hull_of(set, options);
  EXPECT_GE(hull.simplex_count(), 200'000U);
  EXPECT_EQ(hull.simplex_count(), with_simplices.simplex_count());
  EXPECT_EQ(hull.facet_count(), with_simplices.facet_count());
  EXPECT_EQ(hull.max_facet_width, with_simplices.max_facet_width);
}

}  // namespace
}  // namespace ndhull
