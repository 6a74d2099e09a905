// Sections and shadows against closed forms, and the order inner, hull, outer on hulls that were stopped
// early.
#include "approx/drawing/section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "approx/drawing/projection.h"
#include "approx/drawing/shadow.h"
#include "core/error.h"
#include "core/linear/column_table.h"
#include "tests/support/named_polytopes.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

DrawingAxes columns(const Hull& hull, std::vector<std::size_t> indices) {
  return column_axes(indices, hull.interior_point, column_names_or_numbers({}, hull.dimension));
}

PointSet sphere(std::size_t n, std::size_t d) {
  return generate_points({.family = PointFamily::kSphere, .dimension = d, .count = n, .seed = 5});
}

double dot(const Point3& a, const Point3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Largest height of a corner of `inside` above a face of `outside`; <= 0 when it is contained.
double excess(const Shell& inside, const Shell& outside) {
  double most = -1e300;
  for (const Shell::Face& face : outside.faces) {
    const double height = dot(outside.corners[face.corners.front()], face.normal);
    for (const Point3& corner : inside.corners) most = std::max(most, dot(corner, face.normal) - height);
  }
  return most;
}

/// Each edge of a closed surface is passed once in each direction when all faces are counterclockwise.
void expect_closed(const Shell& shell) {
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Shell::Face& face : shell.faces) {
    ASSERT_GE(face.corners.size(), 3U);
    for (std::size_t k = 0; k < face.corners.size(); ++k) {
      edges.emplace(face.corners[k], face.corners[(k + 1) % face.corners.size()]);
    }
  }
  for (const auto& [from, to] : edges) {
    EXPECT_EQ(edges.count({from, to}), 1U);
    EXPECT_EQ(edges.count({to, from}), 1U);
  }
  EXPECT_EQ(shell.corners.size() + shell.faces.size(), edges.size() / 2 + 2);  // Euler
}

TEST(SectionExample, ACubeIn5dIsCutInACube) {
  const NamedPolytope cube5 = cube(5);
  const Hull hull = convex_hull(cube5.points.view());
  const CentredFacets facets = centred_facets(hull);
  const DrawingAxes axes = columns(hull, {0, 2, 4});
  for (const ShellKind kind : {ShellKind::kInner, ShellKind::kOuter}) {
    const std::optional<Shell> shell = section_shell(facets, axes, kind);
    ASSERT_TRUE(shell.has_value());
    EXPECT_EQ(shell->faces.size(), 6U);
    EXPECT_EQ(shell->corners.size(), 8U);
    expect_closed(*shell);
    for (const Point3& corner : shell->corners) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(std::abs(corner[k] + axes.origin[k]), 1.0, 1e-14);
    }
    for (const Shell::Face& face : shell->faces) {
      // The face lies in the facet it names: same normal along the axes.
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(face.normal[k], facets.normal(face.source)[2 * k], 1e-14);
      }
    }
  }
}

TEST(SectionExample, ACrossPolytopeIn4dIsCutInAnOctahedron) {
  const NamedPolytope cross4 = cross_polytope(4);
  CentredFacets facets = centred_facets(convex_hull(cross4.points.view()));
  // About the origin two facets are cut in the same triangle: one face stands for both.
  for (std::size_t facet = 0; facet < facets.size(); ++facet) facets.heights[facet] = 0.5;
  facets.centre.assign(4, 0.0);
  const std::vector<std::size_t> indices{0, 1, 2};
  const DrawingAxes axes = column_axes(indices, facets.centre, column_names_or_numbers({}, 4));
  const std::optional<Shell> shell = section_shell(facets, axes, ShellKind::kOuter);
  ASSERT_TRUE(shell.has_value());
  EXPECT_EQ(shell->faces.size(), 8U);
  EXPECT_EQ(shell->corners.size(), 6U);
  expect_closed(*shell);
}

TEST(SectionExample, TwoAxesCutAPolygonWithTwoCornersASide) {
  const Hull hull = convex_hull(cube(5).points.view());
  const std::optional<Shell> shell =
      section_shell(centred_facets(hull), columns(hull, {1, 3}), ShellKind::kOuter);
  ASSERT_TRUE(shell.has_value());
  EXPECT_EQ(shell->faces.size(), 4U);
  for (const Shell::Face& face : shell->faces) {
    ASSERT_EQ(face.corners.size(), 2U);
    const Point3 &from = shell->corners[face.corners[0]], &to = shell->corners[face.corners[1]];
    // Counterclockwise: the inside is on the left.
    EXPECT_GT((to[1] - from[1]) * face.normal[0] - (to[0] - from[0]) * face.normal[1], 1.9);
  }
}

