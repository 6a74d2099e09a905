// Hulls without their complex, which memory limits bring about here, beside the laws of all approximate
// hulls.
#include <cstring>

#include "core/complex/complex_check.h"
#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

struct StarCase {
  PointFamily family;
  std::size_t n, d;
  double percent;
  std::uint64_t megabytes;
};
const StarCase kCases[] = {
    {PointFamily::kSphere, 2000, 5, 6.0, 5},     {PointFamily::kSphere, 400, 6, 3.0, 6},
    {PointFamily::kGaussian, 3000, 7, 5.0, 20},  {PointFamily::kBall, 1000, 6, 2.0, 11},
    {PointFamily::kEllipsoid, 300, 7, 10.0, 20}, {PointFamily::kSphere, 100, 8, 5.0, 15}};

HullOptions limited(const StarCase& star, bool unit_cube) {
  HullOptions options;
  options.accuracy.width = {star.percent, true};
  options.limits.max_memory_bytes = star.megabytes << 20;
  options.unit_cube = unit_cube;
  return options;
}

bool has_stars(const Hull& hull) {
  for (const auto& [name, seconds] : hull.statistics.detail_seconds)
    if (name == "slabs of rows") return true;
  return false;
}

// What a limit on memory would have ended is complete, and as narrow as asked.
TEST(HullByStars, MeetsTheWidthWhereTheComplexWouldNotFit) {
  for (const StarCase& star : kCases) {
    const PointSet set = family_points(star.family, star.n, star.d, 20241101);
    SCOPED_TRACE(std::string(to_string(star.family)) + " " + std::to_string(star.d) + "-d");
    const bool unit_cube = star.family == PointFamily::kEllipsoid;
    const Hull hull = hull_of(set, limited(star, unit_cube));
    EXPECT_TRUE(has_stars(hull));
    EXPECT_EQ(hull.status, HullStatus::kComplete);
    EXPECT_LE(hull.max_facet_width, 0.01 * star.percent * (unit_cube ? 1.0 : extent_of(set)));
    expect_approximate_laws(hull, set.view());
  }
}

// What growth says of how simplices rise with vertices is foreseen: less than with their square.
TEST(HullByStars, IsNotWhatIsFoundWhereTheComplexFits) {
  const PointSet set = family_points(PointFamily::kSphere, 3000, 6, 20241104);
  const Hull hull = hull_of(set, limited({PointFamily::kSphere, 3000, 6, 1.0, 100}, false));
  EXPECT_FALSE(has_stars(hull));
  EXPECT_EQ(hull.status, HullStatus::kComplete);
  EXPECT_GT(hull.simplex_count(), 400'000U);
}

// Its simplices are made when they are asked for, by growth: they have the volume and the areas that were
// summed up without them, and as many of them are in each facet.
TEST(HullByStars, ItsSimplicesAreThoseOfGrowth) {
  for (const StarCase& star : kCases) {
    const PointSet set = family_points(star.family, star.n, star.d, 20241102);
    SCOPED_TRACE(std::string(to_string(star.family)) + " " + std::to_string(star.d) + "-d");
    const Hull hull = hull_of(set, limited(star, false));
    ASSERT_TRUE(has_stars(hull));
    EXPECT_EQ(hull.simplices().row_count, hull.simplex_count());
    const ComplexCheck check = check_complex(hull.simplices());
    EXPECT_TRUE(check.sound()) << check.first_problem;
    const Hull inner = hull_of(vertex_rows(set, hull));
    EXPECT_NEAR(hull.volume / inner.volume, 1.0, 1e-11);
    EXPECT_NEAR(hull.area / inner.area, 1.0, 1e-11);
    EXPECT_EQ(hull.simplex_count(), inner.simplex_count());
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
      const FacetId facet{row};
      EXPECT_EQ(hull.is_simplicial(facet), hull.simplex_count_of(facet) == 1);
      ASSERT_EQ(hull.simplices_of(facet).size(), hull.simplex_count_of(facet));
      EXPECT_GE(hull.vertices_of(facet).size(), hull.rank);
      if (hull.is_simplicial(facet)) {
        EXPECT_EQ(hull.neighbours_of(facet).size(), hull.rank);
      }
    }
  }
}

TEST(HullByStars, IsTheSameForAnyNumberOfThreads) {
  const PointSet set = family_points(PointFamily::kGaussian, 3000, 7, 20241103);
  HullOptions options = limited(kCases[2], false);
  options.threads = 1;
  const Hull one = hull_of(set, options);
  ASSERT_TRUE(has_stars(one));
  for (const unsigned threads : {2u, 5u}) {
    options.threads = threads;
    const Hull more = hull_of(set, options);
    ASSERT_EQ(more.facet_count(), one.facet_count());
    EXPECT_EQ(std::memcmp(more.normal(FacetId{0}).data(), one.normal(FacetId{0}).data(),
                          one.facet_count() * one.dimension * sizeof(double)),
              0);
    EXPECT_EQ(more.volume, one.volume);
    EXPECT_EQ(more.max_facet_width, one.max_facet_width);
  }
}

// Degenerate points, and copies closer than rounding can tell apart, are left to growth: whatever memory
// allows is the answer.
TEST(HullByStars, LeavesDegeneratePointsToGrowth) {
  PointSet twins = family_points(PointFamily::kGaussian, 400, 6, 20241104);
  const std::size_t count = twins.view().rows;
  PointSet doubled = family_points(PointFamily::kGaussian, 2 * count, 6, 1);
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t k = 0; k < 6; ++k) {
      doubled.coordinates[row * 6 + k] = twins.view().at(row, k);
      doubled.coordinates[(count + row) * 6 + k] = twins.view().at(row, k) * (1.0 + 3e-9);
    }
  }
  for (const PointSet& set : {family_points(PointFamily::kLattice, 0, 6, 1), doubled}) {
    HullOptions options;
    options.accuracy.width = {2.0, true};
    options.limits.max_memory_bytes = 5 << 20;
    const Hull hull = hull_of(set, options);
    EXPECT_FALSE(has_stars(hull));
    expect_approximate_laws(hull, set.view());
  }
}

// A stop while stars are grown gives what growth had.
TEST(HullByStars, EndsWhenItIsAskedTo) {
  const PointSet set = family_points(PointFamily::kGaussian, 3000, 7, 20241105);
  HullOptions options = limited(kCases[2], false);
  std::stop_source source;
  options.stop = source.get_token();
  bool is_covering = false;
  options.progress = [&](const Progress& progress) {
    is_covering = is_covering || progress.phase == Phase::kMerge;
    if (is_covering) source.request_stop();
  };
  const Hull hull = hull_of(set, options);
  EXPECT_TRUE(is_covering);
  EXPECT_EQ(hull.status, HullStatus::kInterrupted);
  expect_approximate_laws(hull, set.view());
}

}  // namespace
}  // namespace ndhull
