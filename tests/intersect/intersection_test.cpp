// Intersections of halfspaces: closed forms, all choices of planes, and what proves that there are no
// vertices.
#include "approx/polytope/halfspace_intersection.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "approx/polytope/halfspace_region.h"
#include "core/error.h"
#include "tests/hull/hull_support.h"
#include "tests/intersect/intersect_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

using Rows = std::vector<std::vector<double>>;

HalfspaceIntersection intersect(const Rows& rows, const IntersectionOptions& options = {}) {
  std::vector<double> flat;
  for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
  return intersect_halfspaces(PointView::row_major(flat.data(), rows.size(), rows[0].size()), options);
}

Rows box(const std::vector<double>& low, const std::vector<double>& high) {
  Rows rows;
  for (std::size_t k = 0; k < low.size(); ++k) {
    std::vector<double> row(low.size() + 1, 0.0);
    row[k] = 1.0;
    row.back() = -high[k];
    rows.push_back(row);
    row[k] = -2.0;  // lengths do not matter
    row.back() = 2.0 * low[k];
    rows.push_back(row);
  }
  return rows;
}

double dot(const std::vector<double>& row, const double* x) {
  return std::inner_product(row.begin(), row.end() - 1, x, 0.0);
}

/// What the result says of itself holds: vertices in all halfspaces, on their own planes, neighbours mutual.
void expect_sound(const HalfspaceIntersection& region, const Rows& rows, double tolerance) {
  const std::size_t d = region.dimension;
  EXPECT_LE(region.max_residual, tolerance);
  ASSERT_EQ(region.halfspaces_of.begin.size(), region.vertex_count() + 1);
  std::vector<bool> used(rows.size(), false);
  for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex) {
    const double* const x = region.vertices.data() + vertex * d;
    for (const auto& row : rows) EXPECT_LE(dot(row, x) + row.back(), 4.0 * tolerance);
    EXPECT_GE(region.halfspaces_of.row(vertex).size(), region.rank);
    for (const std::uint32_t id : region.halfspaces_of.row(vertex)) {
      EXPECT_NEAR(dot(rows[id], x) + rows[id].back(), 0.0, 4.0 * tolerance);
      used[id] = true;
    }
    for (const std::uint32_t other : region.neighbours_of.row(vertex)) {
      const auto back = region.neighbours_of.row(other);
      EXPECT_TRUE(std::binary_search(back.begin(), back.end(), vertex));
    }
  }
  for (const std::uint32_t id : region.non_redundant) EXPECT_TRUE(used[id]);
  for (const auto& row : rows) EXPECT_LE(dot(row, region.interior_point.data()) + row.back(), tolerance);
}

TEST(IntersectionExample, BoxesOfAllDimensions) {
  for (std::size_t d = 1; d <= 9; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    std::vector<double> low(d), high(d);
    double volume = 1.0, area = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      low[k] = -1.0 - static_cast<double>(k);
      high[k] = 0.5;
      volume *= high[k] - low[k];
    }
    for (std::size_t k = 0; k < d; ++k) area += 2.0 * volume / (high[k] - low[k]);
    const Rows rows = box(low, high);
    const HalfspaceIntersection region = intersect(rows);
    EXPECT_EQ(region.kind, IntersectionKind::kBounded);
    EXPECT_EQ(region.rank, d);
    EXPECT_EQ(region.vertex_count(), std::size_t{1} << d);
    EXPECT_EQ(region.non_redundant.size(), 2 * d);
    EXPECT_NEAR(region.volume.value(), volume, 1e-12 * volume);
    EXPECT_NEAR(region.area.value(), d == 1 ? 2.0 : area, 1e-12 * area);
    EXPECT_NEAR(region.inner_radius, 0.75, 1e-14);
    for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex)
      EXPECT_EQ(region.neighbours_of.row(vertex).size(), d);
    expect_sound(region, rows, 1e-14 * static_cast<double>(d));
  }
}

