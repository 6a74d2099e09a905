// Growth of the whole hull goes on from the one that points were dropped with.
#include <gtest/gtest.h>

#include "approx/hull_builder.h"
#include "approx/reduction/point_reduction.h"
#include "approx/reduction/reduced_points.h"
#include "core/complex/complex_check.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

PointsToKeep keep(const PointSet& set) {
  return find_points_to_keep(PointShards::whole(set.view()), 1, [] { return false; });
}

Hull hull_of_kept(const PointSet& set, const PointsToKeep& kept, BegunHull* begun) {
  const ReducedPoints points(PointShards::whole(set.view()), kept.rows);
  const PointView view = points.view();
  Hull hull = build_hull(view, HullOptions(), Clock::now(), 1e6, begun);
  expect_sound(hull, view);
  return hull;
}

TEST(BegunHullLaw, GrowthThatGoesOnFromItEndsWithTheSameHull) {
  PointSet turned = family_points(PointFamily::kGaussian, 120'000, 5, 301);
  for (std::size_t row = 0; row < turned.rows(); ++row)
    turned.row(row)[1] = 300.0 * turned.row(row)[0] + 0.1 * turned.row(row)[1] + 1e4;
  const PointSet sets[] = {family_points(PointFamily::kGaussian, 150'000, 5, 302),
                           family_points(PointFamily::kBall, 110'000, 4, 303),
                           family_points(PointFamily::kClusters, 120'000, 5, 304),
                           family_points(PointFamily::kGaussian, 200'000, 2, 305), std::move(turned)};
  for (const PointSet& set : sets) {
    SCOPED_TRACE(set.header);
    PointsToKeep kept = keep(set);
    ASSERT_TRUE(kept.begun.has_value());
    EXPECT_TRUE(check_complex(kept.begun->grown.complex).sound());
    ASSERT_TRUE(kept.begun->rename_points(kept.rows));
    const std::uint64_t begun_with = kept.begun->grown.counters.insertions;
    EXPECT_GT(begun_with, 0U);
    const Hull whole = hull_of_kept(set, kept, nullptr), gone_on = hull_of_kept(set, kept, &*kept.begun);
    EXPECT_GE(gone_on.statistics.insertions, begun_with);
    EXPECT_EQ(facet_sets(gone_on), facet_sets(whole));
    EXPECT_EQ(gone_on.vertices, whole.vertices);
    EXPECT_NEAR(gone_on.volume, whole.volume, 1e-11 * whole.volume);
  }
}

// Points on common planes, and frames that points outside the sample would spoil: growth starts afresh.
TEST(BegunHullLaw, OnlyGeneralAndWellShapedHullsAreGoneOnFrom) {
  const PointSet lattice =
      generate_points({.family = PointFamily::kLattice, .dimension = 3, .count = 0, .side = 48});
  EXPECT_FALSE(keep(lattice).begun.has_value());
  PointSet far = family_points(PointFamily::kGaussian, 120'000, 4, 306);
  for (double& x : far.row(77'777)) x *= 1e7;
  const PointsToKeep kept = keep(far);
  EXPECT_LT(kept.rows.size(), far.rows());
  EXPECT_FALSE(kept.begun.has_value());
  EXPECT_LE(largest_outer_excess(hull_of(far), far.view()), 0.0L);
}

TEST(BegunHullLaw, AVertexThatIsNotKeptIsNoticed) {
  const PointSet set = family_points(PointFamily::kGaussian, 120'000, 3, 307);
  PointsToKeep kept = keep(set);
  ASSERT_TRUE(kept.begun.has_value());
  std::uint32_t live = 0;
  const SimplicialComplex& complex = kept.begun->grown.complex;
  while (complex.state[live] != SimplexState::kLive) ++live;
  const std::uint32_t vertex = kept.begun->rows[complex.vertices(SimplexId{live})[1].value];
  std::erase(kept.rows, vertex);
  EXPECT_FALSE(kept.begun->rename_points(kept.rows));
}

// A limit on facets ends with the furthest of all points, not with what a sample has.
TEST(BegunHullLaw, ALimitOnFacetsIsKept) {
  const PointSet set = family_points(PointFamily::kGaussian, 150'000, 5, 308);
  const Hull hull = hull_of(set, {.limits = {.max_facets = 200}});
  EXPECT_EQ(hull.status, HullStatus::kFacetLimit);
  EXPECT_LE(hull.facet_count(), 200U);
  EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
}

}  // namespace
}  // namespace ndhull
