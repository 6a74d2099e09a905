// Volumes below outer planes: closed forms, and never less than the hull.
#include "approx/polytope/outer_volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

constexpr std::uint64_t kMany = 1'000'000;

/// Named one by one: then their polytope is measured, whatever the hull is.
std::vector<FacetId> all_facets(const Hull& hull) {
  std::vector<FacetId> facets;
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) facets.push_back(FacetId{id});
  return facets;
}

/// The hull's own volume, found both ways.
void expect_own_volume(const Hull& hull) {
  for (const std::vector<FacetId>& facets : {std::vector<FacetId>(), all_facets(hull)}) {
    const OuterVolume outer = outer_volume(hull, facets, {.max_facets = kMany});
    ASSERT_TRUE(outer.volume) << outer.reason;
    EXPECT_GE(*outer.volume, hull.volume * (1.0 - 1e-12));
    EXPECT_NEAR(*outer.volume, hull.volume, 1e-11 * hull.volume);
  }
}

TEST(OuterVolumeExample, OfUnitCubesIsOne) {
  for (std::size_t d = 1; d <= 8; ++d) {
    PointSet corners = cube(d).points;
    for (double& value : corners.coordinates) value = 0.5 + 0.5 * value;
    const OuterVolume outer = outer_volume(hull_of(corners), {}, {.max_facets = kMany});
    ASSERT_TRUE(outer.volume) << "d " << d << ": " << outer.reason;
    EXPECT_NEAR(*outer.volume, 1.0, 1e-11) << "d " << d;
  }
}

// Outer planes of an exact hull are its facets moved by roundoff: vertices in which many facets meet become
// many vertices close together, faces between them almost nothing.
TEST(OuterVolumeLaw, OfExactHullsIsTheirVolume) {
  for (const NamedPolytope& known : small_named_polytopes()) {
    if (known.facets > 3000 || known.rank > 10) continue;
    SCOPED_TRACE(known.name);
    expect_own_volume(hull_of(known.points));
  }
}

TEST(OuterVolumeLaw, HoldsOnHardInput) {
  for (std::size_t d = 2; d <= 5; ++d) {
    for (const DegenerateCase& hard : degenerate_cases(40, d, 17)) {
      SCOPED_TRACE(hard.description + ", d " + std::to_string(d));
      expect_own_volume(hull_of(hard.points));
    }
  }
}

// A point and another 1e-8 beside it, d times: a plate of that thickness, whose planes are moved by 1e-7 of
// it at most. Measured with vertices as they are, faces of the plate were up to a half too large or too
// small.
TEST(OuterVolumeLaw, OfThinPlatesIsTheirVolume) {
  for (std::size_t d = 3; d <= 4; ++d) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE("d " + std::to_string(d) + ", seed " + std::to_string(seed));
      PointSet plate = family_points(PointFamily::kGaussian, 2 * d, d, seed);
      for (std::size_t k = 0; k < d * d; ++k)
        plate.coordinates[d * d + k] = plate.coordinates[k] + 1e-8 * plate.coordinates[d * d + k];
      const Hull hull = hull_of(plate);
      EXPECT_NEAR(outer_volume(hull, all_facets(hull), {.max_facets = kMany}).volume.value(), hull.volume,
                  1e-5 * hull.volume);
    }
  }
}

TEST(OuterVolumeLaw, AreasOfThinPolytopesAreMeasuredToo) {
  // A box of 1 x 2 x 1e-9, turned: the rounding of its planes, over that thickness, moves vertices by some
  // 1e-7. (Up to 4e-7 of the area; without signs it was up to 1e-6.)
  const std::vector<double> sides{0.5, 1.0, 0.5e-9};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Hull hull = hull_of(rotated(axis_scaled(cube(3).points, sides), seed));
    const PlanesAboutOrigin planes = outer_planes_about_interior(hull, {});
    const PolytopeMeasure measure = measure_polytope(planes, intersect_about_origin(planes, {}));
    EXPECT_NEAR(measure.volume, 2e-9, 2e-9 * 1e-5);
    EXPECT_NEAR(measure.area, 2.0 * (2.0 + 3e-9), 1e-6);
  }
}