TEST(IntersectionLaw, RegionsOfAllSizesAreThatOfSizeOneScaled) {
  for (int d = 1; d <= 5; ++d) {
    const auto size = static_cast<std::size_t>(d);
    Rows rows = box(std::vector<double>(size, -1.0), std::vector<double>(size, 1.5));
    const PointSet normals = family_points(PointFamily::kGaussian, 3 * size, size, size);
    for (std::size_t row = 0; row < normals.rows(); ++row) {
      rows.emplace_back(normals.row(row).begin(), normals.row(row).end());
      rows.back().push_back(-1.0 - 0.1 * static_cast<double>(row));
    }
    const HalfspaceIntersection one = intersect(rows);
    for (const int exponent : {-1000, -980, -830, -660, -500, -310, -200, 200, 310, 500, 830, 980, 1015}) {
      SCOPED_TRACE("d " + std::to_string(d) + ", 2^" + std::to_string(exponent));
      Rows scaled = rows;
      for (auto& row : scaled) row.back() = std::ldexp(row.back(), exponent);
      HalfspaceIntersection region = intersect(scaled);
      EXPECT_EQ(region.non_redundant, one.non_redundant);
      const double volume = std::ldexp(one.volume.value(), exponent * d);
      if (std::isnormal(volume)) {
        EXPECT_NEAR(region.volume.value() / volume, 1.0, 1e-12);
      }
      EXPECT_TRUE(std::abs(exponent * d) < 1100 || !region.volume.has_value());
      for (double& coordinate : region.vertices) coordinate = std::ldexp(coordinate, -exponent);
      for (double& coordinate : region.interior_point) coordinate = std::ldexp(coordinate, -exponent);
      region.max_residual = std::ldexp(region.max_residual, -exponent);
      expect_sound(region, rows, 1e-13);
    }
  }
}

TEST(IntersectionExample, RedundantAndRepeatedHalfspacesBoundNothing) {
  Rows rows = box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0});
  rows.push_back({1.0, 1.0, 1.0, -4.0});  // outside
  rows.push_back({1.0, 0.0, 0.0, -1.0});  // row 0 again
  rows.push_back({1.0, 1.0, 0.0, -2.0});  // along an edge
  rows.push_back({1.0, 1.0, 1.0, -3.0});  // through a corner
  const HalfspaceIntersection region = intersect(rows);
  EXPECT_EQ(region.vertex_count(), 8U);
  EXPECT_EQ(region.non_redundant.size(), 6U);
  EXPECT_NEAR(region.volume.value(), 8.0, 1e-13);
  EXPECT_NEAR(region.area.value(), 24.0, 1e-12);
}

TEST(IntersectionExample, SlabsHalfspacesAndConesAreUnbounded) {
  const Rows cases[] = {
      {{0.0, 0.0, 3.0, -1.0}},
      {{0.0, 1.0, 0.0, -1.0}, {0.0, -1.0, 0.0, -1.0}},
      {{-1.0, 0.0, 0.0, 0.0}, {0.0, -1.0, 0.0, 0.0}, {0.0, 0.0, -1.0, 0.0}},
      {{1.0, 0.0, 0.0, 0.0}, {-1.0, 0.0, 0.0, 0.0}},  // a plane: flat and unbounded
  };
  for (const Rows& rows : cases) {
    const HalfspaceIntersection region = intersect(rows);
    EXPECT_EQ(region.kind, IntersectionKind::kUnbounded);
    ASSERT_EQ(region.direction.size(), 3U);
    EXPECT_NEAR(std::hypot(region.direction[0], region.direction[1], region.direction[2]), 1.0, 1e-14);
    for (const auto& row : rows) {
      EXPECT_LE(dot(row, region.direction.data()), 1e-14);
      EXPECT_LE(dot(row, region.interior_point.data()) + row.back(), 1e-14);
    }
    EXPECT_LE(region.direction_margin, 1e-14);
    EXPECT_EQ(region.vertex_count(), 0U);
    EXPECT_FALSE(region.volume);
  }
  EXPECT_EQ(intersect(cases[3]).rank, 2U);
  EXPECT_EQ(intersect(cases[1]).inner_radius, 1.0);
  EXPECT_EQ(intersect(cases[2]).inner_radius, std::numeric_limits<double>::infinity());
}

