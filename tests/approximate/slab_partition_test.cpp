// Disjoint slabs, and what joins along segments between planes, seen from all points by plain loops.
#include "approx/slabs/slab_partition.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "approx/slabs/segment_merge.h"
#include "tests/approximate/facet_members.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

/// Calls that have the frame's coordinates for distances.
struct Slabs {
  explicit Slabs(const GrownSphere& grown) : sphere(grown), factor(grown.work.rank * grown.work.rank, 0.0) {
    for (std::size_t k = 0; k < grown.work.rank; ++k) factor[k * grown.work.rank + k] = 1.0;
  }
  std::optional<DualFacets> partition(double width, PointsAbove above = {}) const {
    return partition_in(*sphere.space, width, above);
  }
  std::optional<DualFacets> partition_in(const WidthSpace& space, double width, PointsAbove above) const {
    PartitionTask task;
    return partition_into_slabs(sphere.work.complex, space, sphere.coordinates.data(), factor, above, width,
                                {}, task);
  }
  void join(double width, std::size_t most, DualFacets& facets) const {
    join_along_segments(sphere.work.complex, sphere.coordinates.data(), factor, sphere.work.point_count,
                        width, most, facets);
  }
  const GrownSphere& sphere;
  std::vector<double> factor;
};

double product(const GrownSphere& sphere, std::span<const double> plane, std::uint32_t point) {
  return sphere.product(std::vector<double>(plane.begin(), plane.end()), point);
}

void expect_lists(const GrownSphere& sphere, const DualFacets& facets) {
  const std::vector<std::vector<std::uint32_t>> members = members_of(sphere, facets);
  for (std::uint32_t facet = 0; facet < facets.count(); ++facet) {
    EXPECT_EQ(facets.members_of(facet)[0].value, facets.seeds[facet]);
    std::vector<std::uint32_t> listed;
    for (const SimplexId member : facets.members_of(facet)) listed.push_back(member.value);
    std::sort(listed.begin(), listed.end());
    EXPECT_EQ(listed, members[facet]);
  }
}

/// No point above the plane's top, no vertex of the facet a width or more below it.
void expect_slabs(const GrownSphere& sphere, const DualFacets& facets, double width) {
  const std::vector<std::vector<std::uint32_t>> members = members_of(sphere, facets);
  for (std::uint32_t facet = 0; facet < facets.count(); ++facet) {
    const std::span<const double> plane = facets.plane(facet);
    double length_sq = 0.0, lowest = HUGE_VAL;
    for (const double entry : plane) length_sq += entry * entry;
    EXPECT_NEAR(double{facets.lengths[facet]}, std::sqrt(length_sq), 1e-6 * std::sqrt(length_sq));
    for (std::uint32_t id = 0; id < sphere.work.point_count; ++id)
      EXPECT_LE(product(sphere, plane, id), facets.tops[facet] + 1e-12);
    for (const std::uint32_t row : members[facet])
      for (const PointId id : sphere.work.complex.vertices(SimplexId{row}))
        lowest = std::min(lowest, product(sphere, plane, id.value));
    EXPECT_LE((facets.tops[facet] - lowest) / std::sqrt(length_sq), width * (1.0 + 1e-9));
  }
}

/// As if growth had left out the second half of the points.
WidthSpace space_with_left_out(const GrownSphere& sphere, const Slabs& slabs) {
  const auto count = static_cast<std::uint32_t>(sphere.work.point_count);
  std::vector<PointId> vertices, left_out;
  for (std::uint32_t id = 0; id < count; ++id) (2 * id < count ? vertices : left_out).push_back(PointId{id});
  return {sphere.work.rank, slabs.factor, sphere.coordinates.data(), count, vertices, left_out};
}

TEST(SlabPartitionLaw, EachSimplexIsInOneConnectedSlab) {
  for (const char* words : {"400 s D5 t1", "300 s D4 t2", "120 s D7 t3"}) {
    const GrownSphere sphere(words, static_cast<std::uint32_t>(std::atoi(words)));
    const Slabs slabs(sphere);
    std::size_t last = SIZE_MAX;
    for (const double width : {0.01, 0.05, 0.1}) {
      const std::optional<DualFacets> facets = slabs.partition(width);
      ASSERT_TRUE(facets);
      EXPECT_EQ(facets->unfit.size(), 0U);
      EXPECT_TRUE(facets->are_far_from_centre);
      expect_lists(sphere, *facets);
      expect_slabs(sphere, *facets, width);
      EXPECT_LT(facets->count(), last);
      last = facets->count();
    }
  }
}

TEST(SlabPartitionLaw, OverlappingSlabsAreLookedForWhereFewHoldAllAndGrowthWasShort) {
  const GrownSphere sphere("400 s D5 t1", 400);
  const Slabs slabs(sphere);
  const WidthSpace space = space_with_left_out(sphere, slabs);
  EXPECT_TRUE(slabs.partition(0.6));
  EXPECT_FALSE(slabs.partition_in(space, 0.6, PointsAbove{.are_left_out = true}));
  EXPECT_TRUE(slabs.partition_in(space, 0.01, PointsAbove{.are_left_out = true}));
  // Not of data whose planes rounding has drawn.
  EXPECT_TRUE(slabs.partition_in(space, 0.6, PointsAbove{.vertices = 1e-12}));
}