// Planes that coincide but for their rounding cut the sides of a cube somewhere, and vertices on that cut go
// to the cube's. Without signs volumes were up to 5 % too small or 1 % too large.
TEST(OuterVolumeLaw, PlanesThatNearlyCoincideMeasureAsOne) {
  for (std::size_t d = 3; d <= 10; ++d) {
    for (std::uint64_t seed = 1; seed <= (d < 8 ? 10 : 1); ++seed) {
      SCOPED_TRACE("d " + std::to_string(d) + ", seed " + std::to_string(seed));
      PlanesAboutOrigin planes;
      planes.rank = d;
      const PointSet tilts = family_points(PointFamily::kGaussian, 3 * d, d, seed);
      for (std::size_t row = 0; row < 3 * d; ++row) {  // each third plane is beside the first
        const std::size_t axis = row / 3;
        const double sign = row % 3 == 1 ? -1.0 : 1.0;
        for (std::size_t k = 0; k < d; ++k)
          planes.normals.push_back((k == axis ? sign : 0.0) + 1e-12 * tilts.row(row)[k]);
        planes.heights.push_back(1.0);
      }
      const PolytopeMeasure measure = measure_polytope(planes, intersect_about_origin(planes, {}));
      const double volume = std::ldexp(1.0, static_cast<int>(d));
      EXPECT_NEAR(measure.volume, volume, 1e-9 * volume);
      EXPECT_NEAR(measure.area, static_cast<double>(d) * volume, 1e-9 * static_cast<double>(d) * volume);
    }
  }
}

TEST(OuterVolumeExample, OfSomeSidesOfARotatedCube) {
  // Without the two sides of an axis the prism is open; with one plane across it is bounded again.
  const Hull hull = hull_of(rotated(cube(4).points, 3));
  std::vector<FacetId> sides;
  for (std::uint32_t id = 0; id < 7; ++id) sides.push_back(FacetId{id});
  const OuterVolume open = outer_volume(hull, sides, {.max_facets = kMany});
  EXPECT_FALSE(open.volume);
  EXPECT_EQ(open.reason, "the outer planes do not bound a region");
  sides.push_back(FacetId{7});
  EXPECT_NEAR(outer_volume(hull, sides, {.max_facets = kMany}).volume.value(), 16.0, 1e-10);
}

TEST(OuterVolumeExample, FewerPlanesEncloseMore) {
  const PointSet points = family_points(PointFamily::kSphere, 80, 4, 2);
  const Hull hull = hull_of(points);
  std::vector<FacetId> planes;
  double last = 0.0;
  for (const std::size_t step : {1U, 2U, 4U, 8U}) {
    planes.clear();
    for (std::uint32_t id = 0; id < hull.facet_count(); id += static_cast<std::uint32_t>(step))
      planes.push_back(FacetId{id});
    const OuterVolume outer = outer_volume(hull, planes, {.max_facets = kMany});
    ASSERT_TRUE(outer.volume) << outer.reason;
    EXPECT_GT(*outer.volume, last);
    last = *outer.volume;
  }
  EXPECT_GT(last, 1.05 * hull.volume);
}

TEST(OuterVolumeExample, TooManyVerticesAreAReason) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 60, 5, 2));
  const OuterVolume outer = outer_volume(hull, all_facets(hull), {.max_facets = 100});
  EXPECT_FALSE(outer.volume);
  EXPECT_NE(outer.reason.find("more than about 100 vertices"), std::string::npos) << outer.reason;
}

TEST(OuterVolumeLaw, OfPrismsIsTheirVolume) {
  // Vertices with many facets, far from simple: measured face by face these had volumes wrong in the fifth
  // digit.
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("prism over 30 gaussian points in 5-d, seed " + std::to_string(seed));
    const PointSet base = family_points(PointFamily::kGaussian, 30, 5, seed);
    PointSet prism{6, {}, {}};
    for (const double level : {0.0, 1.0}) {
      for (std::size_t row = 0; row < base.rows(); ++row) {
        prism.coordinates.insert(prism.coordinates.end(), base.row(row).begin(), base.row(row).end());
        prism.coordinates.push_back(level);
      }
    }
    const Hull hull = hull_of(prism);
    const OuterVolume outer = outer_volume(hull, {}, {.max_facets = kMany});
    ASSERT_TRUE(outer.volume) << outer.reason;
    EXPECT_NEAR(*outer.volume, hull.volume, 1e-11 * hull.volume);
    EXPECT_NEAR(hull.volume, hull_of(base).volume, 1e-11 * hull.volume);
  }
}

