// Small systems of integers whose intersection is a point or a segment: where many planes meet in one point all
// of them are about the origin of the last step, and nothing but rounding is left of their distances.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/intersect/intersect_support.h"

namespace ndhull {
namespace {

/// Rows normal, offset, and the vertices of what they enclose, as lrs has them.
struct System {
  std::size_t dimension;
  std::vector<double> rows, vertices;
};

const System kPoint5{
    5,
    {-2,  0,  -1, 1,  1, -4, -2, -2, 0,  -2, -1, 0,  -2, 2,  2,  1,  2,  -9, -2, 2,  -1, -1, 0,
     -10, 0,  2,  -1, 1, 2,  -4, -2, -1, 2,  2,  -1, -2, 1,  2,  -1, 1,  -2, -3, 0,  0,  0,  2,
     1,   -1, 2,  -2, 1, 1,  0,  7,  1,  0,  0,  2,  0,  2,  1,  2,  -1, -1, 1,  -2, -1, 1,  -1,
     -1,  1,  -4, -1, 1, 1,  0,  -1, -6, -1, 2,  0,  1,  1,  -6, 0,  0,  1,  1,  -2, 0,  2,  -1,
     0,   1,  1,  6,  0, 0,  2,  -2, 1,  0,  -1, -2, 2,  -1, 1,  1,  0,  -2, -1, -1, -2, 4},
    {-2, 2, 0, 0, 0}};

const System kPoint4{
    4,
    {2,  1,  0,  -2, -1, 0,  0,  0, -2, 0,  0,  2,  -2, -2, -1, 1,  -1, 2,  2,  -1, -1, -1, 2,  -2, 0, -1,
     2,  -2, -2, -3, 0,  1,  1,  1, -2, -2, 0,  2,  1,  -3, -1, 2,  1,  -1, -2, 2,  2,  1,  -1, -1, 2, 1,
     -2, 0,  -1, -1, 2,  -1, -2, 0, -2, -1, 2,  -1, -1, 2,  -2, 1,  -1, -1, -2, 0,  -2, -1, -3, -1, 0, 0,
     -2, 0,  -1, -2, -1, -2, -2, 2, 0,  -2, 2,  -2, 2,  -2, -2, -2, -3, 0,  -1, -2, 0,  0,  1,  2,  1, 1,
     -1, 0,  2,  -1, 1,  0,  2,  1, -1, 2,  -1, -1, -1, 0,  0,  -3, -2, -1, 0,  2,  1,  0,  0,  0,  2, 0},
    {0.5, 0, 0, 0}};

const System kSegment3{
    3, {1, 0, 0, -1, 0, 0, 1, 0, -1, 0, 0, -1, 0, 2, -2, 0, 2, -2, -1, 0, 0, -2, -2, 0}, {0, 0, 0, -1, 0, 0}};

const System kSegment4{
    4,
    {1, 0,  0, 0, 0,  0, 1, 0, 0, 0, 0,  0,  1, 0,  0, 0, 0,  0,  1,  -1, -1, 0, 0,  0,  0,  0,  -1, 0,
     0, -1, 0, 0, -1, 0, 0, 0, 0, 0, -1, -1, 1, -1, 1, 0, -1, -2, -1, -1, 0,  0, -1, -2, -2, -2, 0},
    {0, 0, 0, 0, 0, 0, 0, 1}};

const System kFan4{4,
                   {2,  -1, 1,  1,  -2, 2,  -1, 0,  -1, -1, 1,  0,  1,  0,  0, 0,  1, 2,  0,  -2, 1,  0,  -1,
                    1,  -3, -1, 1,  -1, -1, -4, 1,  -1, 1,  -1, -2, 0,  -1, 0, 1,  0, 0,  2,  -2, 1,  0,  -1,
                    0,  0,  0,  -4, 0,  0,  0,  -1, 0,  0,  -1, 0,  -1, -2, 0, 0,  1, 0,  -1, 1,  0,  0,  1,
                    -1, 0,  0,  1,  1,  -3, 0,  -2, 2,  1,  0,  0,  -2, 2,  1, -1, 0, 2,  0,  2,  -1, 0,  0,
                    0,  -1, 0,  -1, 1,  0,  -1, -2, 0,  -1, 2,  -2, 0,  -1, 0, 1,  1, -1, -1, 1,  0,  -1, -1},
                   {-1, 0, 0, 0, 0, 0, 0, 0}};

void expect_vertices(const System& system) {
  const HalfspaceIntersection region = intersect_planes({system.dimension, system.rows});
  ASSERT_EQ(region.kind, IntersectionKind::kLowerDimensional) << to_string(region.kind);
  EXPECT_EQ(region.vertex_count(), system.vertices.size() / system.dimension);
  EXPECT_EQ(region.rank, system.vertices.size() / system.dimension - 1);
  PointSet known;
  known.dimension = system.dimension;
  known.coordinates = system.vertices;
  EXPECT_LT(furthest_vertex(region, known), 1e-14);
}

TEST(FlatIntersectionRegression, ManyPlanesMeetInAPoint) {
  expect_vertices(kPoint5);
  expect_vertices(kPoint4);
}

TEST(FlatIntersectionRegression, ManyPlanesMeetInASegment) {
  expect_vertices(kSegment3);
  expect_vertices(kSegment4);
  expect_vertices(kFan4);
}

/// Planes through a common point, of which some hold it from all sides in a subspace.
TEST(FlatIntersectionLaw, IntegerSystemsThatHaveAPointAreNotEmpty) {
  std::mt19937 random(7);
  const auto number = [&](int low, int high) {
    return static_cast<double>(std::uniform_int_distribution<int>(low, high)(random));
  };
  int flat = 0;
  for (int run = 0; run < 400; ++run) {
    const auto dimension = static_cast<std::size_t>(number(2, 6));
    std::vector<double> point(dimension), sum(dimension, 0.0);
    for (double& entry : point) entry = number(-2, 2);
    PlaneRows planes{dimension, {}};
    const auto add = [&](const std::vector<double>& normal, double room) {
      double offset = -room;
      for (std::size_t k = 0; k < dimension; ++k) offset -= normal[k] * point[k];
      planes.values.insert(planes.values.end(), normal.begin(), normal.end());
      planes.values.push_back(offset);
    };
    const auto random_normal = [&] {
      std::vector<double> normal(dimension);
      do {
        for (double& entry : normal) entry = number(-2, 2);
      } while (std::all_of(normal.begin(), normal.end(), [](double entry) { return entry == 0.0; }));
      return normal;
    };
    // These and the one that closes their sum hold the point in all directions that they span.
    const auto equations = static_cast<std::size_t>(number(1, static_cast<int>(dimension)));
    for (std::size_t row = 0; row < equations; ++row) {
      const std::vector<double> normal = random_normal();
      for (std::size_t k = 0; k < dimension; ++k) sum[k] -= normal[k];
      add(normal, 0.0);
    }
    if (std::any_of(sum.begin(), sum.end(), [](double entry) { return entry != 0.0; })) add(sum, 0.0);
    for (int row = 0; row < 12; ++row) add(random_normal(), std::max(0.0, number(-2, 2)));
    const HalfspaceIntersection region = intersect_planes(planes);
    EXPECT_NE(region.kind, IntersectionKind::kEmpty) << run;
    EXPECT_NE(region.kind, IntersectionKind::kBounded) << run;
    if (region.kind != IntersectionKind::kLowerDimensional) continue;
    ++flat;
    for (std::size_t row = 0; row < planes.count(); ++row) {
      for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex) {
        const double* const plane = planes.values.data() + row * (dimension + 1);
        double value = plane[dimension];
        for (std::size_t k = 0; k < dimension; ++k)
          value += plane[k] * region.vertices[vertex * dimension + k];
        EXPECT_LT(value, 1e-12) << run;
      }
    }
  }
  EXPECT_GT(flat, 200);
}

}  // namespace
}  // namespace ndhull
