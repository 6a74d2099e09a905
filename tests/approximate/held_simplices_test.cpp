// Simplices that are too wide below their own planes get planes that hold them: seen from all points.
#include "approx/slabs/held_simplices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "approx/geometry/length_unit.h"
#include "approx/slabs/slab_partition.h"
#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"
#include "tests/prepared_growth.h"

namespace ndhull {
namespace {

/// A hull that leaves out points.
struct CoarseHull {
  CoarseHull(const PointSet& set, double outside_width) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    factor = gradient_factor(frame, LengthUnit());
    work.options.gradient_factor = factor;
    work.options.outside_width = outside_width;
    start_growth(work, frame.simplex, FirstPoints());
    EXPECT_EQ(grow(work), GrowthStop::kNoOutsidePoints);
    std::set<PointId> vertices;
    for (std::uint32_t row = 0; row < work.complex.row_count; ++row)
      if (work.complex.state[row] == SimplexState::kLive)
        for (const PointId id : work.complex.vertices(SimplexId{row})) vertices.insert(id);
    std::vector<PointId> others;
    for (std::uint32_t id = 0; id < work.point_count; ++id)
      if (!vertices.contains(PointId{id})) others.push_back(PointId{id});
    space.emplace(frame.rank, factor, coordinates.data(), work.point_count,
                  std::vector<PointId>(vertices.begin(), vertices.end()), others);
  }

  /// Nothing: so few slabs would do that they are not disjoint.
  std::optional<DualFacets> partition(double width) const {
    PartitionTask task;
    return partition_into_slabs(work.complex, *space, coordinates.data(), factor,
                                PointsAbove{.are_left_out = true}, width, {}, task);
  }
  double product(std::span<const double> plane, PointId point) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < plane.size(); ++k)
      sum += plane[k] * coordinates[std::size_t{point.value} * plane.size() + k];
    return sum;
  }

  std::vector<double> coordinates, factor;
  GrowthWork work;
  std::optional<WidthSpace> space;
};

/// Below the facet's plane, which no point may be above.
double width_below(const CoarseHull& hull, const DualFacets& facets, std::size_t facet) {
  const std::span<const double> plane = facets.plane(facet);
  double length_sq = 0.0, top = -HUGE_VAL, low = HUGE_VAL;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    double entry = 0.0;
    for (std::size_t k = 0; k < plane.size(); ++k) entry += hull.factor[i * plane.size() + k] * plane[k];
    length_sq += entry * entry;
  }
  for (std::uint32_t id = 0; id < hull.work.point_count; ++id)
    top = std::max(top, hull.product(plane, PointId{id}));
  for (const SimplexId member : facets.members_of(facet))
    for (const PointId id : hull.work.complex.vertices(member)) low = std::min(low, hull.product(plane, id));
  EXPECT_LE(top, facets.tops[facet] * (1.0 + 1e-12));
  EXPECT_NEAR(facets.lengths[facet], std::sqrt(length_sq), 1e-6 * facets.lengths[facet]);
  return (top - low) / std::sqrt(length_sq);
}

TEST(HeldSimplices, GetPlanesThatHoldThemOrStayUnfit) {
  std::size_t unfit = 0, held = 0;
  for (const FamilySize& shape : {FamilySize{PointFamily::kLens, 700, 4},
                                  {PointFamily::kLens, 800, 5},
                                  {PointFamily::kEllipsoid, 300, 5},
                                  {PointFamily::kLens, 250, 6}}) {
    for (const double width : {0.02, 0.05, 0.1}) {
      const CoarseHull hull(family_points(shape.family, shape.n, shape.d, 5), 0.25 * width);
      const std::optional<DualFacets> partition = hull.partition(width);
      if (!partition) continue;
      const DualFacets& before = *partition;
      DualFacets facets = *hull.partition(width);
      hold_unfit(*hull.space, hull.coordinates.data(), width, facets);
      const std::set<std::uint32_t> once(before.unfit.begin(), before.unfit.end());
      const std::set<std::uint32_t> still(facets.unfit.begin(), facets.unfit.end());
      EXPECT_TRUE(std::ranges::includes(once, still));
      EXPECT_EQ(facets.members, before.members);
      unfit += once.size();
      held += once.size() - still.size();
      for (std::size_t facet = 0; facet < facets.count(); ++facet) {
        const std::uint32_t seed = facets.seeds[facet];
        if (once.contains(seed)) {
          EXPECT_EQ(facets.size(facet), 1u);
        }
        if (!still.contains(seed)) {
          EXPECT_LE(width_below(hull, facets, facet), width * (1.0 + 1e-12));
        }
        if (!once.contains(seed) || still.contains(seed)) {
          EXPECT_TRUE(std::ranges::equal(facets.plane(facet), before.plane(facet)));
        }
      }
    }
  }
  EXPECT_GT(unfit, 100u);
  EXPECT_GT(held, unfit / 2);
}

}  // namespace
}  // namespace ndhull
