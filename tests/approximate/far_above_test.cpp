// Points that are further above some simplex than a facet may be wide, beside all points and simplices.
#include "approx/trade/far_above.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
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

TEST(FarAbove, AreThosePointsThatAreAboveSomeSimplex) {
  std::size_t far_points = 0, others = 0;
  for (const FamilySize& shape : {FamilySize{PointFamily::kSphere, 120, 3},
                                  {PointFamily::kGaussian, 60, 4},
                                  {PointFamily::kEllipsoid, 60, 5},
                                  {PointFamily::kBall, 50, 6}}) {
    PausedHull hull(family_points(shape.family, shape.n, shape.d, 11), 20 * shape.d);
    hull.look_at_all();
    std::vector<double> sorted = hull.heights;
    std::sort(sorted.begin(), sorted.end());
    for (const double part : {0.5, 0.8, 0.95}) {
      const double width =
          sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size()))] * (1.0 - 1e-12);
      std::vector<LocatedPoint> found =
          find_far_above(hull.work, hull.coordinates.data(), *hull.space, hull.left_out, width);
      std::ranges::sort(found, {}, &LocatedPoint::point);
      std::vector<PointId> wanted, points;
      for (std::size_t i = 0; i < hull.left_out.size(); ++i)
        if (hull.heights[i] > width) wanted.push_back(hull.left_out[i].point);
      for (const LocatedPoint& far : found) {
        points.push_back(far.point);
        EXPECT_EQ(far.gauge, hull.gauge(far.point, far.simplex));
        EXPECT_GT(height_above(hull.work, far.simplex.value, far.gauge), width);
      }
      EXPECT_EQ(points, wanted);
      far_points += wanted.size();
      others += hull.left_out.size() - wanted.size();
    }
  }
  EXPECT_GT(far_points, 20U);
  EXPECT_GT(others, 20U);
}

}  // namespace
}  // namespace ndhull
