// Points that span less than their space, few points, and the ways points may lie in memory.
#include <cmath>

#include "core/error.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

/// Every input point satisfies the equations, which are orthonormal, and the facets' normals lie in the flat.
/// Distances are compared with the rounding of coordinates as large as the input's.
void expect_in_flat(const Hull& hull, const PointSet& set) {
  double largest = 0.0;
  for (const double value : set.coordinates) largest = std::max(largest, std::abs(value));
  const std::size_t d = hull.dimension, equations = d - hull.rank;
  const double tolerance = 64.0 * static_cast<double>(d) * 0x1p-53;
  ASSERT_EQ(hull.subspace_equations.size(), equations * (d + 1));
  const auto equation = [&](std::size_t row) {
    return std::span(hull.subspace_equations).subspan(row * (d + 1), d + 1);
  };
  const auto dot = [d](std::span<const double> a, std::span<const double> b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < d; ++k) sum += a[k] * b[k];
    return sum;
  };
  for (std::size_t row = 0; row < equations; ++row) {
    for (std::size_t other = 0; other <= row; ++other) {
      EXPECT_NEAR(dot(equation(row), equation(other)), row == other ? 1.0 : 0.0, tolerance);
    }
    double furthest = 0.0;
    for (std::size_t i = 0; i < set.rows(); ++i) {
      furthest = std::max(furthest, std::abs(dot(equation(row), set.row(i)) + equation(row)[d]));
    }
    EXPECT_LE(furthest, tolerance * largest) << "equation " << row;
    for (std::uint32_t facet = 0; facet < hull.facet_count(); ++facet) {
      ASSERT_NEAR(dot(equation(row), hull.normal(FacetId{facet})), 0.0, tolerance) << "facet " << facet;
    }
  }
}

std::string place(std::size_t rank, std::size_t d) {
  return "rank " + std::to_string(rank) + " in " + std::to_string(d) + "-d";
}

TEST(FlatLaw, PointsInASubspaceHaveTheHullOfTheSubspace) {
  for (std::size_t d = 2; d <= 7; ++d) {
    for (std::size_t rank = 1; rank < d; ++rank) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("gaussian, n 25, " + place(rank, d) + ", seed " + std::to_string(seed));
        const PointSet inside = family_points(PointFamily::kGaussian, 25, rank, seed);
        const Hull expected = hull_of(inside);
        PointSet set = embedded(inside, d, seed + 10);
        if (seed == 2) set = moved(set, std::vector<double>(d, 5.0));
        const Hull hull = hull_of(set);
        EXPECT_EQ(hull.rank, rank);
        EXPECT_EQ(facet_sets(hull), facet_sets(expected));
        EXPECT_NEAR(hull.volume, expected.volume, 1e-9 * expected.volume);
        EXPECT_NEAR(hull.area, expected.area, 1e-9 * expected.area);
        EXPECT_EQ(hull.points_outside, 0U);
        expect_sound(hull, set);
        expect_in_flat(hull, set);
      }
    }
  }
}

TEST(FlatLaw, StretchedAxesLeaveRankAndFacets) {
  for (std::size_t d = 3; d <= 7; ++d) {
    for (std::size_t rank = 1; rank < d; ++rank) {
      SCOPED_TRACE("gaussian, n 20, " + place(rank, d) + ", seed 4, columns times 1e-6, 1, 1e6");
      const PointSet inside = family_points(PointFamily::kGaussian, 20, rank, 4);
      std::vector<double> factors(d);
      for (std::size_t k = 0; k < d; ++k)
        factors[k] = std::pow(10.0, 6.0 * (static_cast<double>(k % 3) - 1.0));
      const PointSet set = axis_scaled(embedded(inside, d, 40), factors);
      const Hull hull = hull_of(set);
      EXPECT_EQ(hull.rank, rank);
      EXPECT_EQ(facet_sets(hull), facet_sets(hull_of(inside)));
      expect_sound(hull, set);
    }
  }
}

