// Facets that exchange simplices: none gets lost, none gets wider than the widest was, seen from all points
// by plain loops.
#include "approx/facet_balance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "approx/slab_cover.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

double widest_of(const GrownSphere& sphere, const Covering& covering) {
  const std::vector<double> widths = facet_widths(sphere, covering);
  return *std::max_element(widths.begin(), widths.end());
}

TEST(FacetBalanceLaw, TurnsKeepEverySimplexAndTheWidestGetsNarrower) {
  const GrownSphere sphere("400 s D5 t1", 400);
  for (const double width : {0.05, 0.2, 0.4, 0.7}) {
    SCOPED_TRACE(width);
    SlabCover cover(sphere.work.complex, *sphere.space, true);
    const Covering start = cover.cover(width, CoverEffort{.final_fit_steps = 0});
    FacetBalance balance(sphere.work.complex, *sphere.space, true, start);
    const double first = widest_of(sphere, start);
    double last = first;
    for (int turn = 0; turn < 12 && balance.turn(); ++turn) {
      EXPECT_LE(balance.covering().planes.size(), start.planes.size());
      const double widest = widest_of(sphere, balance.covering());
      EXPECT_LE(widest, last * (1.0 + 1e-6));  // depths are compared in single precision
      EXPECT_NEAR(widest, balance.covering().widest, 1e-12);
      last = widest;
    }
    EXPECT_LT(last, 0.99 * first);
  }
}

TEST(FacetBalanceLaw, TheWidestAreSplit) {
  const GrownSphere sphere("400 s D5 t1", 400);
  SlabCover cover(sphere.work.complex, *sphere.space, true);
  const Covering start = cover.cover(0.4, CoverEffort{.final_fit_steps = 0});
  FacetBalance balance(sphere.work.complex, *sphere.space, true, start);
  balance.split_widest(7);
  EXPECT_EQ(balance.covering().planes.size(), start.planes.size() + 7);
  EXPECT_LE(widest_of(sphere, balance.covering()), widest_of(sphere, start));
  while (balance.turn()) {
  }
  EXPECT_LT(widest_of(sphere, balance.covering()), widest_of(sphere, start));
}

// Of a circle the best that n facets can do is known: arcs of the same length.
TEST(FacetBalanceLaw, ArcsOfACircleAreNearlyEqual) {
  const PointSet set = rbox("1000 s D2 t1");
  for (const std::uint64_t count : {4u, 6u, 8u}) {
    HullOptions options;
    options.accuracy.facets = count;
    const double best = 0.5 * (1.0 - std::cos(std::numbers::pi / static_cast<double>(count)));
    EXPECT_LT(hull_of(set, options).max_facet_width, 1.15 * best) << count << " facets";
  }
}

}  // namespace
}  // namespace ndhull