TEST(SectionLaw, InnerIsInOuterAndBothFollowTheFacetsPlanes) {
  for (const std::size_t d : {3U, 4U, 6U, 8U}) {
    SCOPED_TRACE("sphere, n 2000, seed 5, max_facets 20000, d " + std::to_string(d));
    const PointSet set = sphere(2000, d);
    const Hull hull = convex_hull(set.view(), {.limits = {.max_facets = 20000}});
    const CentredFacets facets = centred_facets(hull);
    const DrawingAxes axes =
        principal_axes(set.view(), 3, hull.interior_point, {}, column_names_or_numbers({}, d));
    const std::optional<Shell> inner = section_shell(facets, axes, ShellKind::kInner);
    const std::optional<Shell> outer = section_shell(facets, axes, ShellKind::kOuter);
    ASSERT_TRUE(inner.has_value() && outer.has_value());
    expect_closed(*inner);
    expect_closed(*outer);
    EXPECT_LE(excess(*inner, *outer), 1e-12);
    // The outer shell's corners, as points of the input's space, are below every outer plane, and one d-1 or
    // more planes are reached exactly.
    for (const Point3& corner : outer->corners) {
      std::vector<double> point = axes.centre;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < d; ++k) point[k] += corner[axis] * axes.direction(axis)[k];
      }
      std::size_t reached = 0;
      for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
        const auto normal = hull.normal(FacetId{row});
        const double above = std::inner_product(normal.begin(), normal.end(), point.begin(), 0.0) +
                             hull.offset(FacetId{row}) - hull.outer_offset(FacetId{row});
        ASSERT_LE(above, 1e-11);
        reached += above > -1e-11 ? 1 : 0;
      }
      EXPECT_GE(reached, 3U);
    }
  }
}

TEST(SectionLaw, WidthsOfTheFacetsAreCarriedOver) {
  const PointSet set = sphere(500, 5);
  const Hull hull = convex_hull(set.view(), {.unit_cube = true, .limits = {.max_facets = 500}});
  const CentredFacets facets = centred_facets(hull);
  ASSERT_EQ(facets.size(), hull.facet_count());
  EXPECT_DOUBLE_EQ(*std::max_element(facets.widths.begin(), facets.widths.end()), hull.max_facet_width);
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    EXPECT_DOUBLE_EQ(facets.widths[row], hull.outer_offset(facet) - hull.inner_offset(facet));
    EXPECT_DOUBLE_EQ(facets.outer[row], hull.outer_offset(facet) * hull.input_per_length_unit(facet));
  }
}

TEST(SectionExample, WithoutARoomInsideTheInnerPlanesThereIsNoInnerShell) {
  const Hull hull = convex_hull(cube(3).points.view());
  CentredFacets facets = centred_facets(hull);
  facets.inner[2] = -facets.heights[2];
  EXPECT_FALSE(section_shell(facets, columns(hull, {0, 1, 2}), ShellKind::kInner).has_value());
  EXPECT_TRUE(section_shell(facets, columns(hull, {0, 1, 2}), ShellKind::kOuter).has_value());
}

TEST(SectionExample, PlanesThatLeaveItOpenAreAnError) {
  const std::vector<double> normals{1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, 0};
  const std::vector<double> heights{1, 1, 1, 1};
  try {
    bounded_by_planes(normals, heights, 3);
    FAIL() << "an open region was drawn";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
  }
}

TEST(ShadowExample, ACubeCastsACubesShadow) {
  const NamedPolytope cube5 = cube(5);
  const Hull hull = convex_hull(cube5.points.view());
  const std::optional<Shadow> shadow =
      hull_shadow(centred_facets(hull), cube5.points.view(), hull.vertices, columns(hull, {1, 2, 3}));
  ASSERT_TRUE(shadow.has_value());
  EXPECT_EQ(shadow->inner.faces.size(), 6U);
  EXPECT_EQ(shadow->inner.corners.size(), 8U);
  expect_closed(shadow->inner);
  for (const double margin : shadow->margins) EXPECT_LT(margin, 1e-12);
}

