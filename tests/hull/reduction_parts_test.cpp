// What large inputs are reduced with: the furthest points along directions, an ellipsoid inside the hull.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "approx/reduction/direction_extremes_kernel.h"
#include "approx/reduction/inner_ellipsoid.h"
#include "core/growth/growth.h"
#include "tests/hull/hull_support.h"
#include "tests/prepared_growth.h"

namespace ndhull {
namespace {

/// Products as documented, one after the other.
void raise_one_by_one(const std::vector<float>& columns, std::size_t rank,
                      const std::vector<std::uint32_t>& ids, const std::vector<float>& directions,
                      std::vector<DirectionExtreme>& extremes) {
  for (std::size_t one = 0; one < extremes.size(); ++one) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      float product = 0.0F;
      for (std::size_t k = 0; k < rank; ++k) {
        const float term = directions[one * rank + k] * columns[k * kExtremeTile + i];
        product = product + term;
      }
      if (product > extremes[one].product) extremes[one] = {product, ids[i]};
    }
  }
}

TEST(DirectionExtremesLaw, VectorsFindWhatALoopOverPointsFinds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1.0F, 1.0F);
  std::uniform_int_distribution<int> step(-2, 2);
  for (const std::size_t rank : {1u, 2u, 6u, 16u}) {
    for (const std::size_t directions_count : {1u, 3u, 4u, 7u, 65u}) {
      for (const bool has_ties : {false, true}) {
        std::vector<float> columns(rank * kExtremeTile), directions(rank * directions_count);
        const auto draw = [&] { return has_ties ? static_cast<float>(step(random)) : number(random); };
        for (float& x : directions) x = draw();
        std::vector<DirectionExtreme> found(directions_count, DirectionExtreme{-HUGE_VALF});
        std::vector<DirectionExtreme> expected = found;
        std::uint32_t next = 7;
        for (const std::size_t count :
             {1u, 31u, 128u, 64u, 0u, 33u}) {  // what is behind the last point is old
          for (std::size_t k = 0; k < rank; ++k)
            for (std::size_t i = 0; i < count; ++i) columns[k * kExtremeTile + i] = draw();
          std::vector<std::uint32_t> ids;
          for (std::size_t i = 0; i < count; ++i) ids.push_back(next += 3);
          raise_extremes(columns.data(), rank, ids, directions.data(), found);
          raise_one_by_one(columns, rank, ids, directions, expected);
          for (std::size_t one = 0; one < directions_count; ++one) {
            ASSERT_EQ(found[one].id, expected[one].id) << "rank " << rank << " direction " << one;
            ASSERT_EQ(found[one].product, expected[one].product);
          }
        }
      }
    }
  }
}

/// A hull of the points that has some thousand simplices a dimension.
struct SmallHull {
  Frame frame;
  std::vector<double> coordinates;
  GrowthWork work;

  explicit SmallHull(const PointView& points) {
    frame = prepare_growth(points, coordinates, work);
    work.options.pause_rows = 4000 * frame.rank;
    start_growth(work, frame.simplex, FirstPoints());
    grow(work);
  }
  double reach() const {
    double most = 0.0;
    for (const double y : coordinates) most = std::max(most, std::abs(y));
    return most * static_cast<double>(frame.rank);
  }
  /// The largest product of a simplex' plane with a point, minus 1: negative inside.
  long double gauge(const double* y) const {
    long double highest = -HUGE_VALL;
    for (std::uint32_t row = 0; row < work.complex.row_count; ++row) {
      if (work.complex.state[row] != SimplexState::kLive) continue;
      long double sum = -1.0L;
      for (std::size_t k = 0; k < frame.rank; ++k)
        sum += static_cast<long double>(work.complex.plane(SimplexId{row})[k]) * y[k];
      highest = std::max(highest, sum);
    }
    return highest;
  }
};

std::vector<std::size_t> rows_from(std::size_t first, std::size_t count) {
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), first);
  return rows;
}

