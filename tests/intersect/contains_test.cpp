// Distances of queries from planes: against one pair at a time, and exact signs on the planes themselves.
#include "approx/planes/contains.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/intersect/intersect_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

TEST(ContainsOracle, DistancesAreThoseOfAllPairs) {
  for (const std::size_t d : {1U, 2U, 5U, 8U, 16U, 20U}) {
    SCOPED_TRACE("d " + std::to_string(d));
    PointSet planes = family_points(PointFamily::kGaussian, 700, d + 1, 1);
    for (std::size_t row = 0; row < planes.rows(); ++row) planes.row(row)[d] -= 2.0;
    const PointSet queries = family_points(PointFamily::kGaussian, 1500, d, 2);
    const std::vector<PlaneDistance> found = distances_to_planes(queries.view(), planes.coordinates);
    ASSERT_EQ(found.size(), queries.rows());
    for (std::size_t query = 0; query < queries.rows(); ++query) {
      long double best = -HUGE_VALL;
      std::size_t best_plane = 0;
      for (std::size_t plane = 0; plane < planes.rows(); ++plane) {
        long double value = planes.row(plane)[d], length_sq = 0.0L;
        for (std::size_t k = 0; k < d; ++k) {
          const long double a = planes.row(plane)[k];
          value += a * queries.row(query)[k];
          length_sq += a * a;
        }
        if (value / std::sqrt(length_sq) <= best) continue;
        best = value / std::sqrt(length_sq);
        best_plane = plane;
      }
      EXPECT_EQ(found[query].plane, best_plane);
      const double roundoff = (0.5 * static_cast<double>(d) + 4.0) * 0x1p-53;
      EXPECT_NEAR(found[query].distance, static_cast<double>(best),
                  roundoff * std::abs(found[query].distance));
    }
  }
}

// Far from the origin planes of several blocks look alike but for rounding.
TEST(ContainsOracle, DistancesAreThoseOfAllPairsWhereRoundingHidesWhichPlaneIsNearest) {
  constexpr std::size_t kPlanes = 600, kDimension = 3;
  PointSet planes = family_points(PointFamily::kGaussian, kPlanes, kDimension + 1, 5);
  for (std::size_t plane = 0; plane < kPlanes; ++plane) {
    const std::span<double> row = planes.row(plane);
    double at_centre = 0.0;
    for (std::size_t k = 0; k < kDimension; ++k) at_centre += row[k] = 1.0 + 1e-3 * row[k];
    row[kDimension] = 2e-8 + 1e-9 * row[kDimension] - 1e6 * at_centre;
  }
  const PointSet queries{kDimension, {1e6, 1e6, 1e6, 1e6, 1e6, 1e6 + 1e-9}, ""};
  const std::vector<PlaneDistance> found = distances_to_planes(queries.view(), planes.coordinates);
  for (std::size_t query = 0; query < queries.rows(); ++query) {
    long double most = -HUGE_VALL;
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      const std::span<const double> row = planes.row(plane);
      __float128 value = row[kDimension];
      long double length_sq = 0.0L;
      for (std::size_t k = 0; k < kDimension; ++k) {
        value += static_cast<__float128>(row[k]) * queries.row(query)[k];
        length_sq += static_cast<long double>(row[k]) * row[k];
      }
      most = std::max(most, static_cast<long double>(value) / std::sqrt(length_sq));
    }
    EXPECT_NEAR(found[query].distance, static_cast<double>(most), 1e-14 * static_cast<double>(most));
  }
}

TEST(ContainsLaw, SignsOnThePlanesAreExact) {
  const double third = 1.0 / 3.0;
  const std::vector<double> planes{1.0, 1.0, 1.0, -1.0, -1.0, 0.0, 0.0, -1.0, 0.0, 3.0, 0.0, -1.0};
  // third is below 1/3 by less than a rounding, so its triple is below 1.
  PointSet queries{3, {third, third, third, 1.0, 0.0, 0.0, 0.0, third, 0.0}, ""};
  queries.coordinates.insert(queries.coordinates.end(), {0.0, std::nextafter(third, 1.0), 0.0});
  queries.coordinates.insert(queries.coordinates.end(), {1.0, 0.0, 0x1p-60});
  const std::vector<PlaneDistance> found = distances_to_planes(queries.view(), planes);
  EXPECT_LT(found[0].distance, 0.0);
  EXPECT_EQ(found[1].distance, 0.0);
  EXPECT_LT(found[2].distance, 0.0);
  EXPECT_GT(found[3].distance, 0.0);
  EXPECT_EQ(found[3].plane, 2U);
  EXPECT_GT(found[4].distance, 0.0);
  EXPECT_EQ(found[4].plane, 0U);
}

