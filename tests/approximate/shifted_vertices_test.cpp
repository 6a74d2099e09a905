// Vertices of approximate hulls of points that share planes: none lies in the hull of the others.
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "approx/rays/extreme_points.h"
#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

/// Whole numbers from 0 to `steps`.
PointSet grid_points(std::size_t count, std::size_t d, std::uint64_t seed, double steps) {
  PointSet set = family_points(PointFamily::kCube, count, d, seed);
  for (double& x : set.coordinates) x = std::round((x + 1.0) / 2.0 * steps);
  return set;
}

TEST(ShiftedVerticesLaw, NoVertexIsInTheHullOfTheOthers) {
  std::vector<Accuracy> tried(6);
  tried[0].width = {5.0, true};
  tried[1].width = {20.0, true};
  tried[2].centrum_radius = {2.0, true};
  tried[3].max_cosine = 0.95;
  tried[4].facets = 12;
  tried[5].outside_width = {3.0, true};
  std::size_t shifted = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const std::size_t d = 2 + seed % 3;
    const PointSet set = grid_points(20 + 3 * seed, d, seed, static_cast<double>(3 + seed % 4));
    for (const Accuracy& accuracy : tried) {
      const Hull hull = hull_of(set, {.accuracy = accuracy});
      SCOPED_TRACE(std::to_string(seed));
      std::vector<double> rows;
      for (const PointId id : hull.vertices) {
        const std::span<const double> row = set.row(id.value);
        rows.insert(rows.end(), row.begin(), row.end());
      }
      const ExtremePoints extreme =
          extreme_points(PointView::row_major(rows.data(), hull.vertices.size(), d));
      EXPECT_EQ(extreme.vertices.size(), hull.vertices.size());
      // Those left out do not make the hull smaller.
      EXPECT_EQ(hull.points_outside, 0U);
      expect_approximate_laws(hull, set.view());
      shifted += hull.statistics.shifted_points;
    }
  }
  EXPECT_GT(shifted, 100U);
}

}  // namespace
}  // namespace ndhull
