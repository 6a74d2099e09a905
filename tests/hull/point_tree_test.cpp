#include "core/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/support/fused_dot.h"

namespace ndhull {
namespace {

struct Cloud {
  std::size_t dimension;
  std::vector<double> points, normals;
};

enum class Shape { kSphere, kBall, kFarSphere, kFlat };

/// Column k is multiplied by scale^k, the normals by its inverse. Flat: all in the plane x_0 = 1.
Cloud make_cloud(Shape shape, std::size_t dimension, std::size_t count, double scale) {
  std::mt19937_64 random(dimension * 1000 + count);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.01, 1.0);
  Cloud cloud{dimension, {}, {}};
  constexpr std::size_t kNormals = 37;
  for (std::size_t row = 0; row < count + kNormals; ++row) {
    const bool is_point = row < count;
    std::vector<double> x(dimension);
    double length_sq = 0.0;
    for (double& value : x) {
      value = normal(random);
      length_sq += value * value;
    }
    const double radius = is_point && shape == Shape::kBall ? uniform(random) : 1.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      double value = radius * x[k] / std::sqrt(length_sq);
      if (is_point && shape == Shape::kFarSphere) value += 100.0;
      if (is_point && shape == Shape::kFlat && k == 0) value = 1.0;
      (is_point ? cloud.points : cloud.normals)
          .push_back(value * std::pow(scale, (is_point ? 1.0 : -1.0) * static_cast<double>(k)));
    }
  }
  return cloud;
}

void expect_all_products(const Cloud& cloud) {
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
  for (const Shape shape : {Shape::kSphere, Shape::kBall, Shape::kFarSphere, Shape::kFlat}) {
    for (const std::size_t dimension : {1u, 2u, 3u, 5u, 8u, 16u, 19u}) {
      for (const std::size_t count : {1u, 2u, 15u, 17u, 257u, 5000u}) {
        for (const double scale : {1.0, 1e-3, 1e3}) {
          SCOPED_TRACE(std::to_string(static_cast<int>(shape)) + ", " + std::to_string(dimension) + "-d, " +
                       std::to_string(count) + " points, " + std::to_string(scale));
          expect_all_products(make_cloud(shape, dimension, count, scale));
        }
      }
    }
  }
}

TEST(PointTreeLaw, AllPointsAboveAreFound) {
  for (const Shape shape : {Shape::kSphere, Shape::kBall, Shape::kFarSphere}) {
    for (const std::size_t dimension : {2u, 5u, 11u}) {
      const Cloud cloud = make_cloud(shape, dimension, 3000, 1.0);
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

TEST(PointTreeLaw, AKnownOrderGivesTheSameForOtherCoordinates) {
  const Cloud cloud = make_cloud(Shape::kBall, 6, 3000, 1.0);
  Cloud moved = cloud;
  for (double& x : moved.points) x = 3.0 * x - 0.5;
  const PointTree tree(6, moved.points, PointTree(6, cloud.points).order()), fresh(6, moved.points);
  std::vector<FurthestPoint> a(37, FurthestPoint{-HUGE_VAL}), b(37, FurthestPoint{-HUGE_VAL});
  find_furthest(tree, cloud.normals, a);
  find_furthest(fresh, cloud.normals, b);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].dot, b[i].dot);
}

// One point above a plane that holds hundreds, by less than single precision can tell.
TEST(PointTreeLaw, APointAHairAboveAPlaneIsFound) {
  for (const double hair : {1e-16, 1e-13, 1e-9, 1e-5}) {
    Cloud cloud = make_cloud(Shape::kFlat, 5, 4000, 1.0);
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
    Cloud cloud = make_cloud(Shape::kSphere, 4, 300, 1.0);
    for (double& x : cloud.points) x *= size;
    const std::vector<double> once = cloud.points;
    cloud.points.insert(cloud.points.end(), once.begin(), once.end());
    expect_all_products(cloud);
  }
}

}  // namespace
}  // namespace ndhull