/// Far from the origin what was flat is so to the rounding of its coordinates only, and points that are
/// inside within the flat can be above planes.
TEST(FlatRegression, FarFromTheOriginNoPointIsAboveAPlane) {
  for (std::size_t d = 3; d <= 7; ++d) {
    for (std::size_t rank = 2; rank < d; ++rank) {
      for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("gaussian on a grid, n 100, " + place(rank, d) + ", seed " + std::to_string(seed));
        PointSet inside = family_points(PointFamily::kGaussian, 100, rank, seed);
        for (double& x : inside.coordinates) x = std::round(2.0 * x);  // many on a plane
        PointSet set = embedded(inside, d, seed);
        for (double& x : set.coordinates) x += 1e10;
        const Hull hull = hull_of(set);
        EXPECT_EQ(hull.rank, rank);
        EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
        expect_sound(hull_of(set, {.triangulate = true}), set);
      }
    }
  }
}

// A column whose digits are nearly used up by an offset says nothing about how rough the others are.
TEST(FlatRegression, ARoughColumnHidesNoOther) {
  const PointSet set = family_points(PointFamily::kGaussian, 500, 5, 1);
  for (const double offset : {1e14, 1e15, 1e16}) {
    PointSet moved = set;
    for (std::size_t row = 0; row < set.rows(); ++row) moved.row(row)[0] += offset;
    const Hull hull = hull_of(moved);
    EXPECT_GE(hull.rank, offset == 1e14 ? 5U : 4U) << offset;
  }
}

TEST(FlatExample, CubesInSubspacesAreCubes) {
  for (std::size_t d = 2; d <= 7; ++d) {
    for (std::size_t rank = 1; rank < d; ++rank) {
      SCOPED_TRACE(place(rank, d));
      const NamedPolytope known = cube(rank);
      const PointSet set = embedded(known.points, d, rank);
      const Hull hull = hull_of(set);
      EXPECT_EQ(hull.rank, rank);
      EXPECT_EQ(hull.facet_count(), known.facets);
      EXPECT_EQ(hull.vertices.size(), known.vertices);
      EXPECT_NEAR(hull.volume, *known.volume, 1e-9 * *known.volume);
      expect_sound(hull, set);
      expect_in_flat(hull, set);
    }
  }
}

TEST(FlatExample, ConstantColumnsAreLeftOut) {
  for (std::size_t d = 2; d <= 6; ++d) {
    PointSet set = family_points(PointFamily::kSphere, 40, d, 3);
    for (std::size_t i = 0; i < set.rows(); ++i) set.row(i)[d / 2] = 0.1;
    const Hull hull = hull_of(set);
    EXPECT_EQ(hull.rank, d - 1);
    expect_sound(hull, set);
    expect_in_flat(hull, set);
  }
}

TEST(FlatExample, EqualPointsAreOneVertex) {
  for (std::size_t d = 1; d <= 7; ++d) {
    for (const std::size_t n : {1U, 2U, 50U}) {
      const PointSet set{d, std::vector<double>(n * d, 0.1), {}};
      const Hull hull = hull_of(set);
      SCOPED_TRACE(std::to_string(n) + " equal points, d " + std::to_string(d));
      EXPECT_EQ(hull.status, HullStatus::kComplete);
      EXPECT_EQ(hull.rank, 0U);
      expect_sound(hull, set);
      expect_in_flat(hull, set);
    }
  }
}

TEST(FlatExample, FewPointsAreASimplex) {
  for (std::size_t d = 1; d <= 7; ++d) {
    for (std::size_t n = 2; n <= d; ++n) {
      SCOPED_TRACE("gaussian, n " + std::to_string(n) + ", d " + std::to_string(d) + ", seed 8");
      const PointSet set = family_points(PointFamily::kGaussian, n, d, 8);
      const Hull hull = hull_of(set);
      EXPECT_EQ(hull.rank, n - 1);
      EXPECT_EQ(hull.facet_count(), n);
      EXPECT_EQ(hull.vertices.size(), n);
      expect_sound(hull, set);
      expect_in_flat(hull, set);
    }
  }
}

TEST(FlatExample, OnALineTheHullIsASegment) {
  const PointSet set{1, {3.0, -2.0, 0.5, 7.0, -2.0, 7.0}, {}};
  const Hull hull = hull_of(set);
  EXPECT_EQ(hull.rank, 1U);
  ASSERT_EQ(hull.facet_count(), 2U);
  EXPECT_DOUBLE_EQ(hull.volume, 9.0);
  expect_sound(hull, set);
  EXPECT_EQ(hull.vertices_of(FacetId{0}).size(), 1U);
  EXPECT_EQ(hull.vertices_of(FacetId{1}).size(), 1U);
  EXPECT_EQ(hull.normal(FacetId{0})[0], -hull.normal(FacetId{1})[0]);
  EXPECT_EQ(hull.neighbours_of(FacetId{0})[0], FacetId{1});
}

