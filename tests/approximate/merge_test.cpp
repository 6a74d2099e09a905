// Merging under W, C and A: inputs on which Qhull's own merging ends without an answer, and the cap.
#include <cmath>

#include "approx/verify/verify.h"
#include "tests/hull/hull_support.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

Hull merged(const char* rbox_words, double outside, double centrum, double cap = 0.0) {
  HullOptions options;
  options.accuracy.outside_width = {outside, false};
  options.accuracy.centrum_radius = {centrum, false};
  options.accuracy.width_cap = {cap, false};
  return hull_of(rbox(rbox_words), options);
}

// Qhull ends with QH6227 and no output for these with C-1e-2.
TEST(MergeLaw, InputsThatQhullGivesUpAreAnswered) {
  for (const char* words : {"300 s D6 t1", "100 s D7 t1", "60 s D8 t1", "500 L20 s D5 t1"}) {
    SCOPED_TRACE(words);
    const Hull hull = merged(words, 0.0, 0.01);
    EXPECT_GT(hull.facet_count(), hull.rank);
    EXPECT_EQ(hull.points_outside, 0U);
    EXPECT_LE(hull.max_facet_width, default_width_cap(0.0, 0.01, 1.0));
    EXPECT_LE(largest_outer_excess(hull, rbox(words).view()), 0.0L);
  }
}

TEST(MergeLaw, LargerRadiusGivesFewerFacets) {
  std::size_t last = 1'000'000;
  for (const double radius : {0.001, 0.004, 0.016, 0.06}) {
    const Hull hull = merged("200 s D5 t1", 0.0, radius);
    EXPECT_LT(hull.facet_count(), last);
    last = hull.facet_count();
  }
}

TEST(MergeLaw, CapHoldsAndRefusedMergesAreCounted) {
  const Hull free = merged("200 s D5 t1", 0.0, 0.02);
  const Hull capped = merged("200 s D5 t1", 0.0, 0.02, 0.04);
  EXPECT_LE(capped.max_facet_width, 0.04);
  EXPECT_GT(free.max_facet_width, 0.04);
  EXPECT_GT(capped.chosen.refused_merges, 0U);
  EXPECT_GT(capped.facet_count(), free.facet_count());
}

// A radius many times the hull's least extent: all of it fits into one slab, which bounds nothing.
TEST(MergeLaw, ThinHullsStayHulls) {
  for (const char* words :
       {"7 D6 t26", "6 D5 t3", "9 D6 t5", "12 D8 t2", "40 W1e-9 D4 t1", "30 Z1e-6 D5 s t1"}) {
    SCOPED_TRACE(words);
    const PointSet set = rbox(words);
    HullOptions options;
    options.accuracy.outside_width = {30.0, true};
    options.accuracy.centrum_radius = {20.0, true};
    const Hull hull = hull_of(set, options);
    EXPECT_GT(hull.facet_count(), hull.rank);
    const Verification verification = verify_hull(set.view(), hull, VerifyMode::kFloating);
    EXPECT_TRUE(verification.passed()) << verification.first_failure();
  }
}

// Boxes so thin that planes of their sides are rounding: no slab leaves a hull, and the search for one ends.
TEST(MergeLaw, BoxesThinAsRoundingEnd) {
  for (const auto& [d, thickness] : {std::pair{3, 1e-11}, {4, 1e-13}, {5, 1e-12}, {6, 1e-14}}) {
    SCOPED_TRACE(std::to_string(d) + "-d, " + std::to_string(std::log10(thickness)));
    PointSet box = rbox("c D" + std::to_string(d));
    const auto dimension = static_cast<std::size_t>(d);
    for (std::size_t i = dimension - 1; i < box.coordinates.size(); i += dimension)
      box.coordinates[i] *= thickness;
    for (const bool merges : {false, true}) {
      HullOptions options;
      if (merges) options.accuracy.max_cosine = 0.9;
      if (merges) options.accuracy.outside_width = {5.0, true};
      if (!merges) options.accuracy.width = {20.0, true};
      const Hull hull = hull_of(box, options);
      EXPECT_GT(hull.facet_count(), hull.rank);
      const Verification verification = verify_hull(box.view(), hull, VerifyMode::kFloating);
      EXPECT_TRUE(verification.passed()) << verification.first_failure();
    }
  }
}

TEST(MergeLaw, TinyRadiusMergesHardlyAnything) {
  const PointSet set = rbox("500 s D5 t1");
  EXPECT_GE(merged("500 s D5 t1", 0.0, 1e-9).facet_count(), hull_of(set).facet_count() * 99 / 100);
}

TEST(MergeLaw, CosineMergesNeighboursThatAgree) {
  const PointSet set = rbox("200 s D4 t1");
  HullOptions options;
  std::size_t last = 1'000'000;
  for (const double cosine : {0.999, 0.99, 0.95}) {
    options.accuracy.max_cosine = cosine;
    const Hull hull = hull_of(set, options);
    EXPECT_LT(hull.facet_count(), last);
    EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
    last = hull.facet_count();
  }
}

// What merging leaves as it was is a simplex, and is printed as one.
TEST(MergeLaw, FacetsOfOneSimplexAreSimplicial) {
  HullOptions cosine, radius, for_volume;
  cosine.accuracy.max_cosine = 0.999;
  radius.accuracy.centrum_radius.value = 0.002;
  for_volume.accuracy.facets = 300;
  for_volume.accuracy.objective = FacetObjective::kVolume;
  const PointSet set = rbox("200 D5 t1");
  for (const HullOptions& options : {cosine, radius, for_volume}) {
    const Hull hull = hull_of(set, options);
    std::size_t lone = 0;
    for (std::uint32_t id = 0; id < hull.facet_count(); ++id)
      lone += hull.simplex_count_of(FacetId{id}) == 1 ? 1U : 0U;
    EXPECT_GT(lone, 0U);
    EXPECT_LT(lone, hull.facet_count());
    EXPECT_GE(hull.simplicial_facet_count(), lone * 9 / 10);  // a plane may be turned to a point left out
    EXPECT_LE(hull.simplicial_facet_count(), lone);
    EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
    const Verification verification = verify_hull(set.view(), hull, VerifyMode::kFloating);
    EXPECT_TRUE(verification.passed()) << verification.first_failure();
  }
  cosine.accuracy.max_cosine = 1.0;
  const Hull whole = hull_of(set, cosine);
  EXPECT_EQ(whole.simplicial_facet_count(), whole.simplex_count());
}

// A facet may hold more simplices that face away from it than others: slabs thicker than the lens, or planes
// hardly more than a simplex has.
TEST(AreaLaw, NoFacetHasLessThanNone) {
  HullOptions wide, few, for_volume;
  wide.accuracy.width = {10.0, true};
  few.accuracy.facets = 5;
  for_volume.accuracy.facets = 6;
  for_volume.accuracy.objective = FacetObjective::kVolume;
  const PointSet lens = family_points(PointFamily::kLens, 40, 4, 2);
  for (const HullOptions& options : {wide, few, for_volume}) {
    const Hull hull = hull_of(lens, options);
    double sum = 0.0;
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
      EXPECT_GE(hull.area_of(FacetId{row}), 0.0) << row << " of " << hull.facet_count();
      sum += hull.area_of(FacetId{row});
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_LE(sum, hull.area * (1.0 + 1e-9));
  }
}

}  // namespace
}  // namespace ndhull
