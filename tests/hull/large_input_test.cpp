// Inputs and hulls that are large enough for the loops that threads share, and for points to be dropped
// early.
#include <vector>

#include "core/complex/complex_check.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

/// Every number of the result, bit for bit.
struct Bits {
  std::vector<double> numbers;
  std::vector<std::uint32_t> ids;
  bool operator==(const Bits&) const = default;
};

Bits bits_of(const Hull& hull) {
  Bits bits;
  for (std::uint32_t facet = 0; facet < hull.facet_count(); ++facet) {
    const FacetId id{facet};
    const auto normal = hull.normal(id);
    bits.numbers.insert(bits.numbers.end(), normal.begin(), normal.end());
    for (const double number :
         {hull.offset(id), hull.outer_offset(id), hull.inner_offset(id), hull.area_of(id)})
      bits.numbers.push_back(number);
    for (const PointId vertex : hull.vertices_of(id)) bits.ids.push_back(vertex.value);
    for (const FacetId neighbour : hull.neighbours_of(id)) bits.ids.push_back(neighbour.value);
  }
  for (const double number : {hull.area, hull.volume, hull.max_facet_width, hull.max_outside_gauge})
    bits.numbers.push_back(number);
  for (const PointId vertex : hull.vertices) bits.ids.push_back(vertex.value);
  return bits;
}

void expect_same_for_threads(const PointSet& set, HullOptions options) {
  options.threads = 1;
  const Hull alone = hull_of(set, options);
  const Bits expected = bits_of(alone);
  for (const unsigned threads : {2U, 4U}) {
    options.threads = threads;
    EXPECT_TRUE(bits_of(hull_of(set, options)) == expected) << threads << " threads";
  }
}

TEST(ThreadsLaw, InsertionsOfThousandsOfSimplicesAreTheSameForAnyNumberOfThreads) {
  // The visible set, the cone, matching and commit are shared from 256 and 1024 elements on.
  expect_same_for_threads(family_points(PointFamily::kSphere, 150, 8, 81), {});
  expect_same_for_threads(family_points(PointFamily::kSphere, 60, 10, 82), {});
  expect_same_for_threads(family_points(PointFamily::kGaussian, 3000, 7, 83), {});
}

TEST(ThreadsLaw, DegenerateInsertionsAreTheSameForAnyNumberOfThreads) {
  expect_same_for_threads(family_points(PointFamily::kCubeCorners, 256, 8, 84), {});
  expect_same_for_threads(family_points(PointFamily::kCubeCorners, 256, 8, 84), {.triangulate = true});
}

TEST(ThreadsLaw, LargeInputsAreTheSameForAnyNumberOfThreads) {
  const PointSet set = family_points(PointFamily::kGaussian, 150'000, 5, 85);
  expect_same_for_threads(set, {});
  expect_same_for_threads(set, {.accuracy = {.width = {.value = 5.0, .is_percent = true}}});
}

TEST(ThreadsLaw, AFacetLimitIsTheSameForAnyNumberOfThreads) {
  expect_same_for_threads(family_points(PointFamily::kSphere, 2000, 8, 86),
                          {.limits = {.max_facets = 60'000}});
}

TEST(LargeInputLaw, PointsAreDroppedAndTheHullIsThatOfTheOthers) {
  for (std::size_t d = 2; d <= 5; ++d) {
    SCOPED_TRACE("gaussian, n 120000, d " + std::to_string(d) + ", seed 87");
    const PointSet set = family_points(PointFamily::kGaussian, 120'000, d, 87);
    const Hull hull = hull_of(set);
    EXPECT_GT(hull.statistics.dropped_points, 60'000U);
    EXPECT_EQ(hull.point_count, set.rows());
    // Few points: nothing is dropped.
    const PointSet vertices = vertex_rows(set, hull);
    const Hull small = hull_of(vertices);
    EXPECT_EQ(small.statistics.dropped_points, 0U);
    std::vector<std::size_t> new_of_old(hull.vertices.size());
    for (std::size_t i = 0; i < hull.vertices.size(); ++i) new_of_old[i] = hull.vertices[i].value;
    EXPECT_EQ(facet_sets(hull), renamed(facet_sets(small), new_of_old));
    EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
    EXPECT_LE(largest_inner_excess(hull, set.view()), 0.0L);
  }
}

TEST(LargeInputLaw, DegenerateInputsLoseNoVertex) {
  // A lattice: all that is inside goes, whatever lies on a face of the cube stays or is proven inside.
  const PointSet lattice =
      generate_points({.family = PointFamily::kLattice, .dimension = 3, .count = 0, .side = 48});
  const Hull cube = hull_of(lattice);
  EXPECT_EQ(cube.facet_count(), 6U);
  EXPECT_EQ(cube.vertices.size(), 8U);
  expect_sound(cube, lattice);
  // Flat points are not looked at early.
  const PointSet flat = embedded(family_points(PointFamily::kGaussian, 110'000, 3, 89), 5, 90);
  const Hull hull = hull_of(flat);
  EXPECT_EQ(hull.rank, 3U);
  EXPECT_EQ(hull.statistics.dropped_points, 0U);
}

TEST(LargeInputLaw, ApproximateHullsBoundTheDroppedPoints) {
  const PointSet set = family_points(PointFamily::kGaussian, 150'000, 5, 91);
  for (const double percent : {2.0, 10.0}) {
    const HullOptions options{.accuracy = {.width = {.value = percent, .is_percent = true}}};
    const Hull hull = hull_of(set, options);
    EXPECT_GT(hull.statistics.dropped_points, 100'000U);
    EXPECT_LE(hull.max_facet_width, 0.01 * percent * extent_of(set));
    EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
  }
}

}  // namespace
}  // namespace ndhull
