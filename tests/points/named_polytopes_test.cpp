#include "tests/support/named_polytopes.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <set>

#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Matrix matrix_of(const PointSet& set) {
  return Eigen::Map<const Matrix>(set.coordinates.data(), static_cast<Eigen::Index>(set.rows()),
                                  static_cast<Eigen::Index>(set.dimension));
}

// Affine rank: pivots of the centred rows above 1e-10 of the largest. The sets here have either exact
// coordinates or condition numbers far below that.
std::size_t affine_rank(const PointSet& set) {
  Matrix rows = matrix_of(set);
  rows.rowwise() -= rows.colwise().mean().eval();
  Eigen::ColPivHouseholderQR<Matrix> factors(rows);
  factors.setThreshold(1e-10);
  return static_cast<std::size_t>(factors.rank());
}

std::set<std::vector<double>> distinct_rows(const PointSet& set) {
  std::set<std::vector<double>> distinct;
  for (std::size_t i = 0; i < set.rows(); ++i) distinct.emplace(set.row(i).begin(), set.row(i).end());
  return distinct;
}

void expect_counts(const NamedPolytope& polytope, std::size_t points, std::size_t dimension, std::size_t rank,
                   std::uint64_t facets) {
  EXPECT_EQ(polytope.points.rows(), points) << polytope.name;
  EXPECT_EQ(polytope.points.dimension, dimension) << polytope.name;
  EXPECT_EQ(polytope.rank, rank) << polytope.name;
  EXPECT_EQ(polytope.facets, facets) << polytope.name;
}

TEST(CyclicFacetCount, IsTheUpperBound) {
  EXPECT_EQ(cyclic_facet_count(30, 6), 3250U);
  EXPECT_EQ(cyclic_facet_count(30, 8), 17250U);
  EXPECT_EQ(cyclic_facet_count(25, 12), 35700U);
  EXPECT_EQ(cyclic_facet_count(9, 1), 2U);
  EXPECT_EQ(cyclic_facet_count(9, 2), 9U);
  EXPECT_EQ(cyclic_facet_count(9, 3), 14U);
  for (std::uint64_t d = 1; d < 12; ++d) EXPECT_EQ(cyclic_facet_count(d + 1, d), d + 1) << d;
}

TEST(NamedPolytopesLaw, PointsAreDistinctAndSpanTheRank) {
  for (const NamedPolytope& polytope : small_named_polytopes()) {
    SCOPED_TRACE(polytope.name);
    EXPECT_EQ(affine_rank(polytope.points), polytope.rank);
    EXPECT_EQ(distinct_rows(polytope.points).size(), polytope.points.rows());
    EXPECT_LE(polytope.vertices, polytope.points.rows());
    EXPECT_GT(polytope.vertices, polytope.rank);
    EXPECT_GT(polytope.facets, polytope.rank);
    EXPECT_EQ(polytope.points.header, polytope.name);
  }
}

TEST(NamedPolytopes, HaveThePublishedCounts) {
  expect_counts(cube(5), 32, 5, 5, 10);
  expect_counts(cross_polytope(6), 12, 6, 6, 64);
  expect_counts(simplex(7), 8, 7, 7, 8);
  expect_counts(cell_24(), 24, 4, 4, 24);
  expect_counts(cell_600(), 120, 4, 4, 600);
  expect_counts(cell_120(), 600, 4, 4, 120);
  expect_counts(permutahedron(5), 120, 5, 4, 30);
  expect_counts(birkhoff(4), 24, 16, 9, 16);
  expect_counts(cyclic_trigonometric(30, 6), 30, 6, 6, 3250);
  expect_counts(moment_curve(9, 5), 9, 5, 5, 30);
  expect_counts(grid(3, 5), 243, 5, 5, 10);
  expect_counts(cut_polytope(5), 16, 10, 10, 56);
  expect_counts(cut_polytope(6), 32, 15, 15, 368);
  expect_counts(linear_ordering(5), 120, 20, 10, 40);
  expect_counts(product_of_simplices(3, 4), 20, 7, 7, 9);
}

