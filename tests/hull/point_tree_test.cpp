#include "core/search/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/direction_cloud.h"
#include "tests/support/fused_dot.h"

namespace ndhull {
namespace {

void expect_all_products(const DirectionCloud& cloud) {
  const std::size_t dimension = cloud.dimension, directions = cloud.normals.size() / dimension;
  const std::size_t count = cloud.points.size() / dimension;
  const PointTree tree(dimension, cloud.points);
  std::vector<std::uint32_t> order = tree.order();
  std::sort(order.begin(), order.end());
  for (std::uint32_t row = 0; row < count; ++row) ASSERT_EQ(order[row], row);
  std::vector<double> largest(directions, -HUGE_VAL);
  for (std::size_t i = 0; i < directions; ++i)
    for (std::size_t row = 0; row < count; ++row)
      largest[i] = std::max(
          largest[i], fused_dot(&cloud.normals[i * dimension], &cloud.points[row * dimension], dimension));
  std::vector<FurthestPoint> furthest(directions, FurthestPoint{-HUGE_VAL});
  find_furthest(tree, cloud.normals, furthest);
  for (std::size_t i = 0; i < directions; ++i) {
    EXPECT_EQ(furthest[i].dot, largest[i]);
    ASSERT_LT(furthest[i].row, count);
    EXPECT_EQ(fused_dot(&cloud.normals[i * dimension], &cloud.points[furthest[i].row * dimension], dimension),
              largest[i]);
  }
  // Known to be attained, exactly or a hair below.
  for (std::size_t i = 0; i < directions; ++i)
    furthest[i] = FurthestPoint{i % 2 == 0 ? largest[i] : std::nextafter(largest[i], -HUGE_VAL)};
  find_furthest(tree, cloud.normals, furthest);
  for (std::size_t i = 0; i < directions; ++i) {
    EXPECT_EQ(furthest[i].dot, largest[i]);
    EXPECT_EQ(furthest[i].row == FurthestPoint::kNoRow, i % 2 == 0);
  }
}

TEST(PointTreeLaw, TheResultIsThatOfAllProductsDigitForDigit) {
  for_each_cloud({CloudShape::kSphere, CloudShape::kBall, CloudShape::kFarSphere, CloudShape::kFlat,
                  CloudShape::kSkewed},
                 {1u, 2u, 3u, 5u, 8u, 16u, 19u}, {1u, 2u, 15u, 17u, 257u, 5000u}, expect_all_products);
}

TEST(PointTreeLaw, AllPointsAboveAreFound) {
  for (const CloudShape shape :
       {CloudShape::kSphere, CloudShape::kBall, CloudShape::kFarSphere, CloudShape::kSkewed}) {
    for (const std::size_t dimension : {2u, 5u, 11u}) {
      const DirectionCloud cloud = make_cloud(shape, dimension, 3000, 1.0);
      const PointTree tree(dimension, cloud.points);
      const std::span<const double> normal(cloud.normals.data(), dimension);
      std::vector<double> products;
      for (std::size_t row = 0; row < 3000; ++row)
        products.push_back(fused_dot(normal.data(), &cloud.points[row * dimension], dimension));
      std::vector<double> sorted = products;
      std::sort(sorted.begin(), sorted.end());
      for (const std::size_t below : {0u, 1u, 1500u, 2999u}) {
        std::vector<FurthestPoint> found;
        find_above(tree, normal, sorted[below], found);
        EXPECT_EQ(found.size(), 3000 - below);
        for (const FurthestPoint& point : found) EXPECT_EQ(point.dot, products[point.row]);
        std::sort(found.begin(), found.end(),
                  [](const FurthestPoint& a, const FurthestPoint& b) { return a.row < b.row; });
        for (std::size_t i = 1; i < found.size(); ++i) EXPECT_LT(found[i - 1].row, found[i].row);
      }
    }
  }
}

// One point above a plane that holds hundreds, by less than single precision can tell.
TEST(PointTreeLaw, APointAHairAboveAPlaneIsFound) {
  for (const double hair : {1e-16, 1e-13, 1e-9, 1e-5}) {
    DirectionCloud cloud = make_cloud(CloudShape::kFlat, 5, 4000, 1.0);
    cloud.points[1234 * 5] = 1.0 + 2.0 * hair;
    cloud.normals = {1.0, 0.0, 0.0, 0.0, 0.0};
    std::vector<FurthestPoint> furthest{FurthestPoint{1.0}};
    find_furthest(PointTree(5, cloud.points), cloud.normals, furthest);
    EXPECT_EQ(furthest[0].row, 1234u);
    EXPECT_EQ(furthest[0].dot, 1.0 + 2.0 * hair);
  }
}

TEST(PointTreeLaw, DuplicatesAndTinyValuesChangeNothing) {
  for (const double size : {1e-310, 1e-200, 1e200}) {
    DirectionCloud cloud = make_cloud(CloudShape::kSphere, 4, 300, 1.0);
    for (double& x : cloud.points) x *= size;
    const std::vector<double> once = cloud.points;
    cloud.points.insert(cloud.points.end(), once.begin(), once.end());
    expect_all_products(cloud);
  }
}

}  // namespace
}  // namespace ndhull
