// A target number of facets for the volume: planes of the exact hull, every one certified, little below them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "approx/polytope/outer_volume.h"
#include "approx/verify/verify.h"
#include "core/error.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

HullOptions for_volume(std::uint64_t facets) {
  return {.accuracy = {.facets = facets, .objective = FacetObjective::kVolume}};
}

double excess(const Hull& hull) {
  const OuterVolume outer = outer_volume(hull, {}, {}, 1);
  EXPECT_TRUE(outer.volume) << outer.reason;
  return outer.volume.value_or(0.0) / hull.volume - 1.0;
}

/// How far the normal of a facet is from those of all facets of the exact hull, at most.
double furthest_normal(const Hull& hull, const Hull& exact) {
  double furthest = 0.0;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    double nearest = HUGE_VAL;
    for (std::uint32_t other = 0; other < exact.facet_count(); ++other) {
      double sum = 0.0;
      for (std::size_t k = 0; k < hull.dimension; ++k)
        sum += std::abs(hull.normal(FacetId{row})[k] - exact.normal(FacetId{other})[k]);
      nearest = std::min(nearest, sum);
    }
    furthest = std::max(furthest, nearest);
  }
  return furthest;
}

void expect_certified(const Hull& hull, const PointSet& points) {
  EXPECT_LE(largest_outer_excess(hull, points.view()), 0.0L);
  EXPECT_LE(largest_inner_excess(hull, points.view()), 0.0L);
  EXPECT_EQ(hull.points_outside, 0U);
  const Verification verification = verify_hull(points.view(), hull, VerifyMode::kFloating);
  EXPECT_TRUE(verification.passed()) << verification.first_failure();
}

// Qhull's C0.01 and W0.1 C0.01: 4.2, 27, 3.6 and 13 %.
TEST(VolumeObjective, LeavesLittleAboveTheHull) {
  struct Wanted {
    const char* rbox;
    std::uint64_t count;
    double excess;
  };
  for (const Wanted& wanted : {Wanted{"200 s D5 t1", 555, 0.032}, Wanted{"200 s D5 t1", 425, 0.045},
                               Wanted{"400 D5 t1", 503, 0.028}, Wanted{"400 D5 t1", 375, 0.042}}) {
    SCOPED_TRACE(std::string(wanted.rbox) + ", facets " + std::to_string(wanted.count));
    const PointSet points = rbox(wanted.rbox);
    const Hull hull = hull_of(points, for_volume(wanted.count));
    EXPECT_EQ(hull.facet_count(), wanted.count);
    EXPECT_TRUE(hull.is_approximate);
    expect_certified(hull, points);
    // The volume of the hull itself is that of its simplices, whatever their facets are.
    const Hull exact = hull_of(points);
    EXPECT_NEAR(hull.volume, exact.volume, 1e-12 * hull.volume);
    EXPECT_LE(excess(hull), wanted.excess);
    EXPECT_LE(furthest_normal(hull, exact), 1e-9);
  }
}

TEST(VolumeObjective, IsTheExactHullWhenThatHasNoMoreFacets) {
  for (const char* command : {"c D5", "30 D3 t1"}) {
    const PointSet points = rbox(command);
    const Hull exact = hull_of(points), hull = hull_of(points, for_volume(exact.facet_count()));
    EXPECT_FALSE(hull.is_approximate);
    EXPECT_EQ(facet_sets(hull), facet_sets(exact));
  }
}

// By other planes where so few of the exact hull's bound no region.
TEST(VolumeObjectiveLaw, HardInputIsEnclosedByNoMoreFacetsThanAskedFor) {
  std::size_t by_volume = 0, by_width = 0;
  for (std::size_t d = 2; d <= 4; ++d) {
    for (const DegenerateCase& hard : degenerate_cases(40, d, 5)) {
      const Hull exact = hull_of(hard.points);
      for (const std::size_t more : {1U, 4U}) {
        SCOPED_TRACE(hard.description + ", d " + std::to_string(d) + ", " +
                     std::to_string(exact.rank + more));
        const Hull hull = hull_of(hard.points, for_volume(exact.rank + more));
        expect_certified(hull, hard.points);
        EXPECT_LE(hull.facet_count(), std::min(exact.facet_count(), exact.rank + more));
        ++(hull.chosen.objective == FacetObjective::kVolume ? by_volume : by_width);
      }
    }
  }
  EXPECT_GT(by_volume, 2 * by_width);
  EXPECT_GT(by_width, 0U);
}

TEST(VolumeObjectiveLaw, TheResultDoesNotDependOnThreads) {
  const PointSet points = family_points(PointFamily::kGaussian, 500, 5, 2);
  HullOptions one = for_volume(80), two = for_volume(80);
  one.threads = 1;
  two.threads = 2;
  const Hull a = hull_of(points, one), b = hull_of(points, two);
  EXPECT_EQ(facet_sets(a), facet_sets(b));
  EXPECT_EQ(a.max_facet_width, b.max_facet_width);
}

}  // namespace
}  // namespace ndhull
