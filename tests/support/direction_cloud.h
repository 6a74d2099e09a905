// Points and directions for tests of searches along directions.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

namespace ndhull {

enum class CloudShape { kSphere, kBall, kFarSphere, kFlat, kCubeCorners, kSkewed };

/// Points, the ranges of their columns, and directions.
struct DirectionCloud {
  static constexpr std::size_t kNormals = 37;
  std::size_t dimension = 0;
  std::vector<double> points = {}, normals = {}, low = {}, high = {};

  void find_ranges() {
    low.assign(dimension, HUGE_VAL);
    high.assign(dimension, -HUGE_VAL);
    for (std::size_t i = 0; i < points.size(); ++i) {
      low[i % dimension] = std::min(low[i % dimension], points[i]);
      high[i % dimension] = std::max(high[i % dimension], points[i]);
    }
  }
};

/// Column k is multiplied by scale^k, the normals by its inverse. Flat: all in the plane x_0 = 1. Every fifth
/// direction is an axis. Skewed: lognormal, most points in one corner of their box.
inline DirectionCloud make_cloud(CloudShape shape, std::size_t dimension, std::size_t count, double scale) {
  std::mt19937_64 random(dimension * 1000 + count);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.01, 1.0);
  DirectionCloud cloud{.dimension = dimension};
  for (std::size_t row = 0; row < count + DirectionCloud::kNormals; ++row) {
    const bool is_point = row < count;
    std::vector<double> x(dimension);
    double length_sq = 0.0;
    for (double& value : x) {
      value = normal(random);
      length_sq += value * value;
    }
    const double radius = is_point && shape == CloudShape::kBall ? uniform(random) : 1.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      double value = radius * x[k] / std::sqrt(length_sq);
      if (is_point && shape == CloudShape::kFarSphere) value += 100.0;
      if (is_point && shape == CloudShape::kFlat && k == 0) value = 1.0;
      if (is_point && shape == CloudShape::kCubeCorners) value = x[k] < 0.0 ? -1.0 : 1.0;
      if (is_point && shape == CloudShape::kSkewed) value = std::exp(2.0 * x[k]);
      if (!is_point && row % 5 == 0) value = k == row % dimension ? 1.0 : 0.0;
      (is_point ? cloud.points : cloud.normals)
          .push_back(value * std::pow(scale, (is_point ? 1.0 : -1.0) * static_cast<double>(k)));
    }
  }
  cloud.find_ranges();
  return cloud;
}

/// Calls expect(cloud) for all of these shapes, dimensions and counts, with columns alike and very different.
inline void for_each_cloud(std::initializer_list<CloudShape> shapes,
                           std::initializer_list<std::size_t> dimensions,
                           std::initializer_list<std::size_t> counts, void (*expect)(const DirectionCloud&)) {
  for (const CloudShape shape : shapes) {
    for (const std::size_t dimension : dimensions) {
      for (const std::size_t count : counts) {
        for (const double scale : {1.0, 1e-3, 1e3}) {
          SCOPED_TRACE(std::to_string(static_cast<int>(shape)) + ", " + std::to_string(dimension) + "-d, " +
                       std::to_string(count) + " points, " + std::to_string(scale));
          expect(make_cloud(shape, dimension, count, scale));
        }
      }
    }
  }
}

}  // namespace ndhull
