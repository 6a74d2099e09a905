// Points against planes: exact decisions, any layout of the points, any number of threads.
#include "approx/planes/plane_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/error.h"
#include "core/exact_orientation.h"

namespace ndhull {
namespace {

std::vector<double> random_values(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> values(count);
  for (double& value : values) value = uniform(random);
  return values;
}

/// `count` planes, each through one of the points up to rounding.
std::vector<double> planes_through(const std::vector<double>& points, std::size_t d, std::size_t count,
                                   std::uint64_t seed) {
  const std::vector<double> normals = random_values(count * d, seed);
  std::vector<double> rows;
  for (std::size_t row = 0; row < count; ++row) {
    double offset = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      rows.push_back(normals[row * d + k]);
      offset -= normals[row * d + k] * points[row % (points.size() / d) * d + k];
    }
    rows.push_back(offset);
  }
  return rows;
}

std::uint64_t count_above_exactly(const std::vector<double>& points, const std::vector<double>& planes,
                                  std::size_t d) {
  std::uint64_t above = 0;
  for (std::size_t row = 0; row < planes.size(); row += d + 1) {
    const CentredPlane plane{
        .normal = std::span(planes).subspan(row, d), .reference = {}, .offset = planes[row + d]};
    for (std::size_t point = 0; point < points.size(); point += d) {
      above += exact_plane_value(plane, std::span(points).subspan(point, d)) > 0.0 ? 1U : 0U;
    }
  }
  return above;
}

void expect_same(const PlaneCheck& a, const PlaneCheck& b) {
  EXPECT_EQ(a.pairs, b.pairs);
  EXPECT_EQ(a.above, b.above);
  EXPECT_EQ(a.worst_distance, b.worst_distance);
  EXPECT_EQ(a.worst_point, b.worst_point);
  EXPECT_EQ(a.worst_plane, b.worst_plane);
}

TEST(PlaneCheckExample, NamesTheWorstPair) {
  const std::vector<double> points{0, 0, 3, 0, 0, 2};
  const std::vector<double> planes{1, 0, -4, 0, 2, -3};  // x <= 4, 2 y <= 3
  const PlaneCheck check = check_planes(PointView::row_major(points.data(), 3, 2), planes);
  EXPECT_EQ(check.pairs, 6u);
  EXPECT_EQ(check.above, 1u);
  EXPECT_EQ(check.worst_distance, 0.5);
  EXPECT_EQ(check.worst_point, PointId{2});
  EXPECT_EQ(check.worst_plane, 1u);
}

TEST(PlaneCheckExample, AllBelowGivesTheClosestPair) {
  const std::vector<double> points{0, 0, 3, 0, 0, 1};
  const std::vector<double> planes{1, 0, -4, 0, 2, -3};
  const PlaneCheck check = check_planes(PointView::row_major(points.data(), 3, 2), planes);
  EXPECT_EQ(check.above, 0u);
  EXPECT_EQ(check.worst_distance, -0.5);
  EXPECT_EQ(check.worst_point, PointId{2});
}

TEST(PlaneCheckExample, OnThePlaneIsNotAboveAndOneUlpMoreIs) {
  for (std::size_t d = 1; d <= 9; ++d) {
    std::vector<double> points(200 * d, 0.25);
    std::vector<double> plane(d + 1, 1.0);
    plane[d] = -0.25 * static_cast<double>(d);
    const PointView view = PointView::row_major(points.data(), 200, d);
    const PlaneCheck on = check_planes(view, plane);
    EXPECT_EQ(on.above, 0u);
    EXPECT_EQ(on.worst_distance, 0.0);
    EXPECT_EQ(on.worst_point, PointId{0});
    points[137 * d + d - 1] = std::nextafter(0.25, 1.0);
    const PlaneCheck out = check_planes(view, plane);
    EXPECT_EQ(out.above, 1u);
    EXPECT_GT(out.worst_distance, 0.0);
    EXPECT_LT(out.worst_distance, 1e-16);
    EXPECT_EQ(out.worst_point, PointId{137});
  }
}

TEST(PlaneCheckLaw, CountsAreThoseOfExactArithmetic) {
  for (std::size_t d = 1; d <= 12; ++d) {
    const std::vector<double> points = random_values(150 * d, d);
    const std::vector<double> planes = planes_through(points, d, 170, 100 + d);
    const PlaneCheck check = check_planes(PointView::row_major(points.data(), 150, d), planes);
    EXPECT_EQ(check.above, count_above_exactly(points, planes, d)) << d;
    EXPECT_EQ(check.pairs, 150u * 170u);
  }
}

TEST(PlaneCheckLaw, NearTiesAreExact) {
  // Small differences of large numbers: every plane passes every point within rounding.
  for (std::size_t d = 2; d <= 8; ++d) {
    std::vector<double> points = random_values(100 * d, d);
    const std::vector<double> normal = random_values(d, 50 + d);
    for (std::size_t row = 0; row < 100;
         ++row) {  // projected on normal . x = 1000, last coordinate solved for
      double rest = 1000.0;
      for (std::size_t k = 0; k + 1 < d; ++k) rest -= normal[k] * points[row * d + k];
      points[row * d + d - 1] = rest / normal[d - 1];
    }
    std::vector<double> planes;
    for (int step = -40; step <= 40; ++step) {
      planes.insert(planes.end(), normal.begin(), normal.end());
      planes.push_back(-1000.0 + step * 0x1p-44);
    }
    const PlaneCheck check = check_planes(PointView::row_major(points.data(), 100, d), planes);
    EXPECT_EQ(check.above, count_above_exactly(points, planes, d)) << d;
    EXPECT_GT(check.above, 0u);
    EXPECT_LT(check.above, check.pairs);
  }
}

TEST(PlaneCheckLaw, ThreadsDoNotChangeTheResult) {
  const std::size_t d = 5;
  const std::vector<double> points = random_values(9000 * d, 3);
  std::vector<double> planes = planes_through(points, d, 5000, 4);
  const PointView view = PointView::row_major(points.data(), 9000, d);
  expect_same(check_planes(view, planes, 1), check_planes(view, planes, 2));
  for (std::size_t row = 0; row < planes.size(); row += d + 1) planes[row + d] -= 10.0;  // all below
  const PlaneCheck below = check_planes(view, planes, 1);
  EXPECT_EQ(below.above, 0u);
  EXPECT_LT(below.worst_distance, 0.0);
  expect_same(below, check_planes(view, planes, 2));
}

TEST(PlaneCheckLaw, LayoutDoesNotChangeTheResult) {
  const std::size_t d = 4;
  const std::size_t n = 300;
  const std::vector<double> values = random_values(n * d, 11);
  const std::vector<float> floats(values.begin(), values.end());
  std::vector<double> rows(floats.begin(), floats.end()), by_column(n * d), wide(n * (d + 3), HUGE_VAL);
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = 0; k < d; ++k) by_column[k * n + row] = wide[row * (d + 3) + k] = rows[row * d + k];
  }
  const std::vector<double> planes = planes_through(rows, d, 77, 12);
  const PlaneCheck expected = check_planes(PointView::row_major(rows.data(), n, d), planes);
  expect_same(expected, check_planes(PointView::row_major(floats.data(), n, d), planes));
  expect_same(expected, check_planes({by_column.data(), n, d, ScalarType::kFloat64, 1, n}, planes));
  expect_same(expected, check_planes({wide.data(), n, d, ScalarType::kFloat64, d + 3, 1}, planes));
}