// Sums as documented, and that they mean what they say: L z = y - m, the sample round around 0.
TEST(SampleShapeLaw, VectorsSolveWhatALoopSolvesAndTheSampleIsRound) {
  for (const std::size_t dimension : {1u, 2u, 5u, 8u, 16u}) {
    for (const bool turns : {false, true}) {
      PointSet set = family_points(PointFamily::kGaussian, 3000, dimension, 400 + dimension);
      for (std::size_t row = 0; row < set.rows(); ++row) {
        set.row(row)[0] *= 7.0;
        if (turns && dimension > 1) set.row(row)[1] += 2e4 * set.row(row)[0] + 1e6;
      }
      SCOPED_TRACE(set.header);
      const Frame frame = fit_frame(set.view());
      ASSERT_EQ(frame.rank, dimension);
      EXPECT_EQ(frame.is_diagonal, !turns || dimension == 1);
      std::vector<double> y(set.rows() * dimension), z(dimension * kWhitenedPoints), lengths(kWhitenedPoints);
      map_points(set.view(), frame, y.data());
      const SampleShape shape(frame, y.data(), set.rows());
      std::vector<double> squares(dimension, 0.0), sums(dimension, 0.0);
      for (std::size_t begin = 0; begin < set.rows(); begin += kWhitenedPoints) {
        const std::size_t count = std::min(kWhitenedPoints, set.rows() - begin);
        shape.whiten(set.view(), rows_from(begin, count), z.data(), lengths.data());
        for (std::size_t i = 0; i < count; ++i) {
          double length_sq = 0.0;
          std::vector<double> expected(dimension);
          for (std::size_t row = 0; row < dimension; ++row) {
            double sum = -shape.mean()[row];
            for (std::size_t k = 0; k < dimension; ++k) {
              if (frame.is_diagonal && k != row) continue;
              const double term = frame.map[row * dimension + k] * (set.row(begin + i)[k] - frame.centre[k]);
              sum = sum + term;
            }
            for (std::size_t k = 0; k < row; ++k) {
              const double term = shape.factor()[row * dimension + k] * expected[k];
              sum = sum - term;
            }
            expected[row] = sum * (1.0 / shape.factor()[row * dimension + row]);
            const double square = expected[row] * expected[row];
            length_sq = length_sq + square;
            ASSERT_EQ(z[row * kWhitenedPoints + i], expected[row]);
            sums[row] += expected[row];
            squares[row] += square;
          }
          ASSERT_EQ(lengths[i], length_sq);
        }
      }
      for (std::size_t row = 0; row < dimension; ++row) {
        EXPECT_NEAR(sums[row] / 3000.0, 0.0, 1e-6);
        EXPECT_NEAR(squares[row] / 3000.0, 1.0, 1e-6);
      }
    }
  }
}

TEST(InnerEllipsoidLaw, WhatItContainsIsInsideAndSomethingIs) {
  for (const std::size_t dimension : {2u, 3u, 5u, 7u}) {
    for (const PointFamily family : {PointFamily::kGaussian, PointFamily::kBall, PointFamily::kCube}) {
      PointSet set = family_points(family, 3001, dimension, 300 + dimension);
      if (family == PointFamily::kBall)  // a frame that turns
        for (std::size_t row = 0; row < set.rows(); ++row) set.row(row)[1] += 50.0 * set.row(row)[0] + 1e3;
      SCOPED_TRACE(set.header);
      const SmallHull hull(set.view());
      ASSERT_EQ(hull.frame.rank, dimension);
      InnerEllipsoid ellipsoid(SampleShape(hull.frame, hull.coordinates.data(), set.rows()), hull.reach());
      EXPECT_EQ(ellipsoid.contains(set.view(), rows_from(0, 1)), 0U);  // it has no size yet
      ellipsoid.fit(hull.work.complex);
      std::size_t contained = 0;
      for (std::size_t begin = 0; begin < set.rows(); begin += InnerEllipsoid::kPoints) {
        const std::size_t count = std::min(InnerEllipsoid::kPoints, set.rows() - begin);
        const std::uint64_t inside = ellipsoid.contains(set.view(), rows_from(begin, count));
        EXPECT_EQ(count < 64 ? inside >> count : 0, 0U);
        for (std::size_t i = 0; i < count; ++i) {
          EXPECT_EQ(ellipsoid.contains(set.view(), rows_from(begin + i, 1)), inside >> i & 1);
          if ((inside >> i & 1) == 0) continue;
          ++contained;
          EXPECT_LT(hull.gauge(hull.coordinates.data() + (begin + i) * dimension), -1e-9L);
        }
      }
      EXPECT_GT(contained, 0U);
      EXPECT_LT(contained, set.rows());
    }
  }
}

}  // namespace
}  // namespace ndhull
