// Products of directions with many points: the furthest point, and directions turned towards less width.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "core/search/direction_turn.h"
#include "core/search/support.h"

namespace ndhull {
namespace {

constexpr std::size_t kDimension = 5;

double dot(const double* a, const double* b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kDimension; ++k) sum += a[k] * b[k];
  return sum;
}

std::vector<double> unit_vectors(std::size_t count, double scale) {
  std::mt19937_64 random(count);
  std::normal_distribution<double> normal;
  std::vector<double> rows(count * kDimension);
  for (std::size_t row = 0; row < count; ++row) {
    double* x = rows.data() + row * kDimension;
    for (std::size_t k = 0; k < kDimension; ++k) x[k] = normal(random);
    const double length = std::sqrt(dot(x, x));
    for (std::size_t k = 0; k < kDimension; ++k) x[k] *= scale / length;
  }
  return rows;
}

class DirectionProducts : public testing::TestWithParam<double> {};

TEST_P(DirectionProducts, FurthestPointIsThatOfAllProductsInDoublePrecision) {
  const std::vector<double> directions = unit_vectors(50, 1.0);
  for (const std::size_t count : {1u, 15u, 16u, 17u, 1000u}) {
    std::vector<double> rows = unit_vectors(count, GetParam());
    for (std::size_t row = 1; row < count; row += 2) {  // nearly the same point again
      std::copy_n(rows.data() + (row - 1) * kDimension, kDimension, rows.data() + row * kDimension);
      rows[row * kDimension] += 1e-14 * GetParam();
    }
    const SupportTable table(kDimension, rows);
    SupportProducts products;
    for (std::size_t d = 0; d < 50; ++d) {
      const double* direction = directions.data() + d * kDimension;
      double expected = -HUGE_VAL;
      for (std::size_t row = 0; row < count; ++row)
        expected = std::max(expected, dot(direction, rows.data() + row * kDimension));
      double height = 0.0;
      const std::uint32_t row = table.find(direction, products, height);
      EXPECT_EQ(height, expected);
      EXPECT_EQ(dot(direction, rows.data() + row * kDimension), expected);
      const double low = expected - 0.3 * GetParam();
      std::vector<std::uint32_t> above;
      table.rows_above(products, low, table.count(), above);
      EXPECT_TRUE(std::is_sorted(above.begin(), above.end()));
      std::vector<std::uint32_t> of_first;
      table.rows_above(products, low, count / 2, of_first);
      EXPECT_EQ(of_first, std::vector<std::uint32_t>(
                              above.begin(), std::lower_bound(above.begin(), above.end(), count / 2)));
      for (std::uint32_t i = 0; i < count; ++i) {
        const double product = dot(direction, rows.data() + i * kDimension);
        const bool is_there = std::binary_search(above.begin(), above.end(), i);
        EXPECT_TRUE(product < low || is_there);
        EXPECT_TRUE(product > low - 1e-4 * GetParam() || !is_there);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DirectionProducts, testing::Values(1e-200, 1.0, 1e200));

TEST(TurningPoints, WidthIsThatOfTheDirectionAndNoMoreThanAtFirst) {
  for (const std::size_t count : {1u, 7u, 8u, 30u}) {
    const std::vector<double> rows = unit_vectors(4 * count, 1.0), directions = unit_vectors(20, 1.0);
    std::vector<std::uint32_t> facet(count), others(3 * count);
    std::iota(facet.begin(), facet.end(), 0u);
    std::iota(others.begin(), others.end(), static_cast<std::uint32_t>(count));
    TurningPoints points;
    points.assign(kDimension, rows.data(), facet, others);
    const auto width_of = [&](const double* direction) {
      double high = -HUGE_VAL, low = HUGE_VAL;
      for (std::size_t row = 0; row < 4 * count; ++row) {
        const double product = dot(direction, rows.data() + row * kDimension);
        high = std::max(high, product);
        if (row < count) low = std::min(low, product);
      }
      return high - low;
    };
    for (std::size_t d = 0; d < 20; ++d) {
      std::vector<double> direction(directions.begin() + static_cast<std::ptrdiff_t>(d * kDimension),
                                    directions.begin() + static_cast<std::ptrdiff_t>((d + 1) * kDimension));
      const double first = width_of(direction.data());
      const double width = points.turn(12, direction.data());
      EXPECT_NEAR(width, width_of(direction.data()), 1e-14);
      EXPECT_NEAR(dot(direction.data(), direction.data()), 1.0, 1e-14);
      EXPECT_LE(width, first + 1e-14);
      EXPECT_GE(points.tops().size(), 1u);
      for (const std::uint32_t row : points.tops()) EXPECT_LT(row, 4 * count);
    }
  }
}

TEST(TurningPoints, TurnsAThinFacetNearlyFlat) {
  // A square of thickness 0.01 in 5-d, seen at an angle.
  std::vector<double> rows;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 40; ++i)
    for (std::size_t k = 0; k < kDimension; ++k) rows.push_back((k == 0 ? 0.005 : 1.0) * uniform(random));
  std::vector<std::uint32_t> facet(40);
  std::iota(facet.begin(), facet.end(), 0u);
  TurningPoints points;
  points.assign(kDimension, rows.data(), facet, {});
  std::vector<double> direction = {std::sqrt(0.98), 0.1, 0.0, 0.1, 0.0};
  EXPECT_LT(points.turn(200, direction.data()), 0.02);
}

}  // namespace
}  // namespace ndhull
