// Outer planes chosen for the vertex that is furthest from the hull, and how far it is.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "approx/geometry/hull_distance.h"
#include "approx/polytope/outer_volume.h"
#include "approx/polytope/plane_polytope.h"
#include "approx/selection/facet_selection.h"
#include "approx/selection/outer_distance.h"
#include "core/error.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

double reach(const Hull& hull, const PointSet& points, std::span<const FacetId> facets) {
  const OuterDistance outer = outer_distance(hull, points.view(), facets, {}, 1);
  EXPECT_TRUE(outer.distance) << outer.reason;
  EXPECT_LE(outer.lower, outer.distance.value_or(0.0));
  return outer.distance.value_or(0.0);
}

PointSet hexagon() {
  PointSet points;
  points.dimension = 2;
  for (int k = 0; k < 6; ++k) {
    const double angle = 3.14159265358979323846 / 3.0 * k;
    points.coordinates.push_back(std::cos(angle));
    points.coordinates.push_back(std::sin(angle));
  }
  return points;
}

TEST(OuterDistance, OfATriangleAroundAHexagonIsHalfTheRootOfThree) {
  const PointSet points = hexagon();
  const Hull hull = hull_of(points);
  const std::vector<FacetId> chosen = choose_for_distance(hull, 3);
  ASSERT_EQ(chosen.size(), 3U);
  const OuterDistance outer = outer_distance(hull, points.view(), chosen, {}, 1);
  EXPECT_NEAR(outer.distance.value(), 0.5 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(outer.lower, 0.5 * std::sqrt(3.0), 1e-12);
  EXPECT_LE(reach(hull, points, {}), 1e-12);
}

TEST(OuterDistance, BeyondACornerIsMeasuredToTheCorner) {
  // Without its short sides the corners of a cut square come back: the nearest point is in the middle of a
  // short side, also where the facet's plane is far from the vertex' own.
  PointSet points;
  points.dimension = 2;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      points.coordinates.insert(points.coordinates.end(), {x, 0.75 * y, 0.75 * x, y});
    }
  }
  const Hull hull = hull_of(points);
  ASSERT_EQ(hull.facet_count(), 8U);
  const std::vector<FacetId> chosen = choose_for_distance(hull, 4);
  EXPECT_NEAR(reach(hull, points, chosen), 0.25 * std::sqrt(0.5), 1e-12);
}

TEST(OuterDistance, AnOpenSelectionHasNone) {
  const PointSet points = hexagon();
  const Hull hull = hull_of(points);
  const std::vector<FacetId> two{FacetId{0}, FacetId{1}};
  EXPECT_FALSE(outer_distance(hull, points.view(), two, {}, 1).distance);
}

// Few of very many facets, whose vertices are all looked at, and many of few vertices, whose gauges come
// first: both are the distance of the furthest vertex, looked for one by one.
TEST(OuterDistanceOracle, IsThatOfTheFurthestVertex) {
  std::size_t searched = 0, by_gauges = 0;
  for (const auto& [points, count] : {std::pair{rbox("300 s D5 t1"), std::size_t{9}},
                                      {rbox("300 s D5 t2"), std::size_t{14}},
                                      {rbox("200 s D3 t3"), std::size_t{30}},
                                      {rbox("50 s D4 t4"), std::size_t{12}}}) {
    const Hull hull = hull_of(points);
    ++(hull.facet_count() > 8 * hull.vertices.size() ? searched : by_gauges);
    const std::size_t rank = hull.rank;
    const FacetSelection chosen = select_facets(hull, {.largest = count, .bounded = true});
    const PlanesAboutOrigin planes = outer_planes_about_interior(hull, chosen.facets);
    const PlanePolytope polytope = intersect_about_origin(planes, {});
    ASSERT_TRUE(polytope.bounded);
    Eigen::MatrixXd corners(static_cast<Eigen::Index>(rank), static_cast<Eigen::Index>(hull.vertices.size()));
    for (std::size_t k = 0; k < hull.vertices.size(); ++k) {
      for (std::size_t j = 0; j < rank; ++j)
        corners(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) =
            points.view().at(hull.vertices[k].value, j) - hull.interior_point[j];
    }
    double furthest = 0.0;
    for (std::size_t vertex = 0; vertex < polytope.vertex_count(rank); ++vertex) {
      const Eigen::Map<const Eigen::VectorXd> at(polytope.vertices.data() + vertex * rank,
                                                 static_cast<Eigen::Index>(rank));
      furthest = std::max(furthest, hull_distance(corners, at).upper);
    }
    const double found = reach(hull, points, chosen.facets);
    EXPECT_GE(found, furthest * (1.0 - 1e-12));
    EXPECT_LE(found, furthest * (1.0 + 1e-9));
  }
  EXPECT_GE(searched, 1U);
  EXPECT_GE(by_gauges, 1U);
}

