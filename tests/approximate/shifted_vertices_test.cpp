// Vertices of approximate hulls of points that share planes: none lies in the hull of the others.
#include <algorithm>
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

// Growth shifts such points, and of points that share planes leaves few as vertices.
TEST(ShiftedVerticesLaw, EveryFacetHasAsManyVerticesAsThereAreDimensions) {
  std::vector<Accuracy> tried(3);
  tried[0].max_cosine = 0.95;
  tried[1].centrum_radius = Length{0.05};
  tried[2].facets = 20;
  for (std::size_t d = 3; d <= 5; ++d) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      PointSet set = grid_points(30 * (d - 2), d, seed, 4.0);
      const PointSet noise = family_points(PointFamily::kGaussian, set.rows(), d, seed + 100);
      for (std::size_t i = 0; i < set.coordinates.size(); ++i)
        set.coordinates[i] += (seed % 2 == 0 ? 1e-11 : 1e-12) * noise.coordinates[i];
      for (std::size_t i = 0; i < tried.size(); ++i) {
        SCOPED_TRACE(std::to_string(d) + "-d, seed " + std::to_string(seed) + ", " + std::to_string(i));
        const Hull hull = hull_of(set, {.accuracy = tried[i]});
        expect_approximate_laws(hull, set.view());
        for (std::uint32_t row = 0; row < hull.facet_count(); ++row)
          for (const PointId id : hull.vertices_of(FacetId{row}))
            EXPECT_TRUE(std::ranges::binary_search(hull.vertices, id.value, {}, &PointId::value));
      }
    }
  }
}

// Each of the first two is in the hull of the rest only thanks to the other, and a facet has both.
TEST(ShiftedVerticesExample, NearCopiesStayWhereAFacetIsBetweenThem) {
  PointSet set{3,
               {5.999999999934478, 1.1896997265179238e-11, 0.9999999999742214, 5.999999999956388,
                7.465569413517033e-11, 0.9999999999265684},
               ""};
  for (int x = -6; x <= 6; ++x)
    for (int y = -6; y <= 6; ++y)
      for (int z = -6; z <= 6; ++z)
        if (x * x + y * y + z * z <= 37 && !(x == 6 && y == 0 && z == 1))
          for (const int coordinate : {x, y, z}) set.coordinates.push_back(coordinate);
  Accuracy accuracy;
  accuracy.max_cosine = 0.99;
  const Hull hull = hull_of(set, {.accuracy = accuracy});
  EXPECT_EQ(hull.vertices.size(), 97U);
  EXPECT_EQ(std::ranges::count_if(hull.vertices, [](PointId id) { return id.value < 2; }), 2);
  expect_approximate_laws(hull, set.view());
}

}  // namespace
}  // namespace ndhull
