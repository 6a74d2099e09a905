// The same facets as programs that decide in exact arithmetic, and as Qhull where data are generic.
#include "tests/hull/exact_oracle.h"

#include "core/portable_random.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

constexpr PointFamily kRandomFamilies[] = {PointFamily::kSphere, PointFamily::kBall, PointFamily::kGaussian,
                                           PointFamily::kCube};

/// Distinct points of {0, .., side-1}^d: facets with many points, exactly.
PointSet distinct_integers(std::size_t n, std::size_t d, std::size_t side, std::uint64_t seed) {
  PortableRandom random(seed);
  std::set<std::vector<double>> rows;
  while (rows.size() < n) {
    std::vector<double> row(d);
    for (double& value : row) value = static_cast<double>(random.below(side));
    rows.insert(row);
  }
  PointSet set{d, {}, {}};
  for (const auto& row : rows) set.coordinates.insert(set.coordinates.end(), row.begin(), row.end());
  return set;
}

void expect_same_facets(const std::vector<VertexSet>& expected, const PointSet& set) {
  const Hull hull = hull_of(set);
  EXPECT_EQ(facet_sets(hull), expected);
  expect_sound(hull, set);
}

// In high dimensions the rational numbers grow long: fewer points there.
TEST(HullOracle, BruteForceOverAllSubsetsFindsTheSameFacets) {
  for (std::size_t d = 3; d <= 8; ++d) {
    const std::size_t n = d <= 4 ? 12 : 10;
    for (const PointFamily family : kRandomFamilies) {
      SCOPED_TRACE(std::string(to_string(family)) + ", n " + std::to_string(n) + ", d " + std::to_string(d) +
                   ", seed 1");
      const PointSet set = family_points(family, n, d, 1);
      expect_same_facets(facets_by_brute_force(set), set);
    }
  }
}

TEST(HullOracle, BruteForceFindsTheSameFacetsOfSmallIntegers) {
  for (std::size_t d = 3; d <= 6; ++d) {
    for (const std::size_t side : {2U, 3U, 4U}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const std::size_t n = d == 3 && side == 2 ? 7 : 12;
        SCOPED_TRACE("integers below " + std::to_string(side) + ", n " + std::to_string(n) + ", d " +
                     std::to_string(d) + ", seed " + std::to_string(seed));
        const PointSet set = distinct_integers(n, d, side, seed);
        const Hull hull = hull_of(set);
        if (hull.rank < d) continue;
        expect_same_facets(facets_by_brute_force(set), set);
      }
    }
  }
}

TEST(HullOracle, ExactTriangulationsHaveTheSameFacets) {
  const struct { std::size_t d, n; } sizes[] = {{3, 300}, {4, 120}, {5, 60}, {6, 35}, {7, 24}};
  for (const auto& size : sizes) {
    for (const PointFamily family : kRandomFamilies) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE(std::string(to_string(family)) + ", n " + std::to_string(size.n) + ", d " +
                     std::to_string(size.d) + ", seed " + std::to_string(seed));
        const PointSet set = family_points(family, size.n, size.d, seed);
        expect_same_facets(facets_by_cgal(set), set);
      }
    }
  }
}

TEST(HullOracle, ExactTriangulationsHaveTheSameFacetsOfTransformedSets) {
  for (std::size_t d = 3; d <= 6; ++d) {
    const std::size_t n = d <= 4 ? 100 : 40;
    const PointSet sphere = family_points(PointFamily::kSphere, n, d, 9);
    std::vector<double> factors(d, 1.0);
    for (std::size_t k = 0; k < d; ++k) factors[k] = k % 2 == 0 ? 1e-8 : 1e8;
    for (const PointSet& set : {moved(sphere, std::vector<double>(d, 1e6)), axis_scaled(sphere, factors),
                                axis_scaled(rotated(sphere, 4), factors)}) {
      SCOPED_TRACE("sphere, n " + std::to_string(n) + ", d " + std::to_string(d) +
                   ", seed 9: moved by 1e6; stretched by 1e-8, 1e8; rotated with 4 and stretched");
      expect_same_facets(facets_by_cgal(set), set);
    }
  }
}

TEST(HullOracle, QhullCountsTheSameFacetsOfGenericSets) {
  const struct { std::size_t d, n; } sizes[] = {{3, 2000}, {4, 1000}, {5, 500}, {6, 200}, {7, 80}, {8, 40}};
  for (const auto& size : sizes) {
    for (const PointFamily family : kRandomFamilies) {
      for (std::uint64_t seed = 11; seed <= 12; ++seed) {
        SCOPED_TRACE(std::string(to_string(family)) + ", n " + std::to_string(size.n) + ", d " +
                     std::to_string(size.d) + ", seed " + std::to_string(seed));
        const PointSet set = family_points(family, size.n, size.d, seed);
        EXPECT_EQ(hull_of(set).facet_count(), facet_count_by_qhull(set));
      }
    }
  }
}

/// What Qhull counts for `rbox ARGUMENTS | qhull`.
void expect_published(const std::string& arguments, std::uint64_t facets) {
  const PointSet set = rbox(arguments);
  const Hull hull = hull_of(set);
  EXPECT_EQ(hull.facet_count(), facets) << arguments;
  EXPECT_EQ(hull.status, HullStatus::kComplete);
  EXPECT_EQ(hull.points_outside, 0U);
  EXPECT_LT(hull.max_facet_width, 1e-11 * extent_of(set));
}

TEST(HullOracle, QhullCountOfSpherePointsIn5D) { expect_published("2000 s D5 t1", 56576); }
TEST(HullOracle, QhullCountOfSpherePointsIn6D) { expect_published("1000 s D6 t1", 128150); }
TEST(HullOracle, QhullCountOfSpherePointsIn7D) { expect_published("500 s D7 t1", 269018); }
TEST(HullOracle, QhullCountOfSpherePointsIn8D) { expect_published("300 s D8 t1", 594248); }
TEST(HullOracle, QhullCountOfSpherePointsIn9D) { expect_published("150 s D9 t1", 690872); }
TEST(HullOracle, QhullCountOfSpherePointsIn10D) { expect_published("80 s D10 t1", 529099); }

}  // namespace
}  // namespace ndhull
