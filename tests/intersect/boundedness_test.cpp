// When normals bound a region: closed forms, all candidate directions in 3-d, and completed selections.
#include "approx/geometry/boundedness.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

std::vector<double> normals_of(const Hull& hull) {
  std::vector<double> normals;
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
    const auto normal = hull.normal(FacetId{id});
    normals.insert(normals.end(), normal.begin(), normal.end());
  }
  return normals;
}

std::vector<double> rows_of(const std::vector<double>& normals, std::size_t d,
                            const std::vector<std::uint32_t>& ids) {
  std::vector<double> rows;
  for (const std::uint32_t id : ids)
    rows.insert(rows.end(), normals.begin() + id * static_cast<std::ptrdiff_t>(d),
                normals.begin() + (id + 1) * static_cast<std::ptrdiff_t>(d));
  return rows;
}

double largest_product(const std::vector<double>& normals, const std::vector<double>& direction) {
  double largest = -HUGE_VAL;
  for (std::size_t at = 0; at < normals.size(); at += direction.size()) {
    const auto row = normals.begin() + static_cast<std::ptrdiff_t>(at);
    const double length =
        std::sqrt(std::inner_product(row, row + static_cast<std::ptrdiff_t>(direction.size()), row, 0.0));
    largest = std::max(largest, std::inner_product(direction.begin(), direction.end(), row, 0.0) / length);
  }
  return largest;
}

void expect_open(const std::vector<double>& normals, std::size_t d) {
  const Boundedness open = find_open_direction(normals, d);
  ASSERT_FALSE(open.bounded);
  ASSERT_EQ(open.direction.size(), d);
  EXPECT_NEAR(std::inner_product(open.direction.begin(), open.direction.end(), open.direction.begin(), 0.0),
              1.0, 1e-14);
  EXPECT_LE(largest_product(normals, open.direction), 1e-12);
  EXPECT_NEAR(open.margin, largest_product(normals, open.direction), 1e-14);
}

// A part of them is tried first, which may lack the one that closes the rest.
TEST(BoundednessExample, OneOfVeryManyNormalsCloses) {
  constexpr std::size_t kDimension = 4, kCount = 100'000;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> normals(kDimension * kCount);
  for (double& x : normals) x = normal(random);
  EXPECT_TRUE(find_open_direction(normals, kDimension).bounded);
  for (std::size_t row = 0; row < kCount; ++row) {
    double& last = normals[row * kDimension + kDimension - 1];
    last = 0.1 + std::abs(last);
  }
  expect_open(normals, kDimension);
  for (const std::size_t row : {std::size_t{0}, std::size_t{1}, kCount / 2 + 1, kCount - 1}) {
    std::vector<double> closed = normals;
    closed[row * kDimension + kDimension - 1] = -1e3;
    EXPECT_TRUE(find_open_direction(closed, kDimension).bounded) << row;
    std::vector<std::uint32_t> others(kCount - 1);
    for (std::size_t k = 0; k < others.size(); ++k)
      others[k] = static_cast<std::uint32_t>(k < row ? k : k + 1);
    EXPECT_FALSE(find_open_direction_of(closed, kDimension, others).bounded) << row;
  }
}

TEST(BoundednessExample, CubesNeedAllTheirSides) {
  for (std::size_t d = 1; d <= 10; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    std::vector<double> normals;
    for (std::size_t k = 0; k < 2 * d; ++k) {
      for (std::size_t j = 0; j < d; ++j) normals.push_back(j != k / 2 ? 0.0 : k % 2 == 0 ? 3.0 : -0.5);
    }
    EXPECT_TRUE(find_open_direction(normals, d).bounded);
    for (std::size_t k = 0; k < 2 * d; ++k) {
      std::vector<std::uint32_t> others;
      for (std::uint32_t id = 0; id < 2 * d; ++id) {
        if (id != k) others.push_back(id);
      }
      expect_open(rows_of(normals, d, others), d);
    }
  }
}

TEST(BoundednessExample, SlabsAndNothingAreOpen) {
  expect_open({0.0, 0.0, 1.0, 0.0, 0.0, -1.0}, 3);
  expect_open({1.0, 2.0, 3.0}, 3);
  const Boundedness none = find_open_direction({}, 4);
  EXPECT_FALSE(none.bounded);
  EXPECT_EQ(none.margin, 0.0);
}