TEST(PointViewMetamorphic, ColumnMajorPointsHaveTheSameHull) {
  for (std::size_t d = 1; d <= 7; ++d) {
    const std::size_t n = 30;
    const PointSet set = family_points(PointFamily::kGaussian, n, d, 9);
    std::vector<double> columns(n * d);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < d; ++k) columns[k * n + i] = set.row(i)[k];
    }
    const Hull hull = hull_of(set);
    const Hull same = convex_hull({columns.data(), n, d, ScalarType::kFloat64, 1, n});
    EXPECT_EQ(facet_sets(same), facet_sets(hull)) << "d " << d;
    EXPECT_EQ(same.volume, hull.volume) << "d " << d;
    EXPECT_EQ(same.max_facet_width, hull.max_facet_width) << "d " << d;
  }
}

TEST(PointViewMetamorphic, RowsWithAGapAndSelectedColumnsHaveTheSameHull) {
  const PointSet set = family_points(PointFamily::kGaussian, 60, 4, 10);
  std::vector<double> wide(60 * 11, std::nan(""));
  for (std::size_t i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < 4; ++k) wide[i * 11 + 2 * k] = set.row(i)[k];
  }
  const Hull same = convex_hull({wide.data(), 60, 4, ScalarType::kFloat64, 11, 2});
  EXPECT_EQ(facet_sets(same), facet_sets(hull_of(set)));
}

TEST(PointViewMetamorphic, FloatsHaveTheHullOfTheSameDoubles) {
  for (std::size_t d = 1; d <= 7; ++d) {
    const std::size_t n = 40;
    const PointSet set =
        generate_points({.dimension = d, .count = n, .seed = 5, .scalar = ScalarType::kFloat32});
    const std::vector<float> floats(set.coordinates.begin(), set.coordinates.end());
    std::vector<float> columns(n * d);
    for (std::size_t i = 0; i < n * d; ++i) columns[(i % d) * n + i / d] = floats[i];
    const Hull hull = hull_of(set);
    const PointView rows = PointView::row_major(floats.data(), n, d);
    const PointView fortran{columns.data(), n, d, ScalarType::kFloat32, 1, n};
    for (const PointView& view : {rows, fortran}) {
      const Hull same = convex_hull(view);
      EXPECT_EQ(facet_sets(same), facet_sets(hull)) << "d " << d;
      EXPECT_EQ(same.volume, hull.volume) << "d " << d;
      expect_sound(same, view);
    }
  }
}

ErrorCode refusal(const PointSet& set, std::size_t rows) {
  try {
    convex_hull(PointView::row_major(set.coordinates.data(), rows, set.dimension));
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()), "");
    return error.code();
  }
  ADD_FAILURE() << "accepted";
  return ErrorCode::kUsage;
}

TEST(HullExample, BadInputIsRefusedWithItsCode) {
  EXPECT_EQ(refusal({3, {}, {}}, 0), ErrorCode::kEmptyInput);
  EXPECT_EQ(refusal({0, {1.0}, {}}, 1), ErrorCode::kDimensionTooLow);
  PointSet set = family_points(PointFamily::kGaussian, 20, 3, 1);
  set.coordinates[7] = std::nan("");
  EXPECT_EQ(refusal(set, 20), ErrorCode::kNotFinite);
  set.coordinates[7] = -HUGE_VAL;
  EXPECT_EQ(refusal(set, 20), ErrorCode::kNotFinite);
  EXPECT_EQ(refusal(family_points(PointFamily::kGaussian, 40, kMaxRank + 1, 1), 40),
            ErrorCode::kDimensionTooHigh);
}

TEST(HullExample, TheHighestRankIsHulled) {
  const NamedPolytope known = simplex(kMaxRank);
  const PointSet set = embedded(known.points, kMaxRank + 4, 3);
  const Hull hull = hull_of(set);
  EXPECT_EQ(hull.rank, kMaxRank);
  EXPECT_EQ(hull.facet_count(), kMaxRank + 1);
  expect_sound(hull, set);
}

}  // namespace
}  // namespace ndhull
