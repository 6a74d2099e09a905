// Slabs of a few simplices, seen from all points and vertices by plain loops.
#include "approx/slabs/thin_slabs.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "approx/facets/exact_facets.h"
#include "approx/geometry/boundedness.h"
#include "approx/slabs/slab_partition.h"
#include "tests/approximate/facet_members.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

/// A sphere's simplices with their determinants, and calls that have the frame's coordinates for distances.
struct ThinSlabs {
  explicit ThinSlabs(const char* words)
      : sphere(words, static_cast<std::uint32_t>(std::atoi(words))),
        rank(sphere.work.rank),
        factor(rank * rank, 0.0),
        determinants(sphere.work.complex.row_count) {
    for (std::size_t k = 0; k < rank; ++k) factor[k * rank + k] = 1.0;
    solve_outwards(sphere.work.complex, sphere.coordinates.data(), {}, determinants);
  }
  /// `coordinates`: of all points of the space. `marked_points`: so many the marks have room for.
  DualFacets find(double width, const WidthSpace& space, PointsAbove above,
                  const std::vector<double>& coordinates, std::size_t marked_points) const {
    DualFacets open;
    open.complex = &sphere.work.complex;
    open.marks = SimplexMarks(sphere.work.complex.row_count, marked_points);
    open.members.resize(sphere.work.complex.row_count + rank);
    for (std::uint32_t row = 0; row < sphere.work.complex.row_count; ++row) {
      std::uint32_t mix = 0;
      for (const PointId id : sphere.work.complex.vertices(SimplexId{row})) mix ^= id.value;
      open.marks.put(row, mix, !sphere.is_live(row));
    }
    return partition_into_thin_slabs(
        space, coordinates.data(), factor, above, width, grown,
        [this](const BlockWork&) { return std::span<const double>(determinants); }, std::move(open));
  }
  DualFacets find(double width, std::size_t marked_points = 1000) const {
    return find(width, *sphere.space, PointsAbove(), sphere.coordinates, marked_points);
  }

  GrownSphere sphere;
  GrownStars grown = GrownStars::kOfHalf;
  std::size_t rank;
  std::vector<double> factor, determinants;
};

/// How thick the facets are below the highest of these points.
std::vector<double> widths_of(const GrownSphere& sphere, const DualFacets& facets,
                              const std::vector<double>& others) {
  const std::size_t rank = sphere.work.rank;
  std::vector<double> widths;
  const std::vector<std::vector<std::uint32_t>> members = members_of(sphere, facets);
  for (std::uint32_t facet = 0; facet < facets.count(); ++facet) {
    std::vector<double> normal(facets.plane(facet).begin(), facets.plane(facet).end());
    double length_sq = 0.0, lowest = HUGE_VAL;
    for (const double entry : normal) length_sq += entry * entry;
    for (double& entry : normal) entry /= std::sqrt(length_sq);
    double highest = sphere.height(normal);
    for (std::size_t i = 0; i < others.size(); i += rank) {
      double product = 0.0;
      for (std::size_t k = 0; k < rank; ++k) product += normal[k] * others[i + k];
      highest = std::max(highest, product);
    }
    for (const std::uint32_t row : members[facet])
      for (const PointId id : sphere.work.complex.vertices(SimplexId{row}))
        lowest = std::min(lowest, sphere.product(normal, id.value));
    widths.push_back(highest - lowest);
  }
  return widths;
}

TEST(ThinSlabsLaw, EachSimplexIsInOneConnectedSlab) {
  for (const char* words : {"60 s D2 t1", "200 s D3 t2", "400 s D5 t1", "120 s D7 t3", "60 s D9 t4"}) {
    const ThinSlabs slabs(words);
    std::size_t last = SIZE_MAX;
    for (const double width : {1e-6, 0.003, 0.01, 0.05, 0.3}) {
      SCOPED_TRACE(std::string(words) + ", width " + std::to_string(width));
      const DualFacets facets = slabs.find(width);
      EXPECT_EQ(facets.unfit.size(), 0U);
      for (const double found : widths_of(slabs.sphere, facets, {})) EXPECT_LE(found, width * (1.0 + 1e-9));
      EXPECT_LE(facets.count(), last);
      last = facets.count();
    }
  }
}

TEST(ThinSlabsLaw, MoreStarsGrownOnLeaveFewerFacets) {
  for (const char* words : {"400 s D6 t1", "200 s D8 t3"}) {
    ThinSlabs slabs(words);
    for (const double width : {0.01, 0.02, 0.04}) {
      SCOPED_TRACE(std::string(words) + ", width " + std::to_string(width));
      slabs.grown = GrownStars::kOfHalf;
      const std::size_t of_half = slabs.find(width).count();
      slabs.grown = GrownStars::kFromTwo;
      const DualFacets facets = slabs.find(width);
      EXPECT_EQ(facets.unfit.size(), 0U);
      for (const double found : widths_of(slabs.sphere, facets, {})) EXPECT_LE(found, width * (1.0 + 1e-9));
      EXPECT_LT(facets.count(), of_half);
    }
  }
}

