// Facets that exchange simplices: none gets lost, none gets wider than the widest was, seen from all points
// by plain loops.
#include "approx/trade/facet_balance.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "approx/slabs/facet_parts.h"
#include "approx/slabs/slab_cover.h"
#include "approx/trade/cluster_merge.h"
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

TEST(FacetBalanceLaw, JoinedFacetsGoOnTurning) {
  const GrownSphere sphere("400 s D5 t1", 400);
  SlabCover cover(sphere.work.complex, *sphere.space, true);
  FacetBalance balance(sphere.work.complex, *sphere.space, true,
                       cover.cover(0.2, CoverEffort{.final_fit_steps = 0}));
  const std::vector<std::uint32_t> start = balance.covering().facet_of;
  for (int turn = 0; turn < 3; ++turn) balance.turn();
  Covering joined = balance.covering();
  const std::size_t facets = joined.planes.size();
  const double widest = widest_of(sphere, joined);
  merge_clusters(
      sphere.work.complex, *sphere.space,
      MergeRule{.max_cosine = -1.0, .width_cap = 0.97 * widest, .least_facets = sphere.work.rank + 1},
      joined);
  const std::size_t fewer = joined.planes.size();
  ASSERT_LT(fewer, facets);
  balance.set_joined(std::move(joined));
  EXPECT_EQ(balance.covering().planes.size(), fewer);
  EXPECT_LE(widest_of(sphere, balance.covering()), widest * (1.0 + 1e-6));
  balance.split_widest(facets - fewer);
  while (balance.turn()) {
  }
  EXPECT_LE(balance.covering().planes.size(), facets);
  EXPECT_LT(widest_of(sphere, balance.covering()), widest);
  for (std::size_t row = 0; row < start.size(); ++row)
    EXPECT_EQ(balance.covering().facet_of[row] == kNone, start[row] == kNone) << row;
}

// Several threads look at pairs before their turn has come, and list parts side by side.
TEST(FacetBalanceLaw, JoinsAndTurnsAreTheSameForAnyNumberOfThreads) {
  const GrownSphere sphere("400 s D5 t1", 400);
  SlabCover cover(sphere.work.complex, *sphere.space, true);
  const Covering start = cover.cover(0.1, CoverEffort{.final_fit_steps = 0});
  for (const double widest : {0.11, 0.2}) {
    const auto joined_by = [&](int threads) {
      FacetBalance balance(sphere.work.complex, *sphere.space, true, start);
      tbb::task_arena arena(threads);
      arena.execute([&] {
        Covering joined = start;
        merge_clusters(
            sphere.work.complex, *sphere.space,
            MergeRule{.max_cosine = -1.0, .width_cap = widest, .least_facets = sphere.work.rank + 1}, joined);
        balance.set_joined(std::move(joined));
        for (int turn = 0; turn < 3; ++turn) balance.turn();
      });
      return balance.covering();
    };
    const Covering alone = joined_by(1);
    EXPECT_LT(alone.planes.size(), start.planes.size());
    for (const int threads : {2, 4}) {
      const Covering together = joined_by(threads);
      EXPECT_TRUE(together.facet_of == alone.facet_of) << threads;
      ASSERT_EQ(together.planes.size(), alone.planes.size()) << threads;
      for (std::size_t facet = 0; facet < alone.planes.size(); ++facet)
        EXPECT_TRUE(together.planes[facet].normal == alone.planes[facet].normal) << facet;
    }
  }
}

// Only these facets are looked at: a part that is cut off of another stays.
TEST(FacetBalanceLaw, PartsOfTheFacetsAskedAboutMove) {
  const GrownSphere sphere("400 s D5 t1", 400);
  SlabCover cover(sphere.work.complex, *sphere.space, true);
  Covering covering = cover.cover(0.4, CoverEffort{.final_fit_steps = 0});
  // A simplex of facet 1 inside facet 0: all its neighbours are of 0.
  const SimplicialComplex& complex = sphere.work.complex;
  std::uint32_t inner = kNone;
  for (std::uint32_t row = 0; row < complex.row_count && inner == kNone; ++row) {
    if (covering.facet_of[row] != 0) continue;
    bool is_inner = true;
    for (const SimplexId other : complex.neighbours(SimplexId{row}))
      is_inner = is_inner && covering.facet_of[other.value] == 0;
    if (is_inner) inner = row;
  }
  ASSERT_NE(inner, kNone);
  covering.facet_of[inner] = 1;
  std::vector<float> depths(complex.row_count, 0.0f);
  PlaneFitWork work;
  std::vector<std::uint8_t> is_asked(covering.planes.size(), 1);
  is_asked[1] = 0;
  gather_strays(complex, *sphere.space, 0.8, covering, depths, work, is_asked);
  EXPECT_EQ(covering.facet_of[inner], 1u);
  is_asked[1] = 1;
  gather_strays(complex, *sphere.space, 0.8, covering, depths, work, is_asked);
  EXPECT_EQ(covering.facet_of[inner], 0u);
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