TEST(ContainsLaw, DistancesAreDoublesWhereTheValuesOfTheRowsAreNot) {
  // Rows 2^k (3, 4, b) and (-6, 8, b): b and the queries are integers, so the distances are rounded once.
  for (const int row : {-1000, -600, 0, 600, 1000}) {
    for (const int length : {-500, -100, 0, 100, 500}) {
      SCOPED_TRACE("row 2^" + std::to_string(row) + ", length 2^" + std::to_string(length));
      const auto scaled = [&](double a, double b, double c) {
        const int offset = std::min(row + length, 1000);
        return std::vector<double>{std::ldexp(a, row), std::ldexp(b, row),
                                   row + length < -1000 ? 0.0 : std::ldexp(c, offset)};
      };
      std::vector<double> planes = scaled(3.0, 4.0, 0.0);
      const std::vector<double> other = scaled(-6.0, 8.0, 0.0);
      planes.insert(planes.end(), other.begin(), other.end());
      const double unit = std::ldexp(1.0, length);
      const PointSet queries{2, {unit, unit, -7.0 * unit, 2.0 * unit, -unit, -8.0 * unit}, ""};
      const std::vector<PlaneDistance> found = distances_to_planes(queries.view(), planes);
      const std::vector<double> expected{1.4 * unit, 5.8 * unit, -5.8 * unit};
      const std::vector<std::uint32_t> nearest{0, 1, 1};
      for (std::size_t query = 0; query < expected.size(); ++query) {
        EXPECT_NEAR(found[query].distance / unit, expected[query] / unit, 1e-14) << query;
        EXPECT_EQ(found[query].plane, nearest[query]) << query;
      }
    }
  }
}

TEST(ContainsLaw, InputIsNotOutsideItsOuterPlanesAndWhatIsInsideIsInTheHull) {
  for (const DegenerateCase& hard : degenerate_cases(60, 4, 3)) {
    SCOPED_TRACE(hard.description);
    const Hull hull = hull_of(hard.points);
    if (hull.rank < 4) continue;
    const PlaneRows planes = outer_planes(hull, hard.points.view());
    for (const PlaneDistance& point : distances_to_planes(hard.points.view(), planes.values))
      EXPECT_NE(membership_of(point.distance, hull.max_facet_width), Membership::kOutside);
    const PointView interior = PointView::row_major(hull.interior_point.data(), 1, 4);
    const PlaneDistance centre = distances_to_planes(interior, planes.values)[0];
    EXPECT_EQ(membership_of(centre.distance, hull.max_facet_width), Membership::kInside);
  }
}

TEST(ContainsExample, AnswersByDistanceAndWidth) {
  EXPECT_EQ(membership_of(1e-300, 0.1), Membership::kOutside);
  EXPECT_EQ(membership_of(0.0, 0.1), Membership::kWithinWidth);
  EXPECT_EQ(membership_of(-0.1, 0.1), Membership::kInside);
  EXPECT_EQ(membership_of(0.0, 0.0), Membership::kInside);
}

TEST(ContainsExample, BadPlanesAreErrors) {
  const PointSet queries = cube(3).points;
  EXPECT_THROW(distances_to_planes(queries.view(), std::vector<double>{}), Error);
  EXPECT_THROW(distances_to_planes(queries.view(), std::vector<double>(7, 1.0)), Error);
  EXPECT_THROW(distances_to_planes(queries.view(), std::vector<double>{0.0, 0.0, 0.0, 1.0}), Error);
}

TEST(ContainsLaw, ThreadsChangeNothing) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 80, 5, 3));
  const PlaneRows planes = exact_planes(hull);
  const PointSet queries = family_points(PointFamily::kBall, 5000, 5, 4);
  const auto one = distances_to_planes(queries.view(), planes.values, 1);
  const auto four = distances_to_planes(queries.view(), planes.values, 4);
  for (std::size_t query = 0; query < one.size(); ++query) {
    EXPECT_EQ(one[query].distance, four[query].distance);
    EXPECT_EQ(one[query].plane, four[query].plane);
  }
}

}  // namespace
}  // namespace ndhull