// Where the open cone is no more than a ray between two planes, it is the cross product of their normals.
TEST(BoundednessOracle, AllCrossProductsInThreeDimensionsAgree) {
  std::mt19937_64 random(20240602);
  std::uniform_int_distribution<int> small(-2, 2);
  std::size_t bounded = 0;
  for (int round = 0; round < 500; ++round) {
    Eigen::Matrix3Xd normals(3, 4 + round % 5);
    do {
      for (double& value : normals.reshaped()) value = small(random);
    } while (normals.colwise().norm().minCoeff() == 0.0);
    bool expected = Eigen::FullPivLU<Eigen::MatrixXd>(normals).rank() == 3;
    for (Eigen::Index i = 0; i < normals.cols(); ++i) {
      for (Eigen::Index j = 0; j < normals.cols(); ++j) {
        const Eigen::Vector3d direction = normals.col(i).cross(normals.col(j));
        if (direction.norm() > 0.0) expected &= (normals.transpose() * direction).maxCoeff() > 0.0;
      }
    }
    const std::vector<double> rows(normals.data(), normals.data() + normals.size());
    EXPECT_EQ(find_open_direction(rows, 3).bounded, expected) << "round " << round;
    bounded += expected ? 1 : 0;
    if (!expected) expect_open(rows, 3);
  }
  EXPECT_GT(bounded, 50U);
  EXPECT_LT(bounded, 450U);
}

TEST(BoundednessLaw, AllFacetsOfAHullBoundIt) {
  for (const DegenerateCase& hard : degenerate_cases(60, 4, 5)) {
    SCOPED_TRACE(hard.description);
    const Hull hull = hull_of(hard.points);
    EXPECT_TRUE(find_open_direction(normals_of(hull), hull.dimension, hull.subspace_equations).bounded);
  }
  for (const double thickness : {1e-6, 1e-10, 1e-13}) {
    SCOPED_TRACE("lens of thickness " + std::to_string(thickness));
    PointSet lens = family_points(PointFamily::kSphere, 200, 4, 3);
    const std::vector<double> thin{1.0, 1.0, 1.0, thickness};
    lens = axis_scaled(lens, thin);
    const Hull hull = hull_of(lens);
    EXPECT_TRUE(find_open_direction(normals_of(hull), 4).bounded);
  }
}

TEST(BoundednessLaw, CompletedSelectionsAreBoundedAndNoneOfTheAddedCanBeSpared) {
  for (std::size_t d = 2; d <= 7; ++d) {
    const Hull hull = hull_of(family_points(PointFamily::kSphere, d < 6 ? 60 : 30, d, d));
    const std::vector<double> normals = normals_of(hull);
    std::mt19937_64 random(d);
    for (const std::size_t count : {0U, 1U, 2U, 4U, 6U, 9U}) {
      SCOPED_TRACE("d " + std::to_string(d) + ", selected " + std::to_string(count));
      std::vector<std::uint32_t> selected(hull.facet_count());
      std::iota(selected.begin(), selected.end(), 0U);
      std::shuffle(selected.begin(), selected.end(), random);
      selected.resize(count);
      const std::vector<std::uint32_t> added = complete_to_bounded(normals, d, selected);
      EXPECT_EQ(added, complete_to_bounded(normals, d, selected));
      std::vector<std::uint32_t> together = selected;
      together.insert(together.end(), added.begin(), added.end());
      EXPECT_TRUE(find_open_direction(rows_of(normals, d, together), d).bounded);
      for (std::size_t k = 0; k < added.size(); ++k) {
        std::vector<std::uint32_t> fewer = together;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(count + k));
        EXPECT_FALSE(find_open_direction(rows_of(normals, d, fewer), d).bounded);
      }
      if (count <= 1) {
        EXPECT_EQ(together.size(), d + 1);  // no fewer bound anything
      }
      EXPECT_LE(added.size(), d + 1);
    }
  }
}

// They are priced in parts of 4,096, and an even part of more than 32,768 says what is even.
TEST(BoundednessLaw, AmongVeryManyNormalsCompletionsAreAsSmall) {
  const std::size_t d = 6;
  const Hull hull = hull_of(rbox("400 s D6 t1"));
  ASSERT_GT(hull.facet_count(), 32'768U);
  for (const std::size_t count : {0U, 1U, 4U, 12U}) {
    SCOPED_TRACE("selected " + std::to_string(count));
    std::vector<std::uint32_t> selected(count);
    for (std::size_t k = 0; k < count; ++k) selected[k] = static_cast<std::uint32_t>(1000 * k);
    const std::vector<std::uint32_t> added = complete_to_bounded(hull.normals(), d, selected);
    std::vector<std::uint32_t> together = selected;
    together.insert(together.end(), added.begin(), added.end());
    const std::vector<double> normals = normals_of(hull);
    EXPECT_TRUE(find_open_direction(rows_of(normals, d, together), d).bounded);
    EXPECT_TRUE(std::is_sorted(added.begin(), added.end()));
    if (count <= 1) {
      EXPECT_EQ(together.size(), d + 1);
    } else {
      EXPECT_LE(added.size(), d);
    }
    for (std::size_t k = 0; k < added.size(); ++k) {
      std::vector<std::uint32_t> fewer = together;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(count + k));
      EXPECT_FALSE(find_open_direction(rows_of(normals, d, fewer), d).bounded);
    }
  }
}

