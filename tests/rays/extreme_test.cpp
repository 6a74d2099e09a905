// Vertices without facets against the hull's, with the planes that part them.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "approx/rays/extreme_points.h"
#include "core/portable_random.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

/// Rows of coordinates: which of equal points is the vertex does not matter.
std::set<std::vector<double>> rows_of(const PointSet& set, const std::vector<PointId>& ids) {
  std::set<std::vector<double>> rows;
  for (const PointId id : ids) {
    const auto row = set.row(id.value);
    rows.insert({row.begin(), row.end()});
  }
  return rows;
}

/// Each vertex, and what equals it, is strictly above its plane, all other points strictly below, in long
/// double.
void expect_parted(const ExtremePoints& found, const PointSet& set) {
  const std::size_t columns = set.dimension + 1;
  ASSERT_EQ(found.planes.size(), found.rank == 0 ? 0 : found.vertices.size() * columns);
  for (std::size_t one = 0; one * columns < found.planes.size(); ++one) {
    const double* const plane = found.planes.data() + one * columns;
    const auto vertex = set.row(found.vertices[one].value);
    std::uint32_t copies = 0;
    for (std::size_t row = 0; row < set.rows(); ++row) {
      const auto point = set.row(row);
      long double value = plane[set.dimension];
      for (std::size_t k = 0; k < set.dimension; ++k) value += static_cast<long double>(plane[k]) * point[k];
      const bool is_copy = std::equal(point.begin(), point.end(), vertex.begin());
      copies += is_copy ? 1 : 0;
      EXPECT_EQ(value > 0.0L, is_copy) << "vertex " << found.vertices[one].value << ", point " << row;
    }
    EXPECT_EQ(found.copies[one], copies);
  }
}

TEST(ExtremePointsOracle, AreTheVerticesOfTheHullForEveryFamily) {
  for (const PointFamily family : all_point_families()) {
    for (std::size_t d = 2; d <= 7; ++d) {
      SCOPED_TRACE(std::string(to_string(family)) + " " + std::to_string(d));
      const std::size_t n = family == PointFamily::kLattice ? std::size_t{1} << d : 70;
      const PointSet set = family_points(family, n, d, 3);
      const ExtremePoints found = extreme_points(set.view());
      EXPECT_EQ(found.status, ExtremeStatus::kComplete);
      EXPECT_EQ(found.open_points, 0U);
      EXPECT_EQ(rows_of(set, found.vertices), rows_of(set, hull_of(set).vertices));
      expect_parted(found, set);
    }
  }
}

/// Each of two points that are nearer than roundoff is inside the hull of the others, by way of the other.
TEST(ExtremePointsRegression, OfPointsAsGoodAsEqualOneIsAVertex) {
  for (const std::size_t d : {2U, 3U, 5U}) {
    for (const double gap : {0x1p-52, 1e-14, 1e-13, 5e-13, 1e-12, 2e-12, 3e-12, 1e-11, 1e-9}) {
      SCOPED_TRACE(std::to_string(d) + "-d, gap " + std::to_string(gap * 1e12) + "e-12");
      PointSet set = family_points(PointFamily::kSphere, 40, d, 5);
      const std::vector<double> once = set.coordinates;
      for (const double x : once) set.coordinates.push_back(x * (1.0 + gap));
      const ExtremePoints found = extreme_points(set.view());
      if (gap > 2e-13 && gap < 3e-12) {  // some may stay undecided, none is lost
        EXPECT_GE(found.vertices.size() + found.open_points, 40U);
      } else {
        EXPECT_EQ(found.vertices.size(), 40U);
        EXPECT_EQ(found.open_points, 0U);
      }
      std::uint64_t copies = 0;
      for (std::size_t one = 0; one < found.vertices.size(); ++one) {
        std::uint32_t above = 0;
        for (std::size_t row = 0; row < set.rows(); ++row) {
          long double value = found.planes[one * (d + 1) + d];
          for (std::size_t k = 0; k < d; ++k)
            value += static_cast<long double>(found.planes[one * (d + 1) + k]) * set.row(row)[k];
          above += value > 0.0L ? 1U : 0U;
          if (row == found.vertices[one].value) {
            EXPECT_GT(value, 0.0L);
          }
        }
        EXPECT_EQ(above, found.copies[one]);
        copies += above;
      }
      EXPECT_EQ(found.points_inside + found.open_points, set.rows() - copies);
    }
  }
}

/// Far from the origin planes are rounded by more than they part by, unless their offsets are chosen with
/// that in mind; what no plane of doubles parts is open.
TEST(ExtremePointsRegression, FarFromTheOriginPlanesPartAsTheyAreWritten) {
  for (const std::size_t d : {1U, 2U, 3U, 6U}) {
    for (const double shift : {1e6, 1e9, 1e11}) {
      SCOPED_TRACE(std::to_string(d) + "-d, shift " + std::to_string(shift));
      PointSet set = family_points(PointFamily::kGaussian, 60, d, 7);
      for (std::size_t i = 0; i < set.coordinates.size(); ++i)
        set.coordinates[i] += shift * (i % d == 0 ? 1.0 : -0.7);
      const ExtremePoints found = extreme_points(set.view());
      expect_parted(found, set);
      EXPECT_EQ(found.open_points, 0U);
      if (d > 1) {
        EXPECT_EQ(rows_of(set, found.vertices), rows_of(set, hull_of(set).vertices));
      }
    }
  }
}

