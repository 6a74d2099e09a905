// Distances from hulls against closed forms and optimality, and the greedy choice they make.
#include "approx/reduction/kept_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "approx/geometry/hull_distance.h"
#include "approx/rays/extreme_points.h"
#include "core/portable_random.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

Eigen::MatrixXd columns_of(const PointSet& set) {
  return Eigen::Map<const Eigen::MatrixXd>(set.coordinates.data(), static_cast<Eigen::Index>(set.dimension),
                                           static_cast<Eigen::Index>(set.rows()));
}

TEST(HullDistanceOracle, OfACubeHasAClosedForm) {
  PortableRandom random(5);
  for (std::size_t d = 1; d <= 8; ++d) {
    const Eigen::MatrixXd corners = columns_of(family_points(PointFamily::kCubeCorners, 0, d, 1));
    for (int one = 0; one < 50; ++one) {
      Eigen::VectorXd point(static_cast<Eigen::Index>(d));
      double outside_sq = 0.0;
      for (Eigen::Index k = 0; k < point.size(); ++k) {
        point[k] = 3.0 * random.symmetric();
        const double beyond = std::max(std::abs(point[k]) - 1.0, 0.0);
        outside_sq += beyond * beyond;
      }
      const double expected = std::sqrt(outside_sq);
      const HullDistance found = hull_distance(corners, point);
      EXPECT_GE(found.upper, expected);
      EXPECT_LE(found.lower, expected);
      EXPECT_NEAR(found.upper, expected, 1e-6);
      EXPECT_NEAR(found.lower, expected, 1e-6);
    }
  }
}

TEST(HullDistanceLaw, BoundsMeetAndWeightsMakeTheNearestPoint) {
  for (const std::size_t d : {2U, 5U, 20U, 80U}) {
    for (const std::size_t n : {1U, 3U, 30U, 200U}) {
      const Eigen::MatrixXd hull = columns_of(family_points(PointFamily::kGaussian, n, d, d + n));
      const PointSet queries = family_points(PointFamily::kGaussian, 20, d, 77);
      HullDistance last;
      for (std::size_t row = 0; row < 20; ++row) {
        const Eigen::Map<const Eigen::VectorXd> point(queries.row(row).data(), static_cast<Eigen::Index>(d));
        const HullDistance found = hull_distance(hull, point);
        const double size = std::sqrt(hull.colwise().squaredNorm().maxCoeff());
        EXPECT_LE(found.lower, found.upper);
        EXPECT_LE(found.upper - found.lower, 1e-6 * size);
        EXPECT_GE(found.weights.minCoeff(), 0.0);
        EXPECT_NEAR(found.weights.sum(), 1.0, 1e-14);
        Eigen::VectorXd nearest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(d));
        for (std::size_t k = 0; k < found.places.size(); ++k) {
          nearest += found.weights[static_cast<Eigen::Index>(k)] * hull.col(found.places[k]);
        }
        EXPECT_LE((nearest - point).norm(), found.upper);
        // From a nearest point that was known for fewer columns the same is found.
        if (n < 3) continue;
        const HullDistance begun = hull_distance(hull.leftCols(static_cast<Eigen::Index>(n / 2)), point);
        EXPECT_GE(begun.upper, found.lower);
        EXPECT_NEAR(hull_distance(hull, point, begun).upper, found.upper, 1e-6 * size);
      }
    }
  }
}

TEST(KeepPointsLaw, EveryPointIsWithinTheProvenDistance) {
  for (const PointFamily family : {PointFamily::kSphere, PointFamily::kGaussian, PointFamily::kLattice}) {
    const PointSet set = family_points(family, family == PointFamily::kLattice ? 243 : 300, 5, 2);
    const ExtremePoints extreme = extreme_points(set.view());
    for (const std::size_t count : {1U, 2U, 10U, 25U}) {
      const KeptPoints kept =
          keep_points(set.view(), extreme.vertices, extreme.interior_point, {.count = count});
      ASSERT_EQ(kept.points.size(), count);
      ASSERT_EQ(kept.distances.size(), count);
      EXPECT_TRUE(std::is_sorted(kept.distances.rbegin(), kept.distances.rend()));
      const std::vector<double> all = distances_from_hull(set.view(), kept.points, extreme.interior_point);
      const double furthest = *std::max_element(all.begin(), all.end());
      EXPECT_LE(furthest, kept.distances.back() * (1.0 + 1e-12));
      EXPECT_GE(furthest, kept.lower);
      EXPECT_NEAR(kept.lower, kept.distances.back(), 1e-6 * kept.distances.front());
    }
  }
}

