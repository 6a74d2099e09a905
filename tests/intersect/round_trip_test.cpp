// Hull, intersection of its planes, hull again: nothing is lost, and exact planes give the points back.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/portable_random.h"
#include "tests/intersect/intersect_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

/// Exact planes of points that are all vertices, intersected. `tolerance` [distance] for both ways.
void expect_identity(const PointSet& points, double tolerance) {
  const Hull hull = hull_of(points);
  ASSERT_EQ(hull.vertices.size(), points.rows());
  const HalfspaceIntersection region = intersect_planes(exact_planes(hull));
  ASSERT_EQ(region.kind, IntersectionKind::kBounded);
  EXPECT_EQ(region.vertex_count(), points.rows());
  EXPECT_LE(furthest_point(points, region), tolerance);
  EXPECT_LE(furthest_vertex(region, points), tolerance);
}

PointSet unit_sphere(std::size_t n, std::size_t d, std::uint64_t seed) {
  return family_points(PointFamily::kSphere, n, d, seed);
}

TEST(IdentityPipe, OfPointsOnASphere) {
  for (std::size_t d = 2; d <= 6; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    expect_identity(unit_sphere(d < 6 ? 100 : 60, d, d), 1e-12);
  }
}

// The examples of Qhull's manual, "Imprecision": qhull n | qhull H Fp with s, L1e5, s O10.
TEST(IdentityPipe, OfTheManualsExamples) {
  for (const char* command : {"100 s D3", "100 s D4", "100 s D5", "100 s O10 D3", "100 s O10 D5"}) {
    SCOPED_TRACE(command);
    expect_identity(rbox(command), 1e-11);
  }
  // A lens of radius 1e5: vertices are sharp along its rim only, and planes nearly parallel elsewhere.
  const PointSet lens = rbox("100 L1e5");
  const Hull hull = hull_of(lens);
  const HalfspaceIntersection region = intersect_planes(exact_planes(hull));
  EXPECT_EQ(region.vertex_count(), hull.vertices.size());
  EXPECT_LE(furthest_point(vertex_rows(lens, hull), region), 1e-9);
}

TEST(IdentityPipe, OfPointsFarFromTheOrigin) {
  // A coordinate of 1e5 is rounded to 1e-11, an offset too; angles between planes multiply that.
  for (std::size_t d = 3; d <= 5; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    const PointSet points = unit_sphere(60, d, 3);
    expect_identity(moved(points, std::vector<double>(d, 1e5)), 1e-8);
    expect_identity(moved(points, std::vector<double>(d, 1e10)), 1e-3);
  }
}

// What the planes enclose, or that it is too long and thin to be found.
TEST(IntersectionRegression, LongThinRegionsEndInAWord) {
  int refused = 0;
  for (std::uint64_t seed = 310; seed < 330; ++seed) {
    SCOPED_TRACE("small integers in 5-d, axes of 1e-5 to 1e4, seed " + std::to_string(seed));
    PointSet set{5, {}, {}};
    PortableRandom random(seed);
    for (int i = 0; i < 5 * 396; ++i) set.coordinates.push_back(static_cast<double>(random.below(5)) - 2.0);
    const PointSet points = axis_scaled(set, std::vector<double>{1e3, 1e4, 1e-5, 1e3, 0.1});
    try {
      const HalfspaceIntersection region = intersect_planes(outer_planes(hull_of(points), points.view()));
      EXPECT_EQ(region.kind, IntersectionKind::kBounded);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadHalfspace);
      ++refused;
    }
  }
  EXPECT_LE(refused, 1);
}

TEST(IdentityPipe, OfNarrowPoints) {
  for (const double thickness : {1e-3, 1e-6, 1e-9}) {
    SCOPED_TRACE("thickness " + std::to_string(thickness));
    PointSet points = unit_sphere(80, 4, 7);
    points = axis_scaled(points, std::vector<double>{1.0, 1.0, 1.0, thickness});
    expect_identity(points, 1e-12 / thickness);
  }
}

// Planes of thin simplices are known to some roundings of the whole hull, which are about the shift beside
// what is thin: the dual hull's growth undid most insertions, and ended with facets far from where they
// should be.
TEST(IntersectionRegression, VolumesOfThinHullsThatAreTurned) {
  const std::vector<double> scales = {1.0, 0.9, 0.05, 1.0, 0.02, 0.8, 0.015};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const PointSet points =
        rotated(axis_scaled(family_points(PointFamily::kGaussian, 24, 7, seed), scales), seed);
    const Hull hull = hull_of(points);
    const HalfspaceIntersection region = intersect_planes(exact_planes(hull));
    ASSERT_EQ(region.kind, IntersectionKind::kBounded);
    EXPECT_NEAR(region.volume.value(), hull.volume, 1e-8 * hull.volume);
    EXPECT_LE(furthest_point(vertex_rows(points, hull), region), 1e-9);
  }
}