TEST(ExtremePointsRegression, OfThinHullsPlanesPartAsTheyAreWritten) {
  for (const std::size_t d : {2U, 3U, 5U}) {
    for (const double thickness : {1e-6, 1e-9, 1e-11}) {
      SCOPED_TRACE(std::to_string(d) + "-d, thickness " + std::to_string(thickness * 1e12) + "e-12");
      PointSet set = family_points(PointFamily::kGaussian, 60, d, 8);
      for (std::size_t row = 0; row < set.rows(); ++row) {  // thin across the first two axes' diagonal
        double& x = set.coordinates[row * d];
        x = set.coordinates[row * d + 1] + thickness * x;
      }
      const ExtremePoints found = extreme_points(set.view());
      expect_parted(found, set);
      EXPECT_EQ(found.open_points, 0U);
      EXPECT_EQ(rows_of(set, found.vertices), rows_of(set, hull_of(set).vertices));
    }
  }
}

/// A hull so thin that no double far from the origin is inside it.
TEST(ExtremePointsRegression, OfAHullAFewRoundingsThickNoVertexIsLost) {
  constexpr double kUlp = 0x1p-32, kFarX = 0x1p18, kFarY = 0x1.8p20;
  const std::vector<double> steps = {-313514514.75, -4283509394, -313514509.25, -4283509394,
                                     627029031,     8567018786,  940543544.25,  12850528180,
                                     940543538.75,  12850528180, -1.5,          0};
  PointSet set;
  set.dimension = 2;
  for (std::size_t i = 0; i < steps.size(); ++i)
    set.coordinates.push_back((i % 2 == 0 ? -kFarX : kFarY) + kUlp * steps[i]);
  const ExtremePoints found = extreme_points(set.view());
  EXPECT_EQ(found.vertices.size() + found.open_points, 6U);
  EXPECT_EQ(found.points_inside, 0U);
}

TEST(ExtremePointsOracle, AreTheVerticesOfTheHullOnDegenerateInputs) {
  for (std::size_t d = 2; d <= 6; ++d) {
    for (const DegenerateCase& input : degenerate_cases(80, d, 40 + d)) {
      SCOPED_TRACE(input.description + ", d " + std::to_string(d));
      const ExtremePoints found = extreme_points(input.points.view());
      const Hull hull = hull_of(input.points);
      EXPECT_EQ(found.rank, hull.rank);
      EXPECT_EQ(found.open_points, 0U);
      EXPECT_EQ(rows_of(input.points, found.vertices), rows_of(input.points, hull.vertices));
      expect_parted(found, input.points);
    }
  }
}

TEST(ExtremePointsExample, ManyDimensionsAndPointsInside) {
  // 40 points inside those of a gaussian cloud in 100-d: combinations of few of them.
  PointSet set = family_points(PointFamily::kGaussian, 300, 100, 8);
  PortableRandom random(4);
  for (int one = 0; one < 40; ++one) {
    std::vector<double> mixed(100, 0.0), weights(6);
    double sum = 0.0;
    for (double& weight : weights) sum += weight = random.exponential();
    for (const double weight : weights) {
      const auto row = set.row(random.below(300));
      for (std::size_t k = 0; k < 100; ++k) mixed[k] += weight / sum * row[k];
    }
    set.coordinates.insert(set.coordinates.end(), mixed.begin(), mixed.end());
  }
  const ExtremePoints found = extreme_points(set.view());
  ASSERT_EQ(found.vertices.size(), 300U);
  EXPECT_EQ(found.vertices.back().value, 299U);
  EXPECT_EQ(found.points_inside, 40U);
  expect_parted(found, set);
}

TEST(ExtremePointsExample, OfOneAndTwoDistinctPoints) {
  const PointSet same{3, std::vector<double>(15, 2.5), ""};
  const ExtremePoints point = extreme_points(same.view());
  EXPECT_EQ(point.rank, 0U);
  ASSERT_EQ(point.vertices.size(), 1U);
  EXPECT_EQ(point.copies.front(), 5U);
  const PointSet line{2, {0, 0, 3, 3, 1, 1, 3, 3, 2, 2}, ""};
  const ExtremePoints segment = extreme_points(line.view());
  EXPECT_EQ(segment.rank, 1U);
  ASSERT_EQ(segment.vertices.size(), 2U);
  EXPECT_EQ(segment.vertices[0].value, 0U);
  EXPECT_EQ(segment.vertices[1].value, 1U);
  EXPECT_EQ(segment.copies[1], 2U);
  EXPECT_EQ(segment.points_inside, 2U);
  expect_parted(segment, line);
}

TEST(ExtremePointsLaw, SameBytesForAnyNumberOfThreads) {
  const PointSet set = family_points(PointFamily::kGaussian, 6000, 6, 4);
  const ExtremePoints one = extreme_points(set.view(), {.threads = 1});
  const ExtremePoints three = extreme_points(set.view(), {.threads = 3});
  EXPECT_EQ(one.vertices, three.vertices);
  EXPECT_EQ(one.planes, three.planes);
  EXPECT_EQ(rows_of(set, one.vertices), rows_of(set, hull_of(set).vertices));
}

TEST(ExtremePointsExample, AStopRequestLeavesAnAnswer) {
  std::stop_source stop;
  stop.request_stop();
  const PointSet set = family_points(PointFamily::kSphere, 100, 6, 4);
  const ExtremePoints found = extreme_points(set.view(), {.stop = stop.get_token()});
  EXPECT_EQ(found.status, ExtremeStatus::kInterrupted);
  EXPECT_EQ(found.open_points, 100U);
  EXPECT_TRUE(found.vertices.empty());
}

}  // namespace
}  // namespace ndhull