/// The radius is 0.5: planes are nearer to the centre where simplices are large.
TEST(ThinSlabsLaw, AreTheSameForAnyNumberOfThreads) {
  const ThinSlabs slabs("100 s D6 t5");
  for (const double width : {0.005, 0.02}) {
    std::vector<DualFacets> found;
    for (const int threads : {1, 2}) {
      tbb::task_arena arena(threads);
      arena.execute([&] { found.push_back(slabs.find(width)); });
    }
    for (const DualFacets& facets : found) {
      EXPECT_EQ(facets.facet_of_rows(), found.front().facet_of_rows());
      EXPECT_EQ(facets.own_plane, found.front().own_plane);
      EXPECT_EQ(facets.own_planes, found.front().own_planes);
    }
    EXPECT_GT(found.front().own_planes.size(), 0u);  // pairs
  }
}

TEST(ThinSlabsLaw, PlanesFarFromTheCentreBoundARegion) {
  const ThinSlabs slabs("120 s D7 t3");
  double nearest = HUGE_VAL;
  for (std::uint32_t row = 0; row < slabs.sphere.work.complex.row_count; ++row) {
    if (!slabs.sphere.is_live(row)) continue;
    double length_sq = 0.0;
    for (const double entry : slabs.sphere.work.complex.plane(SimplexId{row})) length_sq += entry * entry;
    nearest = std::min(nearest, 1.0 / std::sqrt(length_sq));
  }
  for (const double part : {0.05, 0.3, 0.7, 0.99}) {
    const DualFacets facets = slabs.find(part * nearest);
    EXPECT_TRUE(facets.are_far_from_centre);
    std::vector<double> normals;
    for (std::uint32_t facet = 0; facet < facets.count(); ++facet)
      normals.insert(normals.end(), facets.plane(facet).begin(), facets.plane(facet).end());
    EXPECT_TRUE(find_open_direction(normals, slabs.sphere.work.rank).bounded);
  }
  EXPECT_FALSE(slabs.find(1.01 * nearest).are_far_from_centre);
}