/// hull | intersect | hull on outer planes: contains the input, and has not grown by more than `growth`.
void expect_round_trip(const PointSet& points, const HullOptions& options, double growth) {
  const Hull hull = hull_of(points, options);
  const HalfspaceIntersection region = intersect_planes(outer_planes(hull, points.view()));
  ASSERT_EQ(region.kind, IntersectionKind::kBounded);
  const PointSet corners{points.dimension, region.vertices, ""};
  const Hull again = hull_of(corners);
  EXPECT_EQ(again.rank, points.dimension);
  EXPECT_EQ(again.status, HullStatus::kComplete);
  EXPECT_GE(again.volume, hull.volume * (1.0 - 1e-12));
  EXPECT_LE(again.volume, hull.volume * (1.0 + growth));
  EXPECT_NEAR(region.volume.value(), again.volume, 1e-9 * again.volume);
  // Corners are rounded: the points are inside up to that.
  const double rounding = 64.0 * 0x1p-52 * extent_of(points);
  for (std::uint32_t id = 0; id < again.facet_count(); ++id) {
    const auto normal = again.normal(FacetId{id});
    for (std::size_t row = 0; row < points.rows(); ++row) {
      double distance = again.offset(FacetId{id}), size = std::abs(distance);
      for (std::size_t k = 0; k < points.dimension; ++k) {
        distance += normal[k] * points.row(row)[k];
        size += std::abs(normal[k] * points.row(row)[k]);
      }
      EXPECT_LE(distance, again.outer_offset(FacetId{id}) + 16.0 * again.roundoff + rounding + 1e-15 * size);
    }
  }
}

TEST(RoundTrip, OfOuterPlanesContainsTheInput) {
  for (std::size_t d = 2; d <= 5; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    expect_round_trip(unit_sphere(100, d, 1), {}, 1e-10);
    expect_round_trip(family_points(PointFamily::kGaussian, 200, d, 2), {}, 1e-10);
    expect_round_trip(moved(unit_sphere(60, d, 3), std::vector<double>(d, 10.0)), {}, 1e-10);
  }
}

TEST(RoundTrip, OfHullsThatALimitEnded) {
  for (const std::uint64_t facets : {100U, 300U, 1000U}) {
    HullOptions options;
    options.limits.max_facets = facets;
    expect_round_trip(unit_sphere(2000, 5, 4), options, 100.0);
  }
}

TEST(RoundTrip, OfHardInputOfFullRank) {
  for (std::size_t d = 2; d <= 4; ++d) {
    for (const DegenerateCase& hard : degenerate_cases(40, d, 23)) {
      SCOPED_TRACE(hard.description);
      const Hull hull = hull_of(hard.points);
      if (hull.rank < d) continue;
      const HalfspaceIntersection region = intersect_planes(outer_planes(hull, hard.points.view()));
      EXPECT_EQ(region.kind, IntersectionKind::kBounded);
      EXPECT_GE(region.volume.value(), hull.volume * (1.0 - 1e-12));
      EXPECT_EQ(region.vertex_count(), hull.vertices.size());
    }
  }
}

TEST(RoundTrip, ThreadsChangeNothing) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 60, 5, 3));
  const PlaneRows planes = exact_planes(hull);
  IntersectionOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const HalfspaceIntersection a = intersect_planes(planes, one), b = intersect_planes(planes, four);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.halfspaces_of.values, b.halfspaces_of.values);
  EXPECT_EQ(a.volume, b.volume);
}

TEST(IntersectionLaw, WhatContainsTheOriginIsNotCalledEmpty) {
  // Duals of points whose columns differ in size by up to 10^60: every plane is below the origin.
  PortableRandom random(3);
  for (int round = 0; round < 300; ++round) {
    const std::size_t d = 2 + static_cast<std::size_t>(round % 2);
    std::vector<double> sizes(d), rows;
    for (double& size : sizes) size = std::pow(10.0, std::floor(10.0 * random.normal()));
    const auto add_row = [&](const std::vector<double>& point) {
      for (std::size_t k = 0; k < d; ++k) rows.push_back(point[k] * sizes[k]);
      rows.push_back(-1.0);
    };
    for (std::size_t k = 0; k < 2 * d; ++k) {
      std::vector<double> axis(d, 0.0);
      axis[k / 2] = k % 2 == 0 ? 1.0 : -1.0;
      add_row(axis);
    }
    for (std::size_t k = 0; k < d; ++k) {
      std::vector<double> point(d);
      for (double& value : point) value = random.normal();
      add_row(point);
    }
    try {
      const HalfspaceIntersection region =
          intersect_halfspaces(PointView::row_major(rows.data(), 3 * d, d + 1));
      EXPECT_NE(region.kind, IntersectionKind::kEmpty) << round;
    } catch (const Error& error) {  // doubles do not tell
      EXPECT_EQ(error.code(), ErrorCode::kBadHalfspace) << error.what();
    }
  }
}

}  // namespace
}  // namespace ndhull
