// Inputs on which hull programs lose points, facets or precision: narrow, nearly coplanar, far away, uneven.
#include <cmath>

#include "core/portable_random.h"
#include "tests/hull/exact_oracle.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

/// Complete, nothing outside, and no facet wider than 1e-11 of the input's extent.
void expect_tight(const PointSet& set) {
  const Hull hull = hull_of(set);
  EXPECT_EQ(hull.status, HullStatus::kComplete);
  EXPECT_EQ(hull.points_outside, 0U);
  EXPECT_LT(hull.max_facet_width, 1e-11 * extent_of(set));
  EXPECT_LT(hull.max_outside_gauge, 1e-11);
  expect_sound(hull, set);
}

class NarrowInputs : public ::testing::TestWithParam<const char*> {};

TEST_P(NarrowInputs, LeaveNoPointOutside) {
  for (int seed = 1; seed <= 10; ++seed) {
    const std::string arguments = std::string(GetParam()) + " t" + std::to_string(seed);
    SCOPED_TRACE("rbox " + arguments);
    expect_tight(rbox(arguments));
  }
}

INSTANTIATE_TEST_SUITE_P(HullRegression, NarrowInputs,
                         ::testing::Values("1000 W1e-13 D5", "1000 W1e-13 D6", "1000 s Z1 G1e-13 D5",
                                           "400 s Z1 G1e-13 D6", "500 W0 C1,2e-13 D6", "300 C1,1e-13 D5 s",
                                           "1000 C1,1e-13 D4 s", "1000 L100000 s G1e-16 D4",
                                           "10000 W1e-13 D4"));

// The map into the frame has entries as large as the extent over the thickness, which cancel.
TEST(HullRegression, ThinSlabsAcrossTheAxesHaveFacetsAsNarrowAsRoundingLetsThem) {
  for (const double thickness : {1e-6, 1e-8, 1e-10, 1e-12}) {
    for (const std::size_t d : {3U, 4U, 5U, 6U}) {
      SCOPED_TRACE(std::to_string(d) + "-d, thickness " + std::to_string(1e12 * thickness) + "e-12");
      PortableRandom random(d);
      std::size_t corners = 1;
      for (std::size_t k = 1; k < d; ++k) corners *= 3;
      PointSet set;
      set.dimension = d;
      for (std::size_t i = 0; i < 3 * corners; ++i) {  // a grid of three values, each corner three times
        double sum = 0.0;
        for (std::size_t k = 1, rest = i; k < d; ++k, rest /= 3) {
          set.coordinates.push_back(static_cast<double>(rest % 3));
          if (k < 3) sum += set.coordinates.back();
        }
        set.coordinates.push_back(sum + thickness * random.unit());
      }
      const Hull hull = hull_of(set);
      expect_sound(hull, set);
      EXPECT_LT(hull.max_facet_width, 1e-13);
    }
  }
}

TEST(HullRegression, WidthsBetweenRoundoffAndShiftLeaveNoPointOutside) {
  for (const char* width : {"0", "1e-16", "1e-15", "1e-14", "1e-12", "1e-11", "1e-10"}) {
    for (const char* shape : {"400 D4 W", "300 D5 W", "200 D6 W", "300 s Z1 D5 G"}) {
      for (int seed = 1; seed <= 2; ++seed) {
        const std::string arguments = std::string(shape) + width + " t" + std::to_string(seed);
        SCOPED_TRACE("rbox " + arguments);
        expect_tight(rbox(arguments));
      }
    }
  }
}

TEST(HullRegression, DuplicatedPointsAreOneVertex) {
  for (std::size_t d = 2; d <= 7; ++d) {
    SCOPED_TRACE("gaussian, n 30, d " + std::to_string(d) + ", seed 2, each row twice or more");
    const PointSet set = family_points(PointFamily::kGaussian, 30, d, 2);
    const Hull hull = hull_of(set);
    PointSet twice = set;
    twice.coordinates.insert(twice.coordinates.end(), set.coordinates.begin(), set.coordinates.end());
    for (const PointSet& copies : {twice, with_duplicates(set, 200, 3), permuted_rows(twice, 4)}) {
      const Hull same = hull_of(copies);
      EXPECT_EQ(same.facet_count(), hull.facet_count());
      EXPECT_EQ(same.vertices.size(), hull.vertices.size());
      EXPECT_NEAR(same.volume, hull.volume, 1e-12 * hull.volume);
      expect_sound(same, copies);
    }
    const NamedPolytope known = cube(d);
    const PointSet corners = with_duplicates(known.points, 300, 5);
    const Hull cubic = hull_of(corners);
    EXPECT_EQ(cubic.facet_count(), known.facets);
    EXPECT_EQ(cubic.vertices.size(), known.vertices);
    expect_sound(cubic, corners);
  }
}

