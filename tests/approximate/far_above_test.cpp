// Points that are further above some simplex than a facet may be wide, beside slabs of all simplices.
#include "approx/trade/far_above.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"
#include "tests/prepared_growth.h"

namespace ndhull {
namespace {

/// A hull of some points, in a frame whose coordinates are taken for distances.
struct PausedHull {
  PausedHull(const PointSet& set, std::uint64_t rows) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    const std::size_t rank = frame.rank;
    std::vector<double> identity(rank * rank, 0.0);
    for (std::size_t k = 0; k < rank; ++k) identity[k * rank + k] = 1.0;
    work.options.gradient_factor = identity;
    work.options.pause_rows = rows;
    start_growth(work, frame.simplex, FirstPoints());
    EXPECT_EQ(grow(work), GrowthStop::kPaused);
    std::vector<PointId> others;
    for (std::uint32_t id = 0; id < work.point_count; ++id) others.push_back(PointId{id});
    space.emplace(rank, identity, coordinates.data(), work.point_count, std::vector<PointId>{}, others);
  }

  double gauge(PointId point, SimplexId simplex) const {
    double sum = -1.0;
    for (std::size_t k = 0; k < work.rank; ++k)
      sum += work.complex.plane(simplex)[k] * coordinates[point.value * work.rank + k];
    return sum;
  }

  /// Of each point outside the last simplex that it is above, and the furthest that it is above any.
  void look_at_all() {
    for (std::uint32_t id = 0; id < work.point_count; ++id) {
      double height = 0.0;
      LocatedPoint located{PointId{id}, SimplexId{}, 1e-9};
      for (std::uint32_t row = 0; row < work.complex.row_count; ++row) {
        if (work.complex.state[row] != SimplexState::kLive) continue;
        const double here = gauge(PointId{id}, SimplexId{row});
        if (here <= 1e-9) continue;
        located = {PointId{id}, SimplexId{row}, here};
        height = std::max(height, height_above(work, row, here));
      }
      if (!located.simplex.valid()) continue;
      left_out.push_back(located);
      heights.push_back(height);
    }
  }

  std::vector<double> coordinates;
  GrowthWork work;
  std::optional<WidthSpace> space;
  std::vector<LocatedPoint> left_out;
  std::vector<double> heights;  // of left_out, above any simplex
};

/// Which simplices points are too far above, and no slab of a simplex beside them holds: looked for among
/// all.
class AllSlabs {
 public:
  AllSlabs(const PausedHull& hull, double width)
      : hull_(hull), width_(width), highest_(hull.work.complex.row_count) {
    std::vector<PointId> far;
    for (std::size_t i = 0; i < hull.left_out.size(); ++i)
      if (hull.heights[i] > width) far.push_back(hull.left_out[i].point);
    for (std::uint32_t row = 0; row < highest_.size(); ++row) {
      highest_[row] = {PointId{}, SimplexId{row}, 0.0};
      for (const PointId point : far) {
        const double gauge = hull.gauge(point, SimplexId{row});
        if (gauge > highest_[row].gauge) highest_[row] = {point, SimplexId{row}, gauge};
      }
    }
    for (std::uint32_t row = 0; row < highest_.size(); ++row)
      if (is_live(row) && !is_open(row)) grow_from(row);
  }

  const LocatedPoint& highest(std::uint32_t row) const { return highest_[row]; }
  bool is_live(std::uint32_t row) const { return hull_.work.complex.state[row] == SimplexState::kLive; }
  bool is_open(std::uint32_t row) const {
    return height_above(hull_.work, row, highest_[row].gauge) > width_;
  }
  bool is_held(std::uint32_t row) const { return held_.contains(row); }

 private:
  void grow_from(std::uint32_t seed) {
    const double least = highest_[seed].gauge - width_ / height_above(hull_.work, seed, 1.0);
    std::set<std::uint32_t> slab{seed};
    for (std::vector<std::uint32_t> next{seed}; !next.empty();) {
      const std::uint32_t row = next.back();
      next.pop_back();
      for (const SimplexId beside : hull_.work.complex.neighbours(SimplexId{row})) {
        if (!is_open(beside.value) || slab.contains(beside.value)) continue;
        bool is_in = true;
        for (const PointId vertex : hull_.work.complex.vertices(beside))
          is_in = is_in && hull_.gauge(vertex, SimplexId{seed}) >= least;
        if (!is_in) continue;
        slab.insert(beside.value);
        next.push_back(beside.value);
      }
    }
    slab.erase(seed);
    held_.merge(slab);
  }

  const PausedHull& hull_;
  double width_;
  std::vector<LocatedPoint> highest_;  // of each row, of the points that are too far above any
  std::set<std::uint32_t> held_;
};

TEST(FarAbove, AreTheHighestPointsAboveSimplicesThatNoSlabHolds) {
  std::size_t held = 0, wanted_in_all = 0;
  for (const FamilySize& shape : {FamilySize{PointFamily::kSphere, 200, 3},
                                  {PointFamily::kGaussian, 120, 4},
                                  {PointFamily::kEllipsoid, 150, 5},
                                  {PointFamily::kBall, 100, 6}}) {
    PausedHull hull(family_points(shape.family, shape.n, shape.d, 11), 40 * shape.d);
    hull.look_at_all();
    std::vector<double> sorted = hull.heights;
    std::sort(sorted.begin(), sorted.end());
    for (const double part : {0.5, 0.8, 0.95}) {
      const double width =
          sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size()))] * (1.0 - 1e-12);
      const AllSlabs slabs(hull, width);
      std::set<PointId> wanted, points;
      for (std::uint32_t row = 0; row < hull.work.complex.row_count; ++row) {
        if (!slabs.is_live(row) || !slabs.is_open(row)) continue;
        if (slabs.is_held(row)) {
          ++held;
        } else {
          wanted.insert(slabs.highest(row).point);
        }
      }
      for (const LocatedPoint& far :
           find_far_above(hull.work, hull.coordinates.data(), *hull.space, hull.left_out, width)) {
        EXPECT_TRUE(points.insert(far.point).second);
        EXPECT_EQ(far.point, slabs.highest(far.simplex.value).point);
        EXPECT_EQ(far.gauge, hull.gauge(far.point, far.simplex));
        EXPECT_GT(height_above(hull.work, far.simplex.value, far.gauge), width);
        EXPECT_FALSE(slabs.is_held(far.simplex.value));
      }
      EXPECT_EQ(points, wanted);
      wanted_in_all += wanted.size();
    }
  }
  EXPECT_GT(held, 5U);
  EXPECT_GT(wanted_in_all, 20U);
}

}  // namespace
}  // namespace ndhull
