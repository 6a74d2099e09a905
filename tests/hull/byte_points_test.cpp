#include "core/search/byte_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/search/furthest_points.h"
#include "tests/support/direction_cloud.h"
#include "tests/support/fused_dot.h"

namespace ndhull {
namespace {

StridedRows rows_of(const DirectionCloud& cloud) {
  return {cloud.points.data(), cloud.points.size() / cloud.dimension, cloud.dimension};
}

/// The largest product of each normal, and the first row that has it.
std::vector<FurthestPoint> first_furthest(const DirectionCloud& cloud) {
  std::vector<FurthestPoint> furthest(cloud.normals.size() / cloud.dimension, FurthestPoint{-HUGE_VAL});
  for (std::size_t i = 0; i < furthest.size(); ++i) {
    for (std::uint32_t row = 0; row < rows_of(cloud).count; ++row) {
      const double product =
          fused_dot(&cloud.normals[i * cloud.dimension], rows_of(cloud).row(row), cloud.dimension);
      if (product > furthest[i].dot) furthest[i] = {product, row};
    }
  }
  return furthest;
}

void expect_bytes_find_all(const DirectionCloud& cloud) {
  const BytePoints points(cloud.dimension, rows_of(cloud), cloud.low, cloud.high);
  const std::vector<FurthestPoint> expected = first_furthest(cloud);
  std::vector<FurthestPoint> found(expected.size(), FurthestPoint{-HUGE_VAL});
  find_furthest(points, cloud.normals, found);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].dot, expected[i].dot);
    EXPECT_EQ(found[i].row, expected[i].row);
  }
  // Known to be attained, exactly or a hair below.
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i] = FurthestPoint{i % 2 == 0 ? expected[i].dot : std::nextafter(expected[i].dot, -HUGE_VAL)};
  find_furthest(points, cloud.normals, found);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].dot, expected[i].dot);
    EXPECT_EQ(found[i].row, i % 2 == 0 ? FurthestPoint::kNoRow : expected[i].row);
  }
}

TEST(BytePointsLaw, TheResultIsThatOfAllProductsDigitForDigit) {
  for_each_cloud({CloudShape::kSphere, CloudShape::kBall, CloudShape::kFarSphere, CloudShape::kFlat,
                  CloudShape::kCubeCorners},
                 {1u, 2u, 3u, 5u, 8u, 11u, 16u}, {1u, 2u, 31u, 33u, 257u, 5000u}, expect_bytes_find_all);
}

TEST(BytePointsLaw, SeveralSegmentsAreOne) {
  expect_bytes_find_all(make_cloud(CloudShape::kSphere, 4, 300'000, 1.0));
  expect_bytes_find_all(make_cloud(CloudShape::kBall, 15, 70'000, 1.0));
}

TEST(BytePointsLaw, RangesMayBeWider) {
  DirectionCloud cloud = make_cloud(CloudShape::kSphere, 6, 3000, 1.0);
  for (double& x : cloud.low) x -= 3.0;
  for (double& x : cloud.high) x += 1.0;
  expect_bytes_find_all(cloud);
}

TEST(BytePointsLaw, RowsMayBeApart) {
  const DirectionCloud cloud = make_cloud(CloudShape::kSphere, 6, 3000, 1.0);
  DirectionCloud some = cloud;
  some.points.clear();
  for (std::size_t row = 0; row < 3000; row += 16)
    some.points.insert(some.points.end(), rows_of(cloud).row(row), rows_of(cloud).row(row) + 6);
  const BytePoints points(6, {cloud.points.data(), (3000 + 15) / 16, 16 * 6}, cloud.low, cloud.high);
  const std::vector<FurthestPoint> expected = first_furthest(some);
  std::vector<FurthestPoint> found(expected.size(), FurthestPoint{-HUGE_VAL});
  find_furthest(points, cloud.normals, found);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].row, expected[i].row);
}

// One point above a plane that holds thousands, by less than bytes can tell.
TEST(BytePointsLaw, APointAHairAboveAPlaneIsFound) {
  for (const double hair : {1e-16, 1e-13, 1e-9, 1e-5}) {
    DirectionCloud cloud = make_cloud(CloudShape::kFlat, 5, 4000, 1.0);
    cloud.points[1234 * 5] = 1.0 + 2.0 * hair;
    cloud.normals = {1.0, 0.0, 0.0, 0.0, 0.0};
    cloud.find_ranges();
    std::vector<FurthestPoint> furthest{FurthestPoint{1.0}};
    find_furthest(BytePoints(5, rows_of(cloud), cloud.low, cloud.high), cloud.normals, furthest);
    EXPECT_EQ(furthest[0].row, 1234u);
    EXPECT_EQ(furthest[0].dot, 1.0 + 2.0 * hair);
  }
}

TEST(BytePointsLaw, DuplicatesAndTinyValuesChangeNothing) {
  for (const double size : {1e-310, 1e-200, 1e-160, 1e160, 1e200}) {
    DirectionCloud cloud = make_cloud(CloudShape::kSphere, 4, 300, 1.0);
    for (double& x : cloud.points) x *= size;
    const std::vector<double> once = cloud.points;
    cloud.points.insert(cloud.points.end(), once.begin(), once.end());
    cloud.find_ranges();
    expect_bytes_find_all(cloud);
    for (double& x : cloud.normals) x *= 1e-3 / size;
    expect_bytes_find_all(cloud);
  }
}

TEST(FurthestPointsLaw, ATreeFindsTheSame) {
  const DirectionCloud cloud = make_cloud(CloudShape::kSphere, 3, 3000, 1.0);
  std::vector<double> normals;
  for (int i = 0; i < 20; ++i) normals.insert(normals.end(), cloud.normals.begin(), cloud.normals.end());
  FurthestPoints points(3, rows_of(cloud), cloud.low, cloud.high, true);
  const std::vector<FurthestPoint> expected = first_furthest(cloud);
  for (int round = 0; round < 3; ++round) {  // a tree from the second round on
    std::vector<FurthestPoint> found(normals.size() / 3, FurthestPoint{-HUGE_VAL});
    points.find(normals, found);
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_EQ(found[i].dot, expected[i % DirectionCloud::kNormals].dot);
  }
}

// Thousands of points are as far as any: bytes cannot tell them apart, and a tree takes over in the middle.
TEST(FurthestPointsLaw, ManyAsFarChangeNothing) {
  const DirectionCloud cloud = make_cloud(CloudShape::kCubeCorners, 6, 9000, 1.0);
  std::vector<double> normals;
  for (int i = 0; i < 40; ++i) normals.insert(normals.end(), cloud.normals.begin(), cloud.normals.end());
  FurthestPoints points(6, rows_of(cloud), cloud.low, cloud.high, true);
  const std::vector<FurthestPoint> expected = first_furthest(cloud);
  for (int round = 0; round < 2; ++round) {
    std::vector<FurthestPoint> found(normals.size() / 6, FurthestPoint{-HUGE_VAL});
    points.find(normals, found);
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_EQ(found[i].dot, expected[i % DirectionCloud::kNormals].dot);
  }
}

}  // namespace
}  // namespace ndhull