void expect_proof_of_empty(const HalfspaceIntersection& region, const Rows& rows, double gap) {
  ASSERT_EQ(region.kind, IntersectionKind::kEmpty);
  std::vector<double> sum(region.dimension + 1, 0.0);
  double lengths = 0.0;
  for (const HalfspaceWeight& term : region.proof) {
    EXPECT_GT(term.weight, 0.0);
    const auto& row = rows[term.halfspace];
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += term.weight * row[k];
    lengths += term.weight * std::sqrt(std::inner_product(row.begin(), row.end() - 1, row.begin(), 0.0));
  }
  for (std::size_t k = 0; k < region.dimension; ++k) EXPECT_NEAR(sum[k], 0.0, 1e-14);
  EXPECT_NEAR(lengths, 1.0, 1e-14);
  EXPECT_GT(sum.back(), 0.0);
  EXPECT_NEAR(sum.back(), region.proof_gap, 1e-14);
  EXPECT_NEAR(region.proof_gap, gap, 1e-13);
  EXPECT_LE(region.proof_residual, 1e-14);
}

TEST(IntersectionExample, EmptyOnesComeWithACombinationThatProvesIt) {
  Rows rows{{1.0, 0.0, 1.0}, {-1.0, 0.0, 1.0}, {0.0, 1.0, -7.0}};
  expect_proof_of_empty(intersect(rows), rows, 1.0);
  rows = {{-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, {1.0, 1.0, 1.0}};  // x, y >= 0, x + y <= -1
  const double lengths = 2.0 + std::sqrt(2.0);
  expect_proof_of_empty(intersect(rows), rows, 1.0 / lengths);
}

TEST(IntersectionExample, EmptyInsideAPlaneIsProvenInSpace) {
  // z = 0 by two halfspaces; in that plane x >= 1 (with some z) and x <= 0 (with some z).
  const Rows rows{{0.0, 0.0, 1.0, 0.0}, {0.0, 0.0, -1.0, 0.0}, {-1.0, 0.0, 1.0, 1.0}, {1.0, 0.0, 2.0, 0.0}};
  const HalfspaceIntersection region = intersect(rows);
  ASSERT_EQ(region.kind, IntersectionKind::kEmpty);
  expect_proof_of_empty(region, rows, region.proof_gap);
}

TEST(IntersectionExample, FlatPolytopesAreFoundInTheirSubspace) {
  // The simplex x_k >= 0, sum = 1 in 4-d.
  Rows rows{{1.0, 1.0, 1.0, 1.0, -1.0}, {-1.0, -1.0, -1.0, -1.0, 1.0}};
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<double> row(5, 0.0);
    row[k] = -1.0;
    rows.push_back(row);
  }
  const HalfspaceIntersection region = intersect(rows);
  EXPECT_EQ(region.kind, IntersectionKind::kLowerDimensional);
  EXPECT_EQ(region.rank, 3U);
  EXPECT_EQ(region.equalities, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(region.non_redundant, (std::vector<std::uint32_t>{2, 3, 4, 5}));
  EXPECT_EQ(region.vertex_count(), 4U);
  ASSERT_EQ(region.equations.size(), 5U);
  for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex) {
    const double* const x = region.vertices.data() + vertex * 4;
    EXPECT_NEAR(std::inner_product(x, x + 4, region.equations.data(), region.equations[4]), 0.0, 1e-15);
    EXPECT_NEAR(*std::max_element(x, x + 4), 1.0, 1e-15);
  }
  EXPECT_NEAR(region.volume.value(), std::sqrt(4.0) / 6.0, 1e-14);
  expect_sound(region, rows, 1e-14);
}

TEST(IntersectionExample, FlatInStagesDownToAPoint) {
  // x <= 0 and x >= 0; on that line of the plane y <= x, y >= x + 0: the origin; z pinned by a cone.
  const Rows rows{{1.0, 0.0, 0.0, 0.0},  {-1.0, 0.0, 0.0, 0.0}, {1.0, 1.0, 0.0, 0.0},
                  {1.0, -1.0, 0.0, 0.0}, {0.0, 1.0, 1.0, -2.0}, {0.0, 0.0, -1.0, 2.0}};
  const HalfspaceIntersection region = intersect(rows);
  EXPECT_EQ(region.kind, IntersectionKind::kLowerDimensional);
  EXPECT_EQ(region.rank, 0U);
  ASSERT_EQ(region.vertex_count(), 1U);
  EXPECT_NEAR(region.vertices[0], 0.0, 1e-15);
  EXPECT_NEAR(region.vertices[1], 0.0, 1e-15);
  EXPECT_NEAR(region.vertices[2], 2.0, 1e-15);
  EXPECT_EQ(region.equalities.size(), 6U);
}