TEST(ShadowLaw, OuterHoldsEveryPointAndIsNoFurtherThanTheRatioSays) {
  for (const std::size_t d : {4U, 6U}) {
    SCOPED_TRACE("sphere, n 1000, seed 5, max_facets 1000, d " + std::to_string(d));
    const PointSet set = sphere(1000, d);
    const Hull hull = convex_hull(set.view(), {.limits = {.max_facets = 1000}});
    const CentredFacets facets = centred_facets(hull);
    const DrawingAxes axes = columns(hull, {0, 1, 3});
    const std::optional<Shadow> shadow = hull_shadow(facets, set.view(), hull.vertices, axes);
    ASSERT_TRUE(shadow.has_value() && shadow->outer.has_value());
    EXPECT_LE(excess(shadow->inner, *shadow->outer), 1e-12);
    std::vector<PointId> all;
    for (std::uint32_t id = 0; id < set.rows(); ++id) all.push_back(PointId{id});
    const std::vector<double> projected = coordinates_along(axes, set.view(), all);
    for (const Shell::Face& face : shadow->outer->faces) {
      const double height = dot(shadow->outer->corners[face.corners.front()], face.normal);
      for (std::size_t row = 0; row < set.rows(); ++row) {
        EXPECT_LE(dot({projected[3 * row], projected[3 * row + 1], projected[3 * row + 2]}, face.normal),
                  height + 1e-9);
      }
    }
    const double most = outer_ratio(facets) - 1.0;
    ASSERT_TRUE(std::isfinite(most));
    for (const double margin : shadow->margins) {
      EXPECT_GE(margin, 0.0);
      EXPECT_LE(margin, most * (1 + 1e-12));
    }
    // The program is what makes it sharp: somewhere the scaled hull is beaten clearly.
    EXPECT_LT(*std::min_element(shadow->margins.begin(), shadow->margins.end()), 0.9 * most);
    // A deadline that has passed: the scaled hull is all that is known.
    std::stop_source stop;
    stop.request_stop();
    const std::optional<Shadow> late =
        hull_shadow(facets, set.view(), hull.vertices, axes, WorkEnd(0.0, stop.get_token()));
    ASSERT_TRUE(late.has_value() && late->outer.has_value());
    EXPECT_LE(excess(*shadow->outer, *late->outer), 1e-12);
    for (const double margin : late->margins) EXPECT_NEAR(margin, most, 1e-12 * (1.0 + most));
  }
}

/// How far the outer polytope reaches along a direction, all facets being asked at every step. Points near 1.
double reach_of_all(const CentredFacets& facets, const std::vector<double>& direction) {
  ColumnTable poles(facets.dimension, facets.size());
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    std::vector<double> pole(facets.normal(facet).begin(), facets.normal(facet).end());
    for (double& x : pole) x /= facets.heights[facet] + facets.outer[facet];
    poles.set(facet, pole, 1.0);
  }
  ColumnSimplex program(direction);
  return solve_lp(program, [&poles](const LpQuery& query) { return poles.price(query); }).objective;
}

// Poles of thin hulls are long: the rounding of a product with one is no improvement.
TEST(ShadowOracle, ThinHullsReachAsFarAsAProgramWithAllFacetsSays) {
  constexpr double kThickness = 1e-8;
  PointSet set = sphere(600, 4);
  const double half = std::sqrt(0.5);
  for (std::size_t row = 0; row < set.rows(); ++row) {
    const std::span<double> x = set.row(row);
    x[3] *= kThickness;
    for (const auto& [i, j] : {std::pair{0, 3}, std::pair{1, 3}, std::pair{2, 0}, std::pair{1, 2}}) {
      const double first = x[static_cast<std::size_t>(i)], last = x[static_cast<std::size_t>(j)];
      x[static_cast<std::size_t>(i)] = half * (first + last);
      x[static_cast<std::size_t>(j)] = half * (last - first);
    }
  }
  const Hull hull = convex_hull(set.view(), {.accuracy = {.width = {.value = 0.1 * kThickness}}});
  const CentredFacets facets = centred_facets(hull);
  const DrawingAxes axes = columns(hull, {0, 1});
  const std::optional<Shadow> shadow = hull_shadow(facets, set.view(), hull.vertices, axes);
  ASSERT_TRUE(shadow.has_value());
  const double most = outer_ratio(facets);
  for (std::size_t face = 0; face < shadow->inner.faces.size(); ++face) {
    const Point3& normal = shadow->inner.faces[face].normal;
    const double height = dot(shadow->inner.corners[shadow->inner.faces[face].corners.front()], normal);
    const double reach = reach_of_all(facets, {normal[0], normal[1], 0.0, 0.0});
    const double expected = std::max(1.0, std::min(most, reach / height));
    EXPECT_NEAR(1.0 + shadow->margins[face], expected, 1e-5 * expected) << face;
  }
}

TEST(ShadowExample, FlatAlongTheAxesThereIsNone) {
  PointSet set = sphere(100, 4);
  for (std::size_t row = 0; row < set.rows(); ++row) set.row(row)[3] = set.row(row)[0] + 1.0;
  const Hull hull = convex_hull(set.view());
  ASSERT_EQ(hull.rank, 3U);
  const CentredFacets facets = centred_facets(hull);
  EXPECT_FALSE(hull_shadow(facets, set.view(), hull.vertices, columns(hull, {0, 1, 3})).has_value());
  EXPECT_TRUE(hull_shadow(facets, set.view(), hull.vertices, columns(hull, {0, 1, 2})).has_value());
}