TEST(OuterVolumeExample, WithoutALimitThereIsAlwaysAVolume) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 60, 5, 2));
  const OuterVolume one = outer_volume(hull, all_facets(hull), {}, 1);
  EXPECT_NEAR(one.volume.value(), hull.volume, 1e-11 * hull.volume);
  EXPECT_EQ(outer_volume(hull, all_facets(hull), {}, 3).volume, one.volume);
}

TEST(OuterVolumeExample, ARequestToStopIsAReason) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 60, 5, 2));
  std::stop_source source;
  source.request_stop();
  const OuterVolume outer = outer_volume(hull, all_facets(hull), {}, 1, source.get_token());
  EXPECT_FALSE(outer.volume);
  EXPECT_EQ(outer.reason, "interrupted");
}

TEST(OuterVolumeExample, TheLimitOnSecondsIsAReason) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 60, 5, 2));
  const OuterVolume outer = outer_volume(hull, all_facets(hull), {.max_seconds = 1e-9}, 1);
  EXPECT_FALSE(outer.volume);
  EXPECT_EQ(outer.reason, "it would take longer than the limit on seconds");
  EXPECT_TRUE(outer_volume(hull, all_facets(hull), {.max_seconds = 100.0}, 1).volume);
}

TEST(OuterVolumeExample, TheLimitOnMemoryIsAReason) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 60, 5, 2));
  for (const std::uint64_t bytes : {1u, 200'000u}) {
    const OuterVolume outer = outer_volume(hull, all_facets(hull), {.max_memory_bytes = bytes}, 1);
    EXPECT_FALSE(outer.volume);
    EXPECT_EQ(outer.reason, "it would take more memory than there is for it");
  }
  EXPECT_TRUE(outer_volume(hull, all_facets(hull), {.max_memory_bytes = 1'000'000'000}, 1).volume);
}

TEST(OuterVolumeExample, MeasuringEndsWithTheLimitToo) {
  const Hull hull = hull_of(family_points(PointFamily::kSphere, 60, 5, 2));
  const PlanesAboutOrigin planes = outer_planes_about_interior(hull, {});
  const PlanePolytope polytope = intersect_about_origin(planes, {});
  EXPECT_EQ(measure_polytope(planes, polytope, {.limits = {.max_seconds = 1e-9}}).status,
            HullStatus::kTimeLimit);
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(measure_polytope(planes, polytope, {.stop = source.get_token()}).status,
            HullStatus::kInterrupted);
  EXPECT_EQ(measure_polytope(planes, polytope).status, HullStatus::kComplete);
}

TEST(OuterVolumeLaw, WhatIsAffordableGrowsWithTheHullAndShrinksWithTheRankAndTheMemory) {
  std::uint64_t last = UINT64_MAX;
  for (std::size_t d = 2; d <= 9; ++d) {
    const Hull hull = hull_of(family_points(PointFamily::kSphere, d + 3, d, 1));
    const std::uint64_t simplices = affordable_simplices(hull);
    EXPECT_GE(simplices, 500U);
    EXPECT_LT(simplices, last);
    last = simplices;
  }
  Hull hull = hull_of(family_points(PointFamily::kSphere, 20, 5, 1));
  const std::uint64_t alone = affordable_simplices(hull);
  EXPECT_EQ(affordable_simplices(hull, {.max_memory_bytes = 1'000'000'000}), alone);
  EXPECT_LT(affordable_simplices(hull, {.max_memory_bytes = 1'000'000}), 10'000U);
  EXPECT_EQ(affordable_simplices(hull, {.max_memory_bytes = 1}), 1U);
  hull.statistics.created_simplices = 20'000'000;
  EXPECT_EQ(affordable_simplices(hull) / alone, 40U);
}

}  // namespace
}  // namespace ndhull