TEST(IntersectionExample, InteriorPointsAreTakenOrRefused) {
  const Rows rows = box({-1.0, -1.0}, {1.0, 1.0});
  const HalfspaceIntersection region = intersect(rows, {.interior_point = {{0.9, -0.999}}});
  EXPECT_EQ(region.interior_point, (std::vector<double>{0.9, -0.999}));
  EXPECT_EQ(region.vertex_count(), 4U);
  const auto message_of = [&rows](const std::vector<double>& point) -> std::string {
    try {
      intersect(rows, {.interior_point = point});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message_of({0.0, 1.5}).find("halfspace 2 (counted from 0): found the interior point 0.5 above"),
            std::string::npos);
  EXPECT_NE(message_of({-1.0, 0.0}).find("halfspace 1 (counted from 0): found the interior point on"),
            std::string::npos);
  EXPECT_NE(message_of({0.0}).find("of 1 coordinates, expected 2"), std::string::npos);
}

TEST(IntersectionExample, LongWedgesAreBounded) {
  // A wedge with sides of slope 1 / length, cut off at its length.
  for (const double length : {1e3, 1e6, 1e9, 1e12, 1e15, 1e18, 1e60}) {
    SCOPED_TRACE("length " + std::to_string(length));
    const Rows rows{{-1.0, 0.0, 0.0}, {1.0 / length, 1.0, -1.0}, {1.0 / length, -1.0, -1.0}};
    const HalfspaceIntersection region = intersect(rows);  // corners (0, 1), (0, -1), (length, 0)
    ASSERT_EQ(region.kind, IntersectionKind::kBounded);
    EXPECT_EQ(region.vertex_count(), 3U);
    EXPECT_NEAR(region.volume.value(), length, 1e-12 * length);
  }
}

TEST(IntersectionExample, BadHalfspacesAreErrors) {
  EXPECT_THROW(intersect({{1.0, 0.0, -1.0}, {0.0, 0.0, -1.0}}), Error);
  EXPECT_THROW(intersect({{1.0, std::nan(""), -1.0}}), Error);
  EXPECT_THROW(intersect({{1.0, 0.0, HUGE_VAL}}), Error);
  EXPECT_THROW(intersect({{1.0}}), Error);
  EXPECT_THROW(intersect_halfspaces(PointView::row_major(static_cast<const double*>(nullptr), 0, 3)), Error);
}

/// Every choice of d planes that meet in a point which is in all halfspaces.
std::size_t count_vertices(const Rows& rows, std::size_t d) {
  std::vector<bool> chosen(rows.size(), false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(d), true);
  std::size_t count = 0;
  do {
    Eigen::MatrixXd normals(d, d);
    Eigen::VectorXd right(d);
    for (std::size_t id = 0, row = 0; id < rows.size(); ++id) {
      if (!chosen[id]) continue;
      for (std::size_t k = 0; k < d; ++k)
        normals(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(k)) = rows[id][k];
      right[static_cast<Eigen::Index>(row++)] = -rows[id].back();
    }
    const Eigen::VectorXd x = normals.fullPivLu().solve(right);
    bool is_inside = true;
    for (std::size_t id = 0; id < rows.size(); ++id)
      is_inside &= chosen[id] || dot(rows[id], x.data()) + rows[id].back() < 0.0;
    count += is_inside ? 1 : 0;
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return count;
}

TEST(IntersectionOracle, RandomHalfspacesHaveTheVerticesOfAllChoices) {
  std::mt19937_64 random(20240603);
  std::normal_distribution<double> normal;
  std::size_t kinds[4] = {0, 0, 0, 0};
  for (std::size_t round = 0; round < 120; ++round) {
    const std::size_t d = 2 + round % 4;
    Rows rows(d + 2 + round % 9, std::vector<double>(d + 1));
    for (auto& row : rows) {
      for (double& value : row) value = normal(random);
      row.back() = 0.5 * row.back() - 0.6;  // some are empty
    }
    SCOPED_TRACE("round " + std::to_string(round));
    const HalfspaceIntersection region = intersect(rows);
    ++kinds[static_cast<std::size_t>(region.kind)];
    if (region.kind == IntersectionKind::kBounded) {
      EXPECT_EQ(region.vertex_count(), count_vertices(rows, d));
      expect_sound(region, rows, 1e-10);
    } else if (region.kind == IntersectionKind::kUnbounded) {
      for (const auto& row : rows) {
        EXPECT_LE(dot(row, region.direction.data()), 1e-12);
        EXPECT_LT(dot(row, region.interior_point.data()) + row.back(), 0.0);
      }
    } else {
      expect_proof_of_empty(region, rows, region.proof_gap);
      EXPECT_EQ(count_vertices(rows, d), 0U);
    }
  }
  EXPECT_GT(kinds[0], 15U);
  EXPECT_GT(kinds[1], 15U);
  EXPECT_GT(kinds[2], 10U);
  EXPECT_EQ(kinds[3], 0U);
}

TEST(IntersectionOracle, LargestBallOfAHundredThousandTangentPlanes) {
  const std::size_t d = 10, count = 100'000;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> rows(count * (d + 1));
  const double centre = 7.0, radius = 2.0;
  for (std::size_t row = 0; row < count; ++row) {
    double* const out = rows.data() + row * (d + 1);
    double length = 0.0, along = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      out[k] = normal(random);
      length = std::hypot(length, out[k]);
      along += centre * out[k];
    }
    out[d] = -along - radius * length;
  }
  const HalfspaceRegion region =
      find_region(HalfspaceSet(PointView::row_major(rows.data(), count, d + 1)), std::nullopt);
  EXPECT_NEAR(region.radius, radius, 1e-12);
  for (const double value : region.point) EXPECT_NEAR(value, centre, 1e-11);
}

TEST(IntersectionLaw, PlanesOfKnownPolytopesGiveTheirVerticesVolumeAndArea) {
  for (const NamedPolytope& known : small_named_polytopes()) {
    if (known.facets > 3000 || known.rank < known.points.dimension || known.rank > 9) continue;
    SCOPED_TRACE(known.name);
    const Hull hull = hull_of(known.points);
    const HalfspaceIntersection region = intersect_planes(exact_planes(hull));
    EXPECT_EQ(region.kind, IntersectionKind::kBounded);
    EXPECT_EQ(region.vertex_count(), known.vertices);
    EXPECT_EQ(region.non_redundant.size(), known.facets);
    EXPECT_NEAR(region.volume.value(), hull.volume, 1e-9 * hull.volume);
    EXPECT_NEAR(region.area.value(), hull.area, 1e-9 * hull.area);
    const PointSet corners = vertex_rows(known.points, hull);
    EXPECT_LE(furthest_point(corners, region), 1e-11 * extent_of(corners));
  }
}

TEST(IntersectionLaw, LimitsGiveVerticesAroundTheIntersection) {
  const PointSet points = family_points(PointFamily::kSphere, 300, 4, 6);
  const Hull hull = hull_of(points);
  const PlaneRows planes = exact_planes(hull);
  for (const std::uint64_t limit : {1U, 10U, 100U, 1000U}) {
    IntersectionOptions options;
    options.limits.max_facets = limit;
    const HalfspaceIntersection region = intersect_planes(planes, options);
    EXPECT_EQ(region.kind, IntersectionKind::kBounded);
    EXPECT_EQ(region.status, HullStatus::kFacetLimit);
    EXPECT_FALSE(region.volume);
    EXPECT_LT(region.non_redundant.size(), planes.count());
    if (region.vertex_count() == 0) continue;
    const PointSet corners{4, region.vertices, ""};
    EXPECT_GT(hull_of(corners).volume, hull.volume);
  }
  IntersectionOptions enough;
  enough.limits.max_facets = 1'000'000;
  EXPECT_EQ(intersect_planes(planes, enough).vertex_count(), points.rows());
}

}  // namespace
}  // namespace ndhull