TEST(DrawingAxesExample, PrincipalComponentsFindTheLongDirections) {
  PointSet set = sphere(2000, 5);
  for (std::size_t row = 0; row < set.rows(); ++row) {
    const double along = 10.0 * set.row(row)[0], across = 4.0 * set.row(row)[1];
    set.row(row)[0] = 1e6 + 0.6 * along - 0.8 * across;
    set.row(row)[1] = -1e6 + 0.8 * along + 0.6 * across;
  }
  const std::vector<double> centre{1e6, -1e6, 0, 0, 0};
  const DrawingAxes axes = principal_axes(set.view(), 2, centre, {}, column_names_or_numbers({}, 5));
  EXPECT_NEAR(axes.direction(0)[0], 0.6, 0.05);
  EXPECT_NEAR(axes.direction(0)[1], 0.8, 0.05);
  EXPECT_NEAR(axes.direction(1)[0], 0.8, 0.05);
  EXPECT_NEAR(axes.direction(1)[1], -0.6, 0.05);
  EXPECT_EQ(axes.names, (std::vector<std::string>{"PC1", "PC2"}));
}

// Of points so flat that their thinnest direction is lost in the rounding of a covariance.
TEST(DrawingAxesLaw, ComponentsStayInTheSubspace) {
  const PointSet plate = sphere(200, 3);
  PointSet set{5, {}, ""};
  for (std::size_t row = 0; row < plate.rows(); ++row) {
    const double a = plate.row(row)[0], b = plate.row(row)[1], c = 1e-9 * plate.row(row)[2];
    set.coordinates.insert(set.coordinates.end(), {a + c, b - c, a - b + c, 0.5 * a + b, a + 2.0 * b});
  }
  const Hull hull = convex_hull(set.view());
  ASSERT_EQ(hull.rank, 3U);
  const DrawingAxes axes = principal_axes(set.view(), 3, hull.interior_point, {},
                                          column_names_or_numbers({}, 5), hull.subspace_equations);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t row = 0; row < hull.subspace_equations.size(); row += 6)
      EXPECT_NEAR(std::inner_product(axes.direction(axis).begin(), axes.direction(axis).end(),
                                     hull.subspace_equations.begin() + static_cast<std::ptrdiff_t>(row), 0.0),
                  0.0, 1e-12);
}

TEST(DrawingAxesLaw, DirectionsAndMeasuresAreDualInTheUnitCube) {
  const PointSet set = sphere(300, 4);
  const std::vector<double> centre(4, 0.0), extents{2.0, 300.0, 0.0, 1e-3};
  const DrawingAxes axes = principal_axes(set.view(), 3, centre, extents, column_names_or_numbers({}, 4));
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ(axes.direction(j)[2], 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto direction = axes.direction(j), measure = axes.measure(k);
      EXPECT_NEAR(std::inner_product(direction.begin(), direction.end(), measure.begin(), 0.0),
                  j == k ? 1.0 : 0.0, 1e-12);
    }
  }
}

TEST(ProjectionExample, TheCameraSeesWhatIsInFrontOfIt) {
  const Projection projection({.azimuth = 0.0, .elevation = 0.0, .distance = 4.0, .field_of_view = 0.5}, 200,
                              100);
  const Projection::OnPage middle = projection.project({0, 0, 0});
  EXPECT_NEAR(middle.x, 100.0, 1e-12);
  EXPECT_NEAR(middle.y, 50.0, 1e-12);
  EXPECT_NEAR(middle.depth, 4.0, 1e-12);
  // Seen along the first axis: the second grows to the right, the third upwards, near things are larger.
  const Projection::OnPage near = projection.project({1, 0.5, 0.25}),
                           far = projection.project({-1, 0.5, 0.25});
  EXPECT_NEAR(near.x - 100.0, 50.0 / std::tan(0.25) * 0.5 / 3.0, 1e-9);
  EXPECT_NEAR(near.y - 50.0, -50.0 / std::tan(0.25) * 0.25 / 3.0, 1e-9);
  EXPECT_NEAR((far.x - 100.0) * 5.0, (near.x - 100.0) * 3.0, 1e-9);
  EXPECT_TRUE(projection.is_facing({1, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(projection.is_facing({-1, 0, 0}, {-1, 0, 0}));
  EXPECT_FALSE(projection.is_facing({0, 1, 0}, {0, 1, 0}));
}

TEST(LargestFacetsExample, LargestFirstAndNoMoreThanThereAre) {
  CentredFacets facets;
  facets.heights = {1, 1, 1, 1};
  facets.areas = {2, 5, 5, 1};
  EXPECT_EQ(largest_facets(facets, 3), (std::vector<std::uint32_t>{1, 2, 0}));
  EXPECT_EQ(largest_facets(facets, 9), (std::vector<std::uint32_t>{1, 2, 0, 3}));
  EXPECT_TRUE(largest_facets(facets, 0).empty());
}

}  // namespace
}  // namespace ndhull