TEST(ThinSlabsLaw, AreTheSameWithMarksForManyPoints) {
  const ThinSlabs slabs("120 s D7 t3");
  const DualFacets few = slabs.find(0.02), many = slabs.find(0.02, 40'000);
  EXPECT_EQ(few.seeds, many.seeds);
  EXPECT_EQ(few.facet_of_rows(), many.facet_of_rows());
}

/// More points than simplices: no table of them in single precision is made.
TEST(ThinSlabsLaw, AreTheSameWithManyPointsInside) {
  const ThinSlabs slabs("60 s D3 t2");
  const std::size_t vertices = slabs.sphere.work.point_count;
  std::vector<double> coordinates(3 * slabs.sphere.work.complex.row_count);
  std::copy_n(slabs.sphere.coordinates.begin(), 3 * vertices, coordinates.begin());
  std::vector<PointId> ids;
  for (std::uint32_t id = 0; id < vertices; ++id) ids.push_back(PointId{id});
  const std::size_t points = slabs.sphere.work.complex.row_count + 1;
  coordinates.resize(3 * points);
  const WidthSpace space(3, slabs.factor, coordinates.data(), points, ids, {});
  const DualFacets many = slabs.find(0.02, space, PointsAbove(), coordinates, points);
  EXPECT_EQ(slabs.find(0.02).seeds, many.seeds);
}

TEST(ThinSlabsLaw, SlabsOfOneSimplexHaveNoNeighbourToPairWith) {
  const ThinSlabs slabs("120 s D7 t3");
  const double width = 0.02;
  const DualFacets facets = slabs.find(width);
  const std::vector<std::vector<std::uint32_t>> members = members_of(slabs.sphere, facets);
  const std::vector<std::uint32_t> facet_of = facets.facet_of_rows();
  const SimplicialComplex& complex = slabs.sphere.work.complex;
  std::size_t alone = 0, pairs = 0;
  for (const auto& rows : members) {
    if (rows.size() == 2) ++pairs;
    if (rows.size() != 1) continue;
    ++alone;
    for (const SimplexId other : complex.neighbours(SimplexId{rows[0]})) {
      if (members[facet_of[other.value]].size() != 1) continue;
      // All planes through their ridge, a hundredth of the way apart.
      const auto a = complex.plane(SimplexId{rows[0]}), b = complex.plane(other);
      double narrowest = HUGE_VAL;
      for (int step = 0; step <= 100; ++step) {
        std::vector<double> normal(slabs.rank);
        double length_sq = 0.0, lowest = HUGE_VAL;
        for (std::size_t k = 0; k < slabs.rank; ++k) {
          normal[k] = (1.0 - 0.01 * step) * a[k] + 0.01 * step * b[k];
          length_sq += normal[k] * normal[k];
        }
        for (const SimplexId simplex : {SimplexId{rows[0]}, other})
          for (const PointId id : complex.vertices(simplex))
            lowest = std::min(lowest, slabs.sphere.product(normal, id.value));
        narrowest = std::min(narrowest, (1.0 - lowest) / std::sqrt(length_sq));
      }
      EXPECT_GT(narrowest, 0.98 * width);
    }
  }
  EXPECT_GT(alone, 10u);
  EXPECT_GT(pairs, 10u);
}

TEST(ThinSlabsLaw, PointsLeftOutAreBelowThePlanesToo) {
  const ThinSlabs slabs("300 s D5 t4");
  const GrownSphere& sphere = slabs.sphere;
  const std::size_t count = sphere.work.point_count;
  // Every tenth point again, somewhat further out.
  std::vector<double> coordinates(
      sphere.coordinates.begin(),
      sphere.coordinates.begin() + static_cast<std::ptrdiff_t>(count * slabs.rank));
  std::vector<PointId> vertices, others;
  for (std::uint32_t id = 0; id < count; ++id) vertices.push_back(PointId{id});
  for (std::size_t id = 0; id < count; id += 10) {
    others.push_back(PointId{static_cast<std::uint32_t>(coordinates.size() / slabs.rank)});
    for (std::size_t k = 0; k < slabs.rank; ++k)
      coordinates.push_back(1.004 * coordinates[id * slabs.rank + k]);
  }
  const std::vector<double> outside(coordinates.begin() + static_cast<std::ptrdiff_t>(count * slabs.rank),
                                    coordinates.end());
  const WidthSpace space(slabs.rank, slabs.factor, coordinates.data(), coordinates.size() / slabs.rank,
                         vertices, others);
  const double width = 0.02;
  const auto find = [&](double below) {
    return slabs.find(below, space, PointsAbove{.are_left_out = true}, coordinates,
                      coordinates.size() / slabs.rank);
  };
  const DualFacets known = slabs.find(width), facets = find(width);
  EXPECT_EQ(facets.unfit.size(), 0U);
  for (const double found : widths_of(sphere, facets, outside)) EXPECT_LE(found, width * (1.0 + 1e-9));
  EXPECT_GT(facets.count(), known.count());
  EXPECT_GT(find(0.001).unfit.size(), 0U);
}

TEST(ThinSlabsExample, NeighboursOnACirclePairBelowALineBetweenTheirs) {
  // Own lines alone: a neighbour's far end is deeper than the width. Between the two it is half as deep.
  const ThinSlabs slabs("60 s D2 t5");
  const double width = 0.75 * (1.0 - std::cos(2.0 * 3.14159265358979 / 60.0));
  const DualFacets facets = slabs.find(width);
  EXPECT_LT(facets.count(), 50u);
  EXPECT_FALSE(facets.own_planes.empty());
}

TEST(ThinSlabsExample, ThePartitionAsksForThemWhereSlabsHoldFew) {
  const ThinSlabs slabs("120 s D7 t3");
  int asked = 0;
  const FindDeterminants find = [&](const BlockWork& also) {
    ++asked;
    also(0, slabs.sphere.work.complex.row_count);
    return std::span<const double>(slabs.determinants);
  };
  const auto partition = [&](double width) {
    PartitionTask task;
    return partition_into_slabs(slabs.sphere.work.complex, *slabs.sphere.space,
                                slabs.sphere.coordinates.data(), slabs.factor, PointsAbove(), width, find,
                                task);
  };
  const std::optional<DualFacets> thin = partition(0.01);
  ASSERT_TRUE(thin);
  EXPECT_EQ(asked, 1);
  // Walks ask once too, with any number of threads.
  for (const int threads : {1, 2}) {
    asked = 0;
    tbb::task_arena arena(threads);
    arena.execute([&] { EXPECT_TRUE(partition(0.2)->may_join()); });
    EXPECT_EQ(asked, 1) << threads;
    asked = 0;
    arena.execute([&] { EXPECT_EQ(partition(0.01)->count(), thin->count()); });
    EXPECT_EQ(asked, 1) << threads;
  }
  EXPECT_FALSE(thin->may_join());
  EXPECT_EQ(thin->count(), slabs.find(0.01).count());
  const std::optional<DualFacets> wide = partition(0.2);
  EXPECT_TRUE(!wide || wide->may_join());
}

}  // namespace
}  // namespace ndhull
