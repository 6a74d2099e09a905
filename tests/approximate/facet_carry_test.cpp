// Facets of a hull that has grown since: what is still there stays, the rest lies as high as it can.
#include "approx/trade/facet_carry.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "approx/slabs/slab_cover.h"
#include "tests/approximate/approximate_laws.h"
#include "tests/approximate/grown_sphere.h"
#include "tests/hull/hull_support.h"
#include "tests/prepared_growth.h"

namespace ndhull {
namespace {

constexpr double kWidth = 0.25;  // so deep that simplices look at all facets around

using Vertices = std::vector<std::uint32_t>;  // of a simplex, ascending

/// A hull that grows step by step.
struct SteppedHull : FramedGrowth {
  explicit SteppedHull(const PointSet& set) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    identity.assign(frame.rank * frame.rank, 0.0);
    for (std::size_t k = 0; k < frame.rank; ++k) identity[k * frame.rank + k] = 1.0;
    work.options.gradient_factor = identity;
    start_growth(work, frame.simplex, FirstPoints());
  }

  void grow_to(std::uint64_t rows) {
    work.options.pause_rows = rows;
    EXPECT_EQ(grow(work), GrowthStop::kPaused);
    std::vector<PointId> vertices, others;
    for (std::uint32_t id = 0; id < work.point_count; ++id)
      (is_vertex(id) ? vertices : others).push_back(PointId{id});
    space.emplace(work.rank, identity, coordinates.data(), work.point_count, vertices, others);
  }
  bool is_vertex(std::uint32_t point) const {
    for (std::uint32_t row = 0; row < work.complex.row_count; ++row)
      if (is_live(row) && std::ranges::count(vertices_of(row), point) > 0) return true;
    return false;
  }
  Vertices vertices_of(std::uint32_t row) const {
    Vertices ids;
    for (const PointId id : work.complex.vertices(SimplexId{row})) ids.push_back(id.value);
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  double low(const std::vector<double>& normal, const Vertices& vertices) const {
    double lowest = HUGE_VAL;
    for (const std::uint32_t id : vertices) lowest = std::min(lowest, product(normal, id));
    return lowest;
  }

  std::vector<double> identity;
};

/// The normals of the facets that may take new simplices: those that have lost some, or stand beside them.
std::set<std::vector<double>> hosts_of(const SteppedHull& hull,
                                       const std::map<Vertices, std::vector<double>>& normal_of) {
  std::set<Vertices> now;
  for (std::uint32_t row = 0; row < hull.work.complex.row_count; ++row)
    if (hull.is_live(row)) now.insert(hull.vertices_of(row));
  std::set<std::vector<double>> hosts;
  for (const auto& [vertices, normal] : normal_of)
    if (!now.contains(vertices)) hosts.insert(normal);
  for (std::uint32_t row = 0; row < hull.work.complex.row_count; ++row) {
    if (!hull.is_live(row) || normal_of.contains(hull.vertices_of(row))) continue;
    for (const SimplexId beside : hull.work.complex.neighbours(SimplexId{row}))
      if (const auto found = normal_of.find(hull.vertices_of(beside.value)); found != normal_of.end())
        hosts.insert(found->second);
  }
  return hosts;
}

TEST(FacetCarryLaw, SimplicesStayInTheirFacetsAndNewOnesLieNoHigherInANeighboursFacet) {
  for (const FamilySize& shape : {FamilySize{PointFamily::kSphere, 300, 3},
                                  {PointFamily::kGaussian, 200, 4},
                                  {PointFamily::kEllipsoid, 150, 5}}) {
    SCOPED_TRACE(shape.d);
    SteppedHull hull(family_points(shape.family, shape.n, shape.d, 7));
    const SimplicialComplex& complex = hull.work.complex;
    hull.grow_to(100);
    SlabCover cover(complex, *hull.space, false);
    const Covering covering = cover.cover(0.3, CoverEffort{.final_fit_steps = 0});
    std::map<Vertices, std::vector<double>> normal_of;
    for (std::uint32_t row = 0; row < complex.row_count; ++row)
      if (hull.is_live(row))
        normal_of[hull.vertices_of(row)] = covering.planes[covering.facet_of[row]].normal;
    const SimplexNames before(complex);
    hull.grow_to(140);
    const Covering carried = carry_facets(complex, *hull.space, before, covering, kWidth);
    const std::set<std::vector<double>> hosts = hosts_of(hull, normal_of);
    ASSERT_FALSE(hosts.empty());
    std::vector<double> lows(carried.planes.size(), HUGE_VAL);
    std::size_t kept = 0, fresh = 0;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      const std::uint32_t facet = carried.facet_of[row];
      ASSERT_EQ(facet != kNone, hull.is_live(row));
      if (facet == kNone) continue;
      const Vertices vertices = hull.vertices_of(row);
      const std::vector<double>& normal = carried.planes[facet].normal;
      lows[facet] = std::min(lows[facet], hull.low(normal, vertices));
      if (const auto found = normal_of.find(vertices); found != normal_of.end()) {
        EXPECT_EQ(normal, found->second);
        ++kept;
        continue;
      }
      ++fresh;
      EXPECT_TRUE(hosts.contains(normal));
      const double depth = hull.height(normal) - hull.low(normal, vertices);
      double least = HUGE_VAL;
      for (const std::vector<double>& host : hosts)
        least = std::min(least, hull.height(host) - hull.low(host, vertices));
      EXPECT_LE(depth, std::max(least, kWidth) + 1e-6);  // in single precision
      for (const SimplexId beside : complex.neighbours(SimplexId{row})) {
        const std::vector<double>& other = carried.planes[carried.facet_of[beside.value]].normal;
        EXPECT_LE(depth, hull.height(other) - hull.low(other, vertices) + 1e-6);
      }
    }
    EXPECT_GT(kept, 5U);
    EXPECT_GT(fresh, 50U);
    double widest = 0.0;
    for (std::size_t facet = 0; facet < lows.size(); ++facet) {
      EXPECT_NEAR(carried.planes[facet].low, lows[facet], 1e-12);
      EXPECT_NEAR(carried.planes[facet].height, hull.height(carried.planes[facet].normal), 1e-12);
      widest = std::max(widest, carried.planes[facet].width());
    }
    EXPECT_EQ(carried.widest, widest);
    tbb::task_arena alone(1);
    alone.execute([&] {
      const Covering again = carry_facets(complex, *hull.space, before, covering, kWidth);
      EXPECT_EQ(again.facet_of, carried.facet_of);
    });
  }
}

TEST(FacetCarryLaw, AHullThatHasNotGrownKeepsItsFacets) {
  SteppedHull hull(family_points(PointFamily::kBall, 200, 4, 3));
  hull.grow_to(100);
  SlabCover cover(hull.work.complex, *hull.space, false);
  const Covering covering = cover.cover(0.2, CoverEffort{.final_fit_steps = 0});
  const SimplexNames before(hull.work.complex);
  const Covering carried = carry_facets(hull.work.complex, *hull.space, before, covering, kWidth);
  EXPECT_EQ(carried.facet_of, covering.facet_of);
}

}  // namespace
}  // namespace ndhull