TEST(RegularPolytopes, VerticesHaveOneNormAndTheRightNumberOfNearestNeighbours) {
  struct Regular {
    NamedPolytope polytope;
    std::size_t neighbours;
  };
  for (const Regular& regular : {Regular{cell_24(), 8}, Regular{cell_600(), 12}, Regular{cell_120(), 4}}) {
    SCOPED_TRACE(regular.polytope.name);
    const Matrix rows = matrix_of(regular.polytope.points);
    const Eigen::VectorXd distances = (rows.rowwise() - rows.row(0)).rowwise().norm();
    const double nearest = distances.tail(distances.size() - 1).minCoeff();
    EXPECT_EQ(static_cast<std::size_t>((distances.array() < nearest + 1e-9).count()), regular.neighbours + 1);
    EXPECT_NEAR((rows.rowwise().norm().array() - rows.row(0).norm()).abs().maxCoeff(), 0.0, 1e-14);
  }
}

TEST(RandomOrthogonal, RowsAreOrthonormal) {
  for (const Eigen::Index d : {1, 2, 5, 16}) {
    const std::vector<double> values = random_orthogonal(static_cast<std::size_t>(d), 3);
    const Matrix matrix = Eigen::Map<const Matrix>(values.data(), d, d);
    EXPECT_LE((matrix * matrix.transpose() - Matrix::Identity(d, d)).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(DegeneraciesLaw, TransformsDoWhatTheySay) {
  const PointSet set = cube(4).points;
  EXPECT_EQ(with_duplicates(set, 5, 1).rows(), 21U);
  EXPECT_EQ(distinct_rows(with_duplicates(set, 5, 1)), distinct_rows(set));
  EXPECT_EQ(distinct_rows(mirrored(set, 2)), distinct_rows(set));
  EXPECT_EQ(with_mirror_images(set, 2).rows(), 32U);
  EXPECT_EQ(mirrored(mirrored(set, 1), 1).coordinates, set.coordinates);

  std::vector<std::size_t> old_of_new;
  const PointSet permuted = permuted_rows(set, 5, &old_of_new);
  EXPECT_NE(permuted.coordinates, set.coordinates);
  for (std::size_t i = 0; i < set.rows(); ++i) {
    EXPECT_TRUE(std::equal(permuted.row(i).begin(), permuted.row(i).end(), set.row(old_of_new[i]).begin()));
  }

  const PointSet filled = with_interior_points(set, 50, 2);
  for (std::size_t i = 16; i < filled.rows(); ++i) {
    for (const double value : filled.row(i)) EXPECT_LT(std::abs(value), 0.9);
  }

  const PointSet nudged = moved_by_one_ulp(set, 4);
  EXPECT_NE(nudged.coordinates, set.coordinates);
  for (std::size_t k = 0; k < set.coordinates.size(); ++k) {
    EXPECT_LE(std::abs(nudged.coordinates[k] - set.coordinates[k]), 0x1p-52);
  }

  EXPECT_EQ(affine_rank(embedded(set, 9, 3)), 4U);
  EXPECT_NEAR((matrix_of(rotated(set, 1)).rowwise().norm().array() - 2.0).abs().maxCoeff(), 0.0, 1e-14);
  const std::vector<double> offset{1, 2, 3, 4};
  EXPECT_EQ(moved(set, offset).row(0)[3], set.row(0)[3] + 4);
  EXPECT_EQ(axis_scaled(set, offset).row(0)[2], set.row(0)[2] * 3);
}

TEST(DegeneraciesLaw, EverySecondPointOfCoFlatIsInAFlat) {
  for (const std::size_t k : {1U, 2U, 4U}) {
    const PointSet set = co_flat(40, 5, k, 9);
    PointSet flat{5, {}, {}};
    for (std::size_t i = 0; i < set.rows(); i += 2) {
      flat.coordinates.insert(flat.coordinates.end(), set.row(i).begin(), set.row(i).end());
    }
    EXPECT_EQ(affine_rank(set), 5U);
    EXPECT_EQ(affine_rank(flat), 5U - k);
  }
}

TEST(DegenerateCases, NameTheirSeedAndRepeat) {
  for (const std::size_t d : {2U, 3U, 6U}) {
    const std::vector<DegenerateCase> cases = degenerate_cases(60, d, 11);
    const std::vector<DegenerateCase> again = degenerate_cases(60, d, 11);
    EXPECT_GE(cases.size(), 12U);
    for (std::size_t k = 0; k < cases.size(); ++k) {
      EXPECT_EQ(cases[k].points.coordinates, again[k].points.coordinates) << cases[k].description;
      EXPECT_EQ(cases[k].points.dimension, d);
      EXPECT_GT(cases[k].points.rows(), d);
      EXPECT_NE(cases[k].description.find("seed 11"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace ndhull
