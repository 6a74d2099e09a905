// Widths about as large as a hull is thin: few slabs hold all of it, and do not bound a region.
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "approx/polytope/outer_volume.h"
#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

/// Points of a family, each column times its scale.
PointSet scaled_points(const FamilySize& shape, std::span<const double> scales) {
  PointSet set = family_points(shape.family, shape.n, shape.d, 20261127);
  for (std::size_t i = 0; i < set.coordinates.size(); ++i) set.coordinates[i] *= scales[i % shape.d];
  return set;
}

struct ThinShape {
  FamilySize shape;
  std::vector<double> scales;
};

std::vector<ThinShape> thin_shapes() {
  return {{{PointFamily::kSphere, 1000, 6}, {1.0, 1.0, 1.0, 1.0, 1.0, 0.01}},
          {{PointFamily::kSphere, 2000, 5}, {1.0, 1.0, 1.0, 0.02, 0.01}},
          {{PointFamily::kBall, 800, 6}, {1.0, 0.9, 0.8, 0.7, 0.02, 0.6}},
          {{PointFamily::kSphere, 300, 7}, {1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05}},
          {{PointFamily::kGaussian, 400, 5}, {1.0, 0.01, 1.0, 1.0, 1.0}},
          {{PointFamily::kSphere, 3000, 4}, {1.0, 1.0, 1.0, 0.01}}};
}

TEST(ThinHullLaw, WidthIsMetBeyondTheThickness) {
  for (const ThinShape& thin : thin_shapes()) {
    const PointSet set = scaled_points(thin.shape, thin.scales);
    for (const double percent : {1.0, 2.0, 5.0}) {
      SCOPED_TRACE(std::string(to_string(thin.shape.family)) + " " + std::to_string(thin.shape.d) + "-d, " +
                   std::to_string(percent) + "%");
      HullOptions options;
      options.accuracy.width = {percent, true};
      const Hull hull = hull_of(set, options);
      EXPECT_EQ(hull.status, HullStatus::kComplete);
      EXPECT_LE(hull.max_facet_width, 0.01 * percent * extent_of(set));
      expect_approximate_laws(hull, set.view());
    }
  }
}

// What closes the region are facets of the hull of all points, found at once: growth does not creep around
// the rim, which would take as many rounds as there may be, and then be too wide.
TEST(ThinHullLaw, FewRoundsCloseTheRegion) {
  const ThinShape lens = thin_shapes().front();
  const PointSet set = scaled_points(lens.shape, lens.scales);
  HullOptions options;
  options.accuracy.width = {2.0, true};
  const Hull hull = hull_of(set, options), exact = hull_of(set, HullOptions());
  EXPECT_LE(hull.statistics.repair_rounds, 10U);
  EXPECT_LE(hull.facet_count(), 3 * hull.rank);
  EXPECT_LT(10 * hull.simplex_count(), exact.simplex_count());
}