TEST(SlabPartitionLaw, TurnedSlabsAreSlabsAndFewer) {
  for (const char* words : {"400 s D5 t1", "200 s D6 t2"}) {
    const GrownSphere sphere(words, static_cast<std::uint32_t>(std::atoi(words)));
    const Slabs slabs(sphere);
    const WidthSpace space = space_with_left_out(sphere, slabs);
    for (const double width : {0.2, 0.25}) {
      const std::optional<DualFacets> plain = slabs.partition(width),
                                      turned =
                                          slabs.partition_in(space, width, PointsAbove{.are_left_out = true});
      ASSERT_TRUE(plain && turned);
      expect_lists(sphere, *turned);
      expect_slabs(sphere, *turned, width);
      EXPECT_TRUE(plain->own_planes.empty());
      EXPECT_FALSE(turned->own_planes.empty());
      EXPECT_LT(turned->count(), plain->count()) << words << ", width " << width;
    }
  }
}

TEST(SlabPartitionLaw, ShiftedVerticesRaisePlanesAndNoMore) {
  const GrownSphere sphere("300 s D5 t4", 300);
  const Slabs slabs(sphere);
  const std::optional<DualFacets> known = slabs.partition(0.05),
                                  asked = slabs.partition(0.05, PointsAbove{.vertices = 1e-12});
  ASSERT_TRUE(known && asked);
  EXPECT_EQ(known->begin, asked->begin);
  EXPECT_TRUE(
      std::equal(known->members.data(), known->members.data() + known->begin.back(), asked->members.data()));
  for (const double top : asked->tops) EXPECT_EQ(top, 1.0 + 1e-12);
}

// Of points on the faces of a cube, many of which share planes.
TEST(SlabPartitionLaw, NoVertexIsFourShiftsAboveASimplex) {
  for (const char* words : {"300 W0 D4 t1", "200 W0 D6 t2"}) {
    const PointSet set = rbox(words);
    std::vector<double> coordinates;
    GrowthWork work;
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    start_growth(work, frame.simplex, FirstPoints());
    grow(work);
    EXPECT_GE(work.shifted_points.size(), 20u) << words;
    const std::vector<bool> is_vertex = find_corners(work);
    double highest = 0.0;
    for (std::uint32_t row = 0; row < work.complex.row_count; ++row) {
      if (work.complex.state[row] != SimplexState::kLive) continue;
      for (std::uint32_t id = 0; id < work.point_count; ++id) {
        if (!is_vertex[id]) continue;
        const double* point = coordinates.data() + std::size_t{id} * work.rank;
        const auto plane = work.complex.plane(SimplexId{row});
        highest = std::max(highest, std::inner_product(plane.begin(), plane.end(), point, -1.0));
      }
    }
    EXPECT_GT(highest, work.options.shift) << words;
    EXPECT_LT(highest, 4.0 * work.options.shift) << words;
  }
}

TEST(SegmentMergeLaw, JoinedFacetsAreSlabsToo) {
  for (const char* words : {"400 s D5 t1", "300 s D4 t2", "120 s D7 t3"}) {
    const GrownSphere sphere(words, static_cast<std::uint32_t>(std::atoi(words)));
    const Slabs slabs(sphere);
    for (const double width : {0.01, 0.05, 0.1}) {
      const std::size_t disjoint = slabs.partition(width)->count();
      std::size_t last = disjoint;
      for (const std::size_t most : {1u, 3u, 50u}) {
        DualFacets facets = *slabs.partition(width);
        slabs.join(width, most, facets);
        EXPECT_FALSE(facets.may_join());
        expect_slabs(sphere, facets, width);
        EXPECT_LE(facets.count(), last) << words << ", width " << width << ", most " << most;
        EXPECT_LT(facets.count(), disjoint) << words << ", width " << width << ", most " << most;
        last = facets.count();
      }
    }
  }
}

TEST(SegmentMergeLaw, JoinsAreTheSameForAnyNumberOfThreads) {
  const GrownSphere sphere("120 s D7 t3", 120);
  const Slabs slabs(sphere);
  for (const double width : {0.02, 0.05}) {
    std::vector<DualFacets> joined;
    for (const int threads : {1, 2}) {
      tbb::task_arena arena(threads);
      arena.execute([&] {
        joined.push_back(*slabs.partition(width));
        const std::size_t before = joined.back().count();
        ASSERT_GT(before, 2000u);  // so that hosts are foreseen, and others join them meanwhile
        slabs.join(width, 50, joined.back());
        EXPECT_LT(joined.back().count(), before);
      });
    }
    for (const DualFacets& facets : joined) {
      EXPECT_EQ(facets.facet_of_rows(), joined.front().facet_of_rows());
      EXPECT_EQ(facets.own_plane, joined.front().own_plane);
      EXPECT_EQ(facets.own_planes, joined.front().own_planes);
      EXPECT_EQ(facets.tops, joined.front().tops);
    }
  }
}

TEST(SegmentMergeExample, NeighboursOnACircleJoinBelowALineBetweenTheirs) {
  const GrownSphere sphere("60 s D2 t5", 60);
  const Slabs slabs(sphere);
  // Own planes alone: a neighbour's far end is deeper than the width. Between the two planes it is half as
  // deep.
  const double width = 0.75 * (1.0 - std::cos(2.0 * 3.14159265358979 / 60.0));
  DualFacets facets = *slabs.partition(width);
  const std::size_t before = facets.count();
  slabs.join(width, 1, facets);
  EXPECT_LT(facets.count(), before);
  expect_slabs(sphere, facets, width);
}

}  // namespace
}  // namespace ndhull