TEST(KeepPointsLaw, ChoosesTheFurthestEachTime) {
  const PointSet set = family_points(PointFamily::kGaussian, 200, 4, 9);
  const ExtremePoints extreme = extreme_points(set.view());
  const KeptPoints kept = keep_points(set.view(), extreme.vertices, extreme.interior_point, {.count = 15});
  for (std::size_t step = 1; step < kept.points.size(); ++step) {
    const std::vector<PointId> before(kept.points.begin(),
                                      kept.points.begin() + static_cast<std::ptrdiff_t>(step));
    const std::vector<double> all = distances_from_hull(set.view(), before, extreme.interior_point);
    const double furthest = *std::max_element(all.begin(), all.end());
    EXPECT_NEAR(all[kept.points[step].value], furthest, 1e-9);
    EXPECT_NEAR(kept.distances[step - 1], furthest, 1e-9);
  }
}

// Squares of such numbers are 0, and infinite.
TEST(KeepPointsLaw, TinyAndHugePointsAreKeptAsTheyAreAtAnySize) {
  const PointSet set = family_points(PointFamily::kGaussian, 200, 4, 9);
  const ExtremePoints extreme = extreme_points(set.view());
  const KeptPoints kept = keep_points(set.view(), extreme.vertices, extreme.interior_point, {.count = 12});
  const std::vector<double> all = distances_from_hull(set.view(), kept.points, extreme.interior_point);
  for (const int exponent : {-700, 700}) {
    PointSet scaled = set;
    std::vector<double> centre = extreme.interior_point;
    for (double& x : scaled.coordinates) x = std::ldexp(x, exponent);
    for (double& x : centre) x = std::ldexp(x, exponent);
    const KeptPoints same = keep_points(scaled.view(), extreme.vertices, centre, {.count = 12});
    EXPECT_EQ(same.points, kept.points);
    ASSERT_EQ(same.distances.size(), kept.distances.size());
    for (std::size_t i = 0; i < kept.distances.size(); ++i)
      EXPECT_EQ(same.distances[i], std::ldexp(kept.distances[i], exponent));
    EXPECT_EQ(same.lower, std::ldexp(kept.lower, exponent));
    const std::vector<double> scaled_all = distances_from_hull(scaled.view(), same.points, centre);
    for (std::size_t row = 0; row < all.size(); ++row)
      EXPECT_EQ(scaled_all[row], std::ldexp(all[row], exponent));
  }
}

TEST(KeepPointsExample, NoVerticesNoChoice) {
  const PointSet set = family_points(PointFamily::kCube, 10, 3, 9);
  EXPECT_TRUE(keep_points(set.view(), {}, std::vector<double>(3, 0.0), {.count = 4}).points.empty());
}

TEST(KeepPointsExample, AllVerticesAreTheWholeHull) {
  const PointSet set = family_points(PointFamily::kCube, 100, 3, 9);
  const ExtremePoints extreme = extreme_points(set.view());
  const KeptPoints kept = keep_points(set.view(), extreme.vertices, extreme.interior_point, {.count = 1000});
  EXPECT_LE(kept.points.size(), extreme.vertices.size());
  EXPECT_LE(kept.distances.back(), 1e-10);
  EXPECT_EQ(kept.lower, 0.0);
}

// Goes on from vertices that are given as the whole choice would, until all others are near enough.
TEST(KeepPointsLaw, GoesOnFromGivenVerticesUntilAllAreNear) {
  const PointSet set = family_points(PointFamily::kSphere, 250, 5, 11);
  const ExtremePoints extreme = extreme_points(set.view());
  const KeptPoints all = keep_points(set.view(), extreme.vertices, extreme.interior_point, {.count = 60});
  std::vector<PointId> reordered(all.points.begin(), all.points.begin() + 20);
  for (const PointId id : extreme.vertices)
    if (std::find(reordered.begin(), reordered.end(), id) == reordered.end()) reordered.push_back(id);
  const double enough = all.distances[49];  // after 50
  const KeptPoints kept = keep_points(set.view(), reordered, extreme.interior_point,
                                      {.count = 1000, .given = 20, .enough = enough, .measures_left = true});
  ASSERT_EQ(kept.points.size(), 50U);
  EXPECT_TRUE(std::equal(kept.points.begin(), kept.points.end(), all.points.begin()));
  const std::vector<double> distances = distances_from_hull(set.view(), kept.points, extreme.interior_point);
  ASSERT_EQ(kept.left.size(), reordered.size());
  for (std::size_t i = 0; i < reordered.size(); ++i) {
    EXPECT_LE(kept.left[i], enough);
    EXPECT_NEAR(kept.left[i], distances[reordered[i].value], 1e-9);
  }
}

}  // namespace
}  // namespace ndhull
