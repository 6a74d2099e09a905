// Outer planes chosen for the volume that they enclose: never more than the largest facets do.
#include "approx/selection/volume_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "approx/polytope/outer_volume.h"
#include "approx/selection/facet_selection.h"
#include "approx/selection/ray_gains_kernel.h"
#include "core/error.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

double enclosed(const Hull& hull, const std::vector<FacetId>& facets) {
  const OuterVolume outer = outer_volume(hull, facets, {}, 1);
  EXPECT_TRUE(outer.volume) << outer.reason;
  return outer.volume.value_or(0.0);
}

// One plane and one ray at a time, as the formula is written.
TEST(RayGainsOracle, VectorsAddWhatTheFormulaSays) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (const std::size_t rank : {2U, 3U, 8U, 13U}) {
    SCOPED_TRACE("rank " + std::to_string(rank));
    std::vector<double> planes(rank * kGainBlock), gains(kGainBlock), expected;
    for (double& value : planes) value = normal(random);
    for (double& value : gains) value = normal(random);
    expected = gains;
    RayChanges changes;
    for (std::size_t ray = 0; ray < 50; ++ray) {
      for (std::size_t k = 0; k < rank; ++k) changes.directions.push_back(normal(random));
      const double a = 0.1 + std::abs(normal(random)), b = 0.1 + std::abs(normal(random));
      changes.lower.push_back(std::min(a, b));
      changes.upper.push_back(ray % 5 == 0 ? HUGE_VAL : std::max(a, b));
      changes.difference.push_back(normal(random));
      changes.sign.push_back(ray % 2 == 0 ? 1.0 : -1.0);
      changes.shorter.push_back(0.3 * std::abs(normal(random)));
    }
    std::size_t behind = 0, between = 0, first = 0;
    for (std::size_t plane = 0; plane < kGainBlock; ++plane) {
      for (std::size_t ray = 0; ray < changes.count(); ++ray) {
        double slope = 0.0;
        for (std::size_t k = 0; k < rank; ++k)
          slope += changes.directions[ray * rank + k] * planes[k * kGainBlock + plane];
        if (slope <= changes.lower[ray]) {
          ++behind;
        } else if (slope >= changes.upper[ray]) {
          ++first;
          expected[plane] += changes.difference[ray];
        } else {
          ++between;
          double content = 1.0;
          for (std::size_t k = 0; k < rank; ++k) content /= slope;
          expected[plane] += changes.difference[ray] - changes.sign[ray] * (content - changes.shorter[ray]);
        }
      }
    }
    EXPECT_TRUE(behind > 0 && between > 0 && first > 0);
    add_ray_gains(planes.data(), rank, changes, gains.data());
    for (std::size_t plane = 0; plane < kGainBlock; ++plane)
      EXPECT_NEAR(gains[plane], expected[plane], 1e-11 * (1.0 + std::abs(expected[plane])));
  }
}

TEST(VolumeSelectionLaw, TwentyPlanesEncloseNoMoreThanTheTwentyLargestAndThoseThatCloseThem) {
  std::size_t inputs = 0;
  for (std::size_t d = 4; d <= 7; ++d) {
    const std::size_t count = d < 6 ? 100 : 40;
    for (const PointFamily family : {PointFamily::kSphere, PointFamily::kGaussian, PointFamily::kCube}) {
      const Hull hull = hull_of(family_points(family, count, d, d));
      SCOPED_TRACE("input " + std::to_string(inputs++) + ", d " + std::to_string(d));
      const FacetSelection largest = select_facets(hull, {.largest = 20, .bounded = true});
      const FacetSelection chosen =
          select_facets(hull, {.largest = 20, .measure = SelectionMeasure::kVolume});
      EXPECT_EQ(chosen.facets.size(), 20U);
      EXPECT_TRUE(chosen.bounded);
      EXPECT_TRUE(std::is_sorted(chosen.facets.begin(), chosen.facets.end()));
      EXPECT_LE(enclosed(hull, chosen.facets), enclosed(hull, largest.facets));
      EXPECT_GT(enclosed(hull, chosen.facets), hull.volume);
    }
  }
  EXPECT_GE(inputs, 10U);
}