TEST(HullRegression, PointsAnUlpFromDuplicatesAreKeptWithinTheWidth) {
  for (std::size_t d = 3; d <= 6; ++d) {
    SCOPED_TRACE("gaussian, n 60, d " + std::to_string(d) + ", seed 6, with copies an ulp off");
    PointSet set = family_points(PointFamily::kGaussian, 60, d, 6);
    const PointSet off = moved_by_one_ulp(set, 7);
    set.coordinates.insert(set.coordinates.end(), off.coordinates.begin(), off.coordinates.end());
    expect_tight(set);
  }
}

// The doubles are what counts: rounded to a lattice of 1e-10 or 1e-4, a sphere is still in general position.
TEST(HullRegression, SpherePointsFarFromTheOriginHaveTheFacetsOfTheirDoubles) {
  for (const double offset : {1e6, 1e12}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE("sphere, n 300, d 5, seed " + std::to_string(seed) + ", moved by " +
                   std::to_string(offset));
      const PointSet set =
          moved(family_points(PointFamily::kSphere, 300, 5, seed), std::vector<double>(5, offset));
      const Hull hull = hull_of(set);
      EXPECT_EQ(facet_sets(hull), facets_by_cgal(set));
      EXPECT_LT(hull.max_facet_width, 1e-11 * extent_of(set));
      expect_sound(hull, set);
    }
  }
}

TEST(HullRegression, FarNarrowAndUnevenInputsAreTight) {
  for (std::size_t d = 3; d <= 6; ++d) {
    const PointSet set = family_points(PointFamily::kCubeSurface, 150, d, 12);
    SCOPED_TRACE("cube surface, n 150, d " + std::to_string(d) + ", seed 12, moved or stretched");
    expect_tight(moved(rotated(set, 13), std::vector<double>(d, 1e9)));
    for (const double power : {4.0, 8.0, 15.0}) {
      std::vector<double> factors(d);
      for (std::size_t k = 0; k < d; ++k) factors[k] = std::pow(10.0, k % 2 == 0 ? power : -power);
      SCOPED_TRACE("columns times 1e" + std::to_string(power) + " and its inverse in turn");
      expect_tight(axis_scaled(set, factors));
      expect_tight(axis_scaled(rotated(set, 14), factors));
    }
  }
}

// In units of the thinnest column the widths are as small as in those of the widest.
TEST(HullRegression, UnevenColumnsAreTightInTheUnitCube) {
  for (std::size_t d = 3; d <= 6; ++d) {
    std::vector<double> factors(d);
    for (std::size_t k = 0; k < d; ++k) factors[k] = std::pow(10.0, 5.0 * static_cast<double>(k) - 10.0);
    const PointSet set = axis_scaled(family_points(PointFamily::kSphere, 100, d, 15), factors);
    SCOPED_TRACE("sphere, n 100, d " + std::to_string(d) + ", seed 15, columns 1e-10 .. 1e" +
                 std::to_string(5 * d - 15));
    const Hull hull = hull_of(set, {.unit_cube = true});
    EXPECT_EQ(facet_sets(hull), facets_by_cgal(set));
    EXPECT_LT(hull.max_facet_width, 1e-11);
    EXPECT_EQ(hull.unit_cube_extents().size(), d);
    expect_sound(hull, set);
  }
}

TEST(HullRegression, SlabsOfAnyThicknessKeepTheirVolume) {
  for (const double thickness : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14}) {
    for (std::size_t d = 3; d <= 6; ++d) {
      SCOPED_TRACE("cube of thickness " + std::to_string(std::log10(thickness)) + " (log10), d " +
                   std::to_string(d));
      std::vector<double> factors(d, 1.0);
      factors[d - 1] = thickness;
      const NamedPolytope known = cube(d);
      const PointSet set = axis_scaled(known.points, factors);
      const Hull hull = hull_of(set);
      EXPECT_EQ(hull.rank, d);
      EXPECT_EQ(hull.facet_count(), known.facets);
      EXPECT_NEAR(hull.volume, *known.volume * thickness, 1e-9 * *known.volume * thickness);
      expect_tight(slab(100, d, thickness, 4));
    }
  }
}

/// Elimination without pivots can lose the digits of a simplex' volume and keep those of its plane.
TEST(HullRegression, GridPointsMovedByRoundingKeepTheirVolume) {
  for (const std::size_t d : {3U, 4U, 5U, 6U}) {
    for (std::uint64_t seed = 1; seed <= 600; ++seed) {
      PortableRandom random(100 * seed + d);
      PointSet grid, moved;
      grid.dimension = moved.dimension = d;
      for (std::size_t i = 0; i < (d + 4) * d; ++i) {
        const double x = static_cast<double>(random.below(3)) - 1.0;
        grid.coordinates.push_back(x);
        moved.coordinates.push_back(x + 1e-12 * random.normal());
      }
      const Hull expected = hull_of(grid);
      if (expected.rank < d) continue;
      SCOPED_TRACE("d " + std::to_string(d) + ", seed " + std::to_string(seed));
      const Hull hull = hull_of(moved);
      EXPECT_NEAR(hull.volume, expected.volume, 1e-9 * expected.volume);
      EXPECT_NEAR(hull.area, expected.area, 1e-9 * expected.area);
    }
  }
}

}  // namespace
}  // namespace ndhull
