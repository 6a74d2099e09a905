// Scans in single precision against plain loops in double precision.
#include "approx/rays/direction_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/portable_random.h"

namespace ndhull {
namespace {

struct Scene {
  std::size_t dimension;
  std::vector<double> points;     // in the order of the tiles
  std::vector<float> directions;  // unit
  ScanTiles tiles{0};

  double product(std::size_t point, std::size_t direction) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      sum += points[point * dimension + k] * static_cast<double>(directions[direction * dimension + k]);
    }
    return sum;
  }
};

Scene make_scene(std::size_t dimension, std::size_t count, std::size_t directions, bool sorted,
                 std::uint64_t seed) {
  PortableRandom random(seed);
  Scene scene{dimension, {}, {}, ScanTiles(dimension)};
  std::vector<std::vector<double>> rows(count, std::vector<double>(dimension));
  for (auto& row : rows) {
    for (double& x : row) x = random.normal();
  }
  const auto length = [](const std::vector<double>& row) {
    double sum = 0.0;
    for (const double x : row) sum += x * x;
    return sum;
  };
  if (sorted) {
    std::sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return length(a) > length(b); });
  }
  for (std::uint32_t id = 0; id < count; ++id) {
    scene.tiles.append(rows[id].data(), id);
    scene.points.insert(scene.points.end(), rows[id].begin(), rows[id].end());
  }
  if (sorted) scene.tiles.mark_sorted();
  for (std::size_t one = 0; one < directions; ++one) {
    std::vector<double> direction(dimension);
    for (double& x : direction) x = random.normal();
    const double norm = std::sqrt(length(direction));
    for (const double x : direction) scene.directions.push_back(static_cast<float>(x / norm));
  }
  return scene;
}

/// Expects the answers that double precision gives, but for products within the error bound of a threshold.
void expect_right(const Scene& scene, const std::vector<DirectionQuery>& queries) {
  const double error = scene.tiles.product_error();
  for (std::size_t row = 0; row < queries.size(); ++row) {
    const DirectionQuery& query = queries[row];
    double largest = -1e300;
    for (std::uint32_t id = 0; id < scene.tiles.size(); ++id) {
      if (id == query.skip) continue;
      const double product = scene.product(id, row);
      largest = std::max(largest, product);
      if (query.is_refuted) continue;
      EXPECT_LE(product, static_cast<double>(query.refute) + error);
      const bool listed = std::find(query.near.begin(), query.near.end(), id) != query.near.end();
      if (product > static_cast<double>(query.threshold) + error) {
        EXPECT_TRUE(listed) << id;
      } else if (product < static_cast<double>(query.threshold) - error) {
        EXPECT_FALSE(listed) << id;
      }
    }
    if (query.is_refuted) {
      ASSERT_NE(query.furthest, DirectionQuery::kNoPoint);
      EXPECT_NE(query.furthest, query.skip);
      EXPECT_GE(scene.product(query.furthest, row), largest - 2.0 * error);
      EXPECT_GT(largest, static_cast<double>(query.refute) - error);
    }
  }
}

TEST(DirectionScanOracle, AgreesWithDoublePrecision) {
  for (const std::size_t dimension : {2U, 3U, 8U, 17U, 30U, 100U}) {
    for (const std::size_t count : {1U, 5U, 63U, 64U, 65U, 1000U, 5000U}) {
      for (const bool sorted : {false, true}) {
        const Scene scene = make_scene(dimension, count, 7, sorted, dimension * 10000 + count);
        std::vector<DirectionQuery> queries(7);
        for (std::size_t row = 0; row < 7; ++row) {
          // Thresholds from deep inside to above everything.
          queries[row].threshold = 0.6F * static_cast<float>(row);
          queries[row].refute = queries[row].threshold + (row % 2 == 0 ? 0.5F : 100.0F);
          if (row == 3) queries[row].skip = 0;
        }
        scan_directions(scene.tiles, scene.directions, queries);
        expect_right(scene, queries);
      }
    }
  }
}

TEST(DirectionScanLaw, AllCoresGiveTheAnswersOfOne) {
  const Scene scene = make_scene(9, 30000, 300, true, 5);
  std::vector<DirectionQuery> alone(300), together(300);
  for (std::size_t row = 0; row < 300; ++row) {
    alone[row].threshold = 0.015F * static_cast<float>(row);
    alone[row].refute = alone[row].threshold + (row % 3 == 0 ? 0.1F : 10.0F);
    together[row] = alone[row];
  }
  scan_directions(scene.tiles, scene.directions, alone);
  scan_directions_in_parallel(scene.tiles, scene.directions, together);
  for (std::size_t row = 0; row < 300; ++row) {
    EXPECT_EQ(alone[row].is_refuted, together[row].is_refuted);
    EXPECT_EQ(alone[row].furthest, together[row].furthest);
    EXPECT_EQ(alone[row].near, together[row].near);
  }
}

}  // namespace
}  // namespace ndhull
