#include "core/search/highest_dots.h"
#include "core/id_rows.h"
#include "core/search/bundle_search.h"
#include "core/search/plane_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "tests/support/fused_dot.h"

namespace ndhull {
namespace {

struct Products {
  std::size_t dimension;
  std::vector<double> points, normals;
};

/// Points on a sphere of radius 1, facets through `dimension` of them only in name: the normals are random,
/// the "own vertices" the highest points along them. `column_scale` multiplies column k by its k-th power.
/// `spread`: of normals around an axis, instead of any.
Products sphere(std::size_t dimension, std::size_t count, std::size_t facets, double column_scale,
                double spread = HUGE_VAL) {
  std::mt19937_64 random(dimension * 1000 + count);
  std::normal_distribution<double> normal;
  Products products{dimension, {}, {}};
  for (std::size_t row = 0; row < count + facets; ++row) {
    std::vector<double> x(dimension);
    double length_sq = 0.0;
    for (double& value : x) {
      value = normal(random);
      length_sq += value * value;
    }
    if (row >= count && spread < HUGE_VAL) {
      for (std::size_t k = 0; k < dimension; ++k) x[k] = spread * x[k] + (k == 0 ? 1.0 : 0.0);
      length_sq = std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
    }
    std::vector<double>& rows = row < count ? products.points : products.normals;
    const double power = row < count ? 1.0 : -1.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      rows.push_back(x[k] / std::sqrt(length_sq) * std::pow(column_scale, power * static_cast<double>(k)));
    }
  }
  return products;
}

void expect_all_products(const Products& products, std::size_t own_count) {
  const std::size_t dimension = products.dimension, facets = products.normals.size() / dimension;
  const std::size_t count = products.points.size() / dimension;
  std::vector<double> low, high, expected, largest(facets);
  std::vector<std::uint32_t> close;
  for (std::size_t facet = 0; facet < facets; ++facet) {
    std::vector<double> dots;
    for (std::size_t row = 0; row < count; ++row) {
      dots.push_back(
          fused_dot(&products.normals[facet * dimension], &products.points[row * dimension], dimension));
    }
    std::sort(dots.begin(), dots.end(), std::greater<>());
    expected.push_back(dots[0]);
    // What growth calls the vertices may be the second highest and below: the highest has to be found.
    const std::size_t first = facet % 2 == 0 ? 0 : std::min<std::size_t>(1, count - 1);
    high.push_back(dots[first]);
    const std::size_t last = std::min(first + std::max<std::size_t>(own_count, 1) - 1, count - 1);
    low.push_back(dots[last]);
    const double least = dots[first] - kCloseProducts * std::abs(dots[first]);
    close.push_back(0);
    for (std::size_t i = first; i <= last; ++i) close.back() += dots[i] >= least ? 1u : 0u;
  }
  for (const bool in_order : {false, true}) {
    const PointGroups groups(dimension, products.points, in_order);
    std::fill(largest.begin(), largest.end(), 0.0);
    highest_dots(groups, products.normals, {low, high, own_count}, largest);
    EXPECT_EQ(largest, expected) << "in order: " << in_order;
    std::fill(largest.begin(), largest.end(), 0.0);
    highest_dots(groups, products.normals, {low, high, 0, close}, largest);
    EXPECT_EQ(largest, expected) << "own vertices counted, in order: " << in_order;
  }
  const PointTree tree(dimension, products.points);
  std::vector<std::uint32_t> order(facets);
  std::iota(order.rbegin(), order.rend(), 0);
  std::fill(largest.begin(), largest.end(), 0.0);
  highest_dots(tree, products.normals, order, {low, high, own_count}, largest);
  EXPECT_EQ(largest, expected) << "in bundles";
  std::fill(largest.begin(), largest.end(), 0.0);
  highest_dots(tree, products.normals, order, {low, high, 0, close}, largest);
  EXPECT_EQ(largest, expected) << "in bundles, own vertices counted";
}

TEST(HighestDotsLaw, TheResultIsThatOfAllProductsDigitForDigit) {
  for (const std::size_t dimension : {1u, 2u, 3u, 5u, 6u, 8u, 16u, 19u}) {
    for (const std::size_t count : {1u, 2u, 15u, 16u, 17u, 300u, 1030u}) {
      for (const double column_scale : {1.0, 1e-3, 1e3}) {
        SCOPED_TRACE(std::to_string(dimension) + "-d, " + std::to_string(count) + " points, " +
                     std::to_string(column_scale));
        const Products products = sphere(dimension, count, 37, column_scale);
        expect_all_products(products, 0);
        expect_all_products(products, std::min(dimension, count - 1));
      }
    }
  }
}

TEST(HighestDotsLaw, DirectionsMayBeNearEachOther) {
  for (const std::size_t dimension : {2u, 3u, 5u, 8u, 19u}) {
    for (const double spread : {0.0, 1e-7, 1e-2, 0.2, 0.6}) {
      for (const double column_scale : {1.0, 1e3}) {
        SCOPED_TRACE(std::to_string(dimension) + "-d, " + std::to_string(spread));
        const Products products = sphere(dimension, 3000, 150, column_scale, spread);
        expect_all_products(products, 0);
        expect_all_products(products, dimension);
      }
    }
  }
}

// How far points reach across a direction follows from their lengths, which are a few levels.
TEST(HighestDotsLaw, PointsMayHaveVeryDifferentLengths) {
  for (const std::size_t dimension : {2u, 5u, 8u}) {
    for (const double spread : {1e-2, 0.2}) {
      for (const double longest : {1.01, 1.5, 30.0}) {
        SCOPED_TRACE(std::to_string(dimension) + "-d, " + std::to_string(spread) + ", " +
                     std::to_string(longest));
        Products products = sphere(dimension, 3000, 150, 1.0, spread);
        std::mt19937_64 random(3);
        std::uniform_real_distribution<double> exponent(0.0, std::log(longest));
        for (std::size_t row = 0; row < products.points.size(); row += dimension) {
          const double length = std::exp(exponent(random));
          for (std::size_t k = 0; k < dimension; ++k) products.points[row + k] *= length;
        }
        expect_all_products(products, 0);
        expect_all_products(products, dimension);
      }
    }
  }
}

// Points that single precision cannot tell from the plane through the own vertices.
TEST(HighestDotsLaw, PointsAHairAboveThePlaneAreFound) {
  for (const std::size_t dimension : {2u, 5u, 8u}) {
    for (const double hair : {0.0, 1e-16, 1e-13, 1e-9, 1e-7, 1e-5}) {
      SCOPED_TRACE(std::to_string(dimension) + "-d, " + std::to_string(hair));
      Products products{dimension, {}, std::vector<double>(dimension, 0.0)};
      products.normals[0] = 1.0;
      std::mt19937_64 random(7);
      std::uniform_real_distribution<double> uniform(-1.0, 1.0);
      for (std::size_t row = 0; row < 600; ++row) {
        products.points.push_back(row < dimension ? 1.0 : row == 399 ? 1.0 + hair : uniform(random));
        for (std::size_t k = 1; k < dimension; ++k) products.points.push_back(uniform(random));
      }
      const std::vector<double> own{1.0};
      std::vector<double> largest{0.0};
      highest_dots(PointGroups(dimension, products.points, false), products.normals, {own, own, dimension},
                   largest);
      EXPECT_EQ(largest[0], 1.0 + hair);
      const std::vector<std::uint32_t> close{static_cast<std::uint32_t>(dimension)};
      highest_dots(PointGroups(dimension, products.points, false), products.normals, {own, own, 0, close},
                   largest);
      EXPECT_EQ(largest[0], 1.0 + hair);
      const std::vector<std::uint32_t> order{0};
      const PointTree tree(dimension, products.points);
      highest_dots(tree, products.normals, order, {own, own, dimension}, largest);
      EXPECT_EQ(largest[0], 1.0 + hair);
      highest_dots(tree, products.normals, order, {own, own, 0, close}, largest);
      EXPECT_EQ(largest[0], 1.0 + hair);
    }
  }
}

TEST(ListedDotsLaw, SmallestAndLargestAreThoseOfTheList) {
  for (const std::size_t dimension : {1u, 2u, 5u, 8u, 19u}) {
    const std::size_t count = 60, facets = 25;
    Products products = sphere(dimension, count, facets, 1.0);
    std::copy_n(products.points.begin(), dimension,
                products.points.begin() + static_cast<std::ptrdiff_t>(dimension));
    IdRows lists;
    std::mt19937_64 random(dimension);
    for (std::size_t facet = 0; facet < facets; ++facet) {
      for (std::size_t i = 0; i <= facet; ++i)
        lists.values.push_back(static_cast<std::uint32_t>(random() % count));
      if (facet == 3) lists.values.insert(lists.values.end(), {0u, 1u});
      lists.end_row();
    }
    std::vector<double> low(facets), high(facets);
    std::vector<std::uint32_t> close(facets);
    listed_dots(dimension, products.normals, products.points, lists, low, high, close);
    for (std::size_t facet = 0; facet < facets; ++facet) {
      std::vector<double> dots;
      for (const std::uint32_t row : lists.row(facet))
        dots.push_back(
            fused_dot(&products.normals[facet * dimension], &products.points[row * dimension], dimension));
      std::sort(dots.begin(), dots.end());
      const double least = dots.back() - kCloseProducts * std::abs(dots.back());
      EXPECT_EQ(low[facet], dots.front());
      EXPECT_EQ(high[facet], dots.back());
      EXPECT_EQ(close[facet], dots.end() - std::lower_bound(dots.begin(), dots.end(), least));
    }
  }
}

TEST(HighestDotsLaw, DuplicatesAndValuesBeyondSinglePrecisionChangeNothing) {
  Products products = sphere(5, 100, 20, 1.0);
  const std::vector<double> once = products.points;
  products.points.insert(products.points.end(), once.begin(), once.end());
  expect_all_products(products, 5);
  for (double& value : products.points) value *= 1e200;
  expect_all_products(products, 5);
  for (double& value : products.points) value *= 0x1p358;  // up to 5.9e307
  expect_all_products(products, 5);
  for (double& value : products.points) value = std::ldexp(value, -1358);
  expect_all_products(products, 5);
  std::fill(products.points.begin(), products.points.end(), 0.0);
  expect_all_products(products, 5);
}

}  // namespace
}  // namespace ndhull