// What Qhull's C0.01 and W0.1 C0.01 leave of these hulls encloses 4.2, 27, 3.6 and 13 % too much; the best of
// several plain choices among the exact planes (medoids, spread normals, largest areas) 4.5, 6.0, 3.5 and 5.3
// %.
TEST(VolumeSelectionLaw, HundredsOfPlanesLeaveLittleOverTheHull) {
  struct Wanted {
    const char* rbox;
    std::uint64_t count;
    double excess;
  };
  for (const Wanted& wanted : {Wanted{"200 s D5 t1", 425, 0.045}, Wanted{"400 D5 t1", 375, 0.042}}) {
    const Hull hull = hull_of(rbox(wanted.rbox));
    const std::vector<FacetId> chosen = choose_for_volume(hull, wanted.count);
    EXPECT_EQ(chosen.size(), wanted.count);
    EXPECT_LE(enclosed(hull, chosen) / hull.volume - 1.0, wanted.excess) << wanted.rbox;
  }
}

TEST(VolumeSelectionExample, TheSidesOfABoxAreFoundAmongManyFacets) {
  // A cube whose corners are cut off: its 10 sides and 32 small facets.
  PointSet cut;
  cut.dimension = 5;
  for (unsigned corner = 0; corner < 32; ++corner) {
    for (std::size_t moved = 0; moved < 5; ++moved) {
      for (std::size_t k = 0; k < 5; ++k) {
        const double sign = (corner >> k & 1U) != 0 ? 1.0 : -1.0;
        cut.coordinates.push_back(k == moved ? 0.75 * sign : sign);
      }
    }
  }
  const Hull hull = hull_of(cut);
  ASSERT_EQ(hull.facet_count(), 42U);
  const std::vector<FacetId> chosen = choose_for_volume(hull, 10);
  ASSERT_EQ(chosen.size(), 10U);
  EXPECT_NEAR(enclosed(hull, chosen), 32.0, 1e-10);
}

TEST(VolumeSelectionLaw, TheResultDoesNotDependOnThreadsOrUnits) {
  const PointSet points = family_points(PointFamily::kSphere, 60, 5, 4);
  const Hull hull = hull_of(points, {.threads = 1});
  const std::vector<FacetId> chosen = choose_for_volume(hull, 12);
  EXPECT_EQ(choose_for_volume(hull_of(points, {.threads = 3}), 12), chosen);
  const std::vector<double> factors{0x1p-40, 1.0, 0x1p40, 0x1p3, 0x1p-7};
  const Hull scaled = hull_of(axis_scaled(points, factors));
  const double share = enclosed(hull, chosen) / hull.volume;
  const double scaled_share = enclosed(scaled, choose_for_volume(scaled, 12)) / scaled.volume;
  EXPECT_NEAR(scaled_share / share, 1.0, 0.3);
}

TEST(VolumeSelectionLaw, HardInputIsEnclosed) {
  for (std::size_t d = 2; d <= 4; ++d) {
    for (const DegenerateCase& hard : degenerate_cases(40, d, 11)) {
      SCOPED_TRACE(hard.description + ", d " + std::to_string(d));
      const Hull hull = hull_of(hard.points);
      if (hull.rank == 0) continue;
      const std::size_t count = std::min(hull.rank + 3, hull.facet_count());
      const FacetSelection chosen =
          select_facets(hull, {.largest = count, .measure = SelectionMeasure::kVolume});
      EXPECT_TRUE(chosen.bounded);
      EXPECT_GE(chosen.facets.size(), count);
      // More only where none can be spared.
      for (std::size_t left_out = 0; chosen.facets.size() > count && left_out <= count; ++left_out) {
        std::vector<FacetId> fewer = chosen.facets;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(left_out));
        EXPECT_EQ(outer_volume(hull, fewer, {}, 1).reason, "the outer planes do not bound a region");
      }
    }
  }
}

TEST(VolumeSelectionExample, AllFacetsNoneAndTooFew) {
  const Hull hull = hull_of(cube(4).points);
  EXPECT_EQ(choose_for_volume(hull, 8).size(), 8U);
  EXPECT_EQ(choose_for_volume(hull, 100).size(), 8U);
  EXPECT_EQ(choose_for_volume(hull, 5).size(), 8U);
  try {
    choose_for_volume(hull, 4);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("at least 5"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(choose_for_volume(hull_of({.dimension = 2, .coordinates = {1.0, 2.0}}), 3).empty());
}

}  // namespace
}  // namespace ndhull