TEST(PlaneCheckMetamorphic, LengthOfTheNormalDoesNotMatter) {
  const std::vector<double> points = random_values(100 * 3, 5);
  std::vector<double> planes = planes_through(points, 3, 60, 6);
  const PointView view = PointView::row_major(points.data(), 100, 3);
  const PlaneCheck expected = check_planes(view, planes);
  for (const double factor : {0x1p900, 0x1p-900}) {
    std::vector<double> scaled = planes;
    for (double& value : scaled) value *= factor;
    expect_same(expected, check_planes(view, scaled));
  }
}

TEST(PlaneCheckExample, HugeAndTinyCoordinatesAreDecided) {
  const double huge = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const std::vector<double> points{huge, huge, huge, std::nextafter(huge, 0.0), tiny, 0.0, 0.0, tiny};
  const std::vector<double> planes{1, -1, 0, huge, -huge, 0, tiny, -tiny, 0};
  const PlaneCheck check = check_planes(PointView::row_major(points.data(), 4, 2), planes);
  EXPECT_EQ(check.above, 6u);  // the second and third point are above all three
  EXPECT_GT(check.worst_distance, 1e290);
  EXPECT_EQ(check.worst_point, PointId{1});
}

TEST(PlaneCheckExample, NoPlanesOrNoPointsIsNoPair) {
  const std::vector<double> points{1, 2};
  EXPECT_EQ(check_planes(PointView::row_major(points.data(), 1, 2), {}).pairs, 0u);
  EXPECT_EQ(check_planes(PointView::row_major(points.data(), 0, 2), std::vector<double>{1, 0, 0}).pairs, 0u);
  EXPECT_FALSE(check_planes(PointView::row_major(points.data(), 1, 2), {}).worst_point.valid());
}

TEST(PlaneCheckExample, UnusablePlanesAreRefused) {
  const std::vector<double> points{1, 2};
  const PointView view = PointView::row_major(points.data(), 1, 2);
  const auto code_of = [&](const std::vector<double>& planes) {
    try {
      check_planes(view, planes);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::kFileMissing;
  };
  EXPECT_EQ(code_of({1, 0, 0, 0, 0, 1}), ErrorCode::kBadHalfspace);
  EXPECT_EQ(code_of({1, 0, 0, 0}), ErrorCode::kUsage);
}

}  // namespace
}  // namespace ndhull