// Growth pauses where simplices become many and nothing is far outside: the facets that close the region have
// to be grown all the same.
TEST(ThinHullLaw, WidthIsMetWhereGrowthPauses) {
  const PointSet set = scaled_points({PointFamily::kSphere, 960, 8},
                                     std::vector<double>{0.023, 1.0, 1.0, 0.0235, 0.61, 1.0, 1.0, 1.0});
  HullOptions options;
  options.accuracy.width = {2.4, true};
  const Hull hull = hull_of(set, options);
  EXPECT_LE(hull.max_facet_width, 0.024 * extent_of(set));
  EXPECT_GE(hull.simplex_count(), 150'000U);
  EXPECT_EQ(hull.points_outside, 0U);
}

// Points that share planes: a facet that closes the region may be divided into other simplices.
TEST(ThinHullLaw, WidthIsMetWherePointsSharePlanes) {
  for (const double step : {0.05, 0.1, 0.25}) {
    PointSet set = family_points(PointFamily::kBall, 3000, 5, 7);
    for (std::size_t i = 0; i < set.coordinates.size(); ++i)
      set.coordinates[i] = std::round(set.coordinates[i] / step) * step * (i % 5 == 4 ? 0.02 : 1.0);
    for (const double percent : {1.0, 2.0, 4.0}) {
      SCOPED_TRACE(std::to_string(step) + ", " + std::to_string(percent) + "%");
      HullOptions options;
      options.accuracy.width = {percent, true};
      const Hull hull = hull_of(set, options);
      EXPECT_LE(hull.max_facet_width, 0.01 * percent * extent_of(set));
      expect_approximate_laws(hull, set.view());
    }
  }
}

// Few wide facets of a cross-polytope may all be parallel to an axis but for rounding, which closes nothing.
TEST(RegionLaw, CrossPolytopesAreClosedByMoreThanRounding) {
  for (const std::size_t d : {3U, 4U, 5U, 6U}) {
    PointSet set{d, std::vector<double>(2 * d * d, 0.0), ""};
    for (std::size_t row = 0; row < 2 * d; ++row) set.row(row)[row % d] = row < d ? 1.0 : -1.0;
    std::vector<HullOptions> tried;
    for (std::uint64_t facets = d + 1; facets < std::uint64_t{1} << d; ++facets)
      tried.emplace_back().accuracy.facets = facets;
    for (const double width : {0.3, 0.45, 0.55, 0.58, 0.6, 0.7, 0.9})
      tried.emplace_back().accuracy.width = {width, false};
    for (const HullOptions& options : tried) {
      SCOPED_TRACE(std::to_string(d) + "-d, " + std::to_string(options.accuracy.facets) + " facets, width " +
                   std::to_string(options.accuracy.width.value));
      const Hull hull = hull_of(set, options);
      const OuterVolume outer = outer_volume(hull, {});
      ASSERT_TRUE(outer.volume.has_value()) << outer.reason;
      EXPECT_LT(*outer.volume, 1e9 * hull.volume);
    }
  }
}

// So may those of corners of a cube be balanced by the tilt alone that fits gave them, and those of a few
// simplices that a limit left.
TEST(RegionLaw, CornersOfCubesAreClosedByMoreThanTilts) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::size_t d = 4 + seed % 3;
    const PointSet set = family_points(PointFamily::kCubeCorners, 40 + seed % 30, d, seed);
    std::vector<HullOptions> tried(4);
    tried[0].accuracy.width = {70.0 + static_cast<double>(seed), true};
    tried[1].accuracy.width = {106.0 + static_cast<double>(seed % 20), true};
    tried[1].accuracy.outside_width = {116.0 + static_cast<double>(seed % 20), true};
    tried[2].accuracy.width = {5.0, true};
    tried[2].limits.max_facets = 1 + seed % 29;
    tried[3].accuracy.facets = d + 1 + seed % 5;
    for (std::size_t i = 0; i < tried.size(); ++i) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", option " + std::to_string(i));
      const Hull hull = hull_of(set, tried[i]);
      const OuterVolume outer = outer_volume(hull, {});
      ASSERT_TRUE(outer.volume.has_value()) << outer.reason;
      EXPECT_LT(*outer.volume, 1e9 * hull.volume);
    }
  }
}

// A facet of one simplex is one of the simplicial ones, whatever found it.
TEST(RegionLaw, FacetsOfOneSimplexAreSimplicialUnderAWidth) {
  const PointSet set = family_points(PointFamily::kSphere, 60, 5, 3);
  for (const double percent : {2.0, 5.0, 20.0}) {
    for (const bool counts : {false, true}) {
      HullOptions options;
      options.accuracy.width = {percent, true};
      Hull hull = hull_of(set, options);
      if (counts) {
        options.accuracy.facets = hull.facet_count();
        options.accuracy.width = {};
        hull = hull_of(set, options);
      }
      SCOPED_TRACE(percent);
      std::size_t alone = 0;
      for (std::uint32_t facet = 0; facet < hull.facet_count(); ++facet)
        if (hull.simplex_count_of(FacetId{facet}) == 1) ++alone;
      EXPECT_EQ(hull.simplicial_facet_count(), alone);
    }
  }
}

/// Correlated gaussian points, too many for the exact hull in 9-d. `turns` makes another mixture of columns.
PointSet correlated_points(double turns) {
  constexpr std::size_t kPoints = 400, kColumns = 9;
  const PointSet round = family_points(PointFamily::kGaussian, 700, kColumns, 5);
  PointSet mixed = round;
  mixed.coordinates.assign(kPoints * kColumns, 0.0);
  for (std::size_t i = 0; i < kPoints; ++i) {
    for (std::size_t j = 0; j < kColumns; ++j) {
      const double* row = round.coordinates.data() + i * kColumns;
      for (std::size_t k = 0; k < kColumns; ++k) {
        const auto place = static_cast<double>(kColumns * k + j);
        mixed.coordinates[i * kColumns + j] += row[k] * std::cos(turns * place * place);
      }
    }
  }
  return mixed;
}

/// At its rim points are left out far above simplices. Growth for a number of facets used to end with what it
/// had then: 10 facets of 1.74 and 1.14.
TEST(ApproximateHullRegression, ANumberOfFacetsOfAThinHullIsNotGivenUp) {
  const auto width_of = [](const PointSet& set, std::uint64_t facets) {
    HullOptions options;
    options.accuracy.facets = facets;
    const Hull hull = hull_of(set, options);
    EXPECT_LE(hull.facet_count(), facets);
    expect_approximate_laws(hull, set.view());
    return hull.max_facet_width;
  };
  EXPECT_LT(width_of(correlated_points(1.0), 100), 0.9);
  EXPECT_LT(width_of(correlated_points(3.0), 20), 0.7);
}

}  // namespace
}  // namespace ndhull