/// The fewest rows that complete the selection, by trying all sets of 0, 1, 2 .. rows.
std::size_t fewest_added(const std::vector<double>& normals, std::size_t d,
                         const std::vector<std::uint32_t>& selected) {
  const std::size_t rows = normals.size() / d;
  for (std::size_t count = 0;; ++count) {
    std::vector<bool> chosen(rows, false);
    std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(count), true);
    do {
      std::vector<std::uint32_t> together = selected;
      for (std::uint32_t id = 0; id < rows; ++id) {
        if (chosen[id]) together.push_back(id);
      }
      if (find_open_direction(rows_of(normals, d, together), d).bounded) return count;
    } while (std::prev_permutation(chosen.begin(), chosen.end()));
  }
}

TEST(BoundednessOracle, CompletionsAreSeldomLargerThanTheSmallest) {
  std::size_t extra = 0, cases = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Hull hull = hull_of(family_points(PointFamily::kGaussian, 14, 3, seed));
    const std::vector<double> normals = normals_of(hull);
    for (std::uint32_t count = 1; count <= 4; ++count, ++cases) {
      std::vector<std::uint32_t> selected(count);
      std::iota(selected.begin(), selected.end(), 0U);
      const std::size_t added = complete_to_bounded(normals, 3, selected).size();
      const std::size_t fewest = fewest_added(normals, 3, selected);
      EXPECT_LE(added, fewest + 1) << "seed " << seed << ", selected " << count;
      extra += added - fewest;
    }
  }
  EXPECT_LE(10 * extra, cases);
}

// Merging leaves the sides of a cube parallel up to 1e-12. Four of them bound a region by that, 1e12 times
// the cube.
TEST(BoundednessExample, RoundingOfACubesSidesBoundsNothing) {
  const std::vector<double> sides{1.0,    5e-13, -6e-13, -1.0,  2e-13,  4e-13, 6e-13,  1.0,   6e-13,
                                  -6e-13, -1.0,  1e-12,  2e-13, -4e-13, 1.0,   -3e-13, 1e-13, -1.0};
  const std::vector<std::uint32_t> four{0, 1, 2, 3}, expected{4, 5};
  EXPECT_EQ(complete_to_bounded(sides, 3, four), expected);
  const std::vector<std::uint32_t> all{0, 1, 2, 3, 4, 5};
  EXPECT_FALSE(find_open_direction_of(sides, 3, four).bounded);
  EXPECT_TRUE(find_open_direction_of(sides, 3, all).bounded);
  EXPECT_FALSE(find_open_direction_of(sides, 3, {}).bounded);
}

TEST(BoundednessExample, CubesAreCompletedWithTheSidesThatAreMissing) {
  std::vector<double> normals;
  for (std::size_t k = 0; k < 10; ++k) {
    for (std::size_t j = 0; j < 5; ++j) normals.push_back(j != k / 2 ? 0.0 : k % 2 == 0 ? 1.0 : -1.0);
  }
  const std::vector<std::uint32_t> selected{1, 2, 3, 8}, expected{0, 4, 5, 6, 7, 9};
  EXPECT_EQ(complete_to_bounded(normals, 5, selected), expected);
  EXPECT_TRUE(
      complete_to_bounded(normals, 5, std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}).empty());
}

TEST(BoundednessExample, FlatHullsAreJudgedInTheirSubspace) {
  const Hull hull = hull_of(embedded(cube(3).points, 5, 9));
  const std::vector<double> normals = normals_of(hull);
  EXPECT_FALSE(find_open_direction(normals, 5).bounded);
  EXPECT_TRUE(find_open_direction(normals, 5, hull.subspace_equations).bounded);
  const std::vector<std::uint32_t> selected{0, 1, 2};
  const Boundedness open = find_open_direction(rows_of(normals, 5, selected), 5, hull.subspace_equations);
  EXPECT_FALSE(open.bounded);
  EXPECT_LE(open.margin, 1e-12);
  for (std::size_t row = 0; row < 2; ++row) {  // the direction stays in the subspace
    const double* equation = hull.subspace_equations.data() + row * 6;
    EXPECT_NEAR(std::inner_product(equation, equation + 5, open.direction.begin(), 0.0), 0.0, 1e-14);
  }
  EXPECT_EQ(complete_to_bounded(normals, 5, selected, hull.subspace_equations).size(), 3U);
}

}  // namespace
}  // namespace ndhull