TEST(DistanceSelectionLaw, WithThePointsItReachesNoFurther) {
  for (const char* options : {"100 s D5 t1", "60 D6 t2", "40 s D7 t3"}) {
    SCOPED_TRACE(options);
    const PointSet points = rbox(options);
    const PointView view = points.view();
    const Hull hull = hull_of(points);
    for (const std::size_t count : {10U, 20U}) {
      EXPECT_LE(reach(hull, points, choose_for_distance(hull, count, {}, &view)),
                reach(hull, points, choose_for_distance(hull, count)) * (1.0 + 1e-12));
    }
  }
}

TEST(DistanceSelectionLaw, TwentyPlanesReachNoFurtherThanTheTwentyLargestAndThoseThatCloseThem) {
  std::size_t inputs = 0;
  for (std::size_t d = 4; d <= 7; ++d) {
    const std::size_t count = d < 6 ? 100 : 40;
    for (const PointFamily family : {PointFamily::kSphere, PointFamily::kGaussian, PointFamily::kCube}) {
      const PointSet points = family_points(family, count, d, d);
      const Hull hull = hull_of(points);
      SCOPED_TRACE("input " + std::to_string(inputs++) + ", d " + std::to_string(d));
      const FacetSelection largest = select_facets(hull, {.largest = 20, .bounded = true});
      const FacetSelection chosen =
          select_facets(hull, {.largest = 20, .measure = SelectionMeasure::kDistance});
      EXPECT_EQ(chosen.facets.size(), 20U);
      EXPECT_TRUE(chosen.bounded);
      EXPECT_TRUE(std::is_sorted(chosen.facets.begin(), chosen.facets.end()));
      EXPECT_LE(reach(hull, points, chosen.facets), reach(hull, points, largest.facets));
    }
  }
  EXPECT_GE(inputs, 10U);
}

TEST(DistanceSelectionLaw, MorePlanesReachLessFar) {
  const PointSet points = rbox("200 s D5 t1");
  const Hull hull = hull_of(points);
  double last = HUGE_VAL;
  for (const std::size_t count : {10U, 40U, 160U}) {
    const double now = reach(hull, points, choose_for_distance(hull, count));
    EXPECT_LT(now, 0.8 * last);
    last = now;
  }
}

TEST(DistanceSelection, AllFacetsAndTooFew) {
  const Hull hull = hull_of(rbox("30 D3 t1"));
  EXPECT_EQ(choose_for_distance(hull, 1000).size(), hull.facet_count());
  EXPECT_THROW(choose_for_distance(hull, 3), Error);
}

TEST(DistanceSelectionLaw, HardInputIsEnclosed) {
  for (std::size_t d = 2; d <= 4; ++d) {
    for (const DegenerateCase& hard : degenerate_cases(40, d, 11)) {
      SCOPED_TRACE(hard.description + ", d " + std::to_string(d));
      const Hull hull = hull_of(hard.points);
      if (hull.rank == 0) continue;
      const std::size_t count = std::min(hull.rank + 3, hull.facet_count());
      const FacetSelection chosen =
          select_facets(hull, {.largest = count, .measure = SelectionMeasure::kDistance});
      EXPECT_TRUE(chosen.bounded);
      EXPECT_GE(chosen.facets.size(), count);
    }
  }
}

}  // namespace
}  // namespace ndhull
