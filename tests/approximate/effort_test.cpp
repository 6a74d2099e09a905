// What looking longer gives: fewer facets of the same width, narrower ones of the same number, and the same
// laws.
#include <tbb/parallel_for.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

HullOptions with_effort(Effort effort, double percent, std::uint64_t facets) {
  HullOptions options;
  options.accuracy.effort = effort;
  if (percent > 0.0) options.accuracy.width = {percent, true};
  options.accuracy.facets = facets;
  return options;
}

const FamilySize kShapesLookedInto[] = {
    {PointFamily::kSphere, 400, 3},    {PointFamily::kSphere, 300, 5},    {PointFamily::kBall, 500, 4},
    {PointFamily::kGaussian, 3000, 5}, {PointFamily::kGaussian, 200, 7},  {PointFamily::kCube, 400, 6},
    {PointFamily::kClusters, 500, 4},  {PointFamily::kEllipsoid, 300, 5}, {PointFamily::kLens, 200, 4},
    {PointFamily::kLattice, 729, 6},   {PointFamily::kCubeCorners, 64, 6}};

TEST(EffortLaw, AWidthIsMetByNoMoreFacets) {
  for (const FamilySize& shape : kShapesLookedInto) {
    for (const double percent : {0.5, 5.0, 20.0}) {
      const PointSet set = family_points(shape.family, shape.n, shape.d, 20261126);
      SCOPED_TRACE(std::string(to_string(shape.family)) + " " + std::to_string(shape.d) + "-d, " +
                   std::to_string(percent) + "%");
      const Hull quick = hull_of(set, with_effort(Effort::kQuick, percent, 0));
      const Hull thorough = hull_of(set, with_effort(Effort::kThorough, percent, 0));
      EXPECT_LE(thorough.facet_count(), quick.facet_count());
      EXPECT_LE(thorough.max_facet_width, 0.01 * percent * extent_of(set));
      expect_approximate_laws(thorough, set.view());
    }
  }
}

TEST(EffortLaw, ANumberIsMetByNoWiderFacets) {
  for (const FamilySize& shape : kShapesLookedInto) {
    for (const std::uint64_t count : {shape.d + 1, std::size_t{40}, std::size_t{400}}) {
      const PointSet set = family_points(shape.family, shape.n, shape.d, 20261127);
      SCOPED_TRACE(std::string(to_string(shape.family)) + " " + std::to_string(shape.d) + "-d, " +
                   std::to_string(count) + " facets");
      const Hull quick = hull_of(set, with_effort(Effort::kQuick, 0.0, count));
      const Hull thorough = hull_of(set, with_effort(Effort::kThorough, 0.0, count));
      EXPECT_LE(thorough.facet_count(), count);
      EXPECT_LE(thorough.max_facet_width, quick.max_facet_width);
      expect_approximate_laws(thorough, set.view());
    }
  }
}

TEST(EffortExample, RoundHullsHaveAFifthFewerFacetsOrATwentiethNarrowerOnes) {
  for (const char* words : {"500 s D5 t1", "200 s D6 t1", "120 s D7 t1"}) {
    SCOPED_TRACE(words);
    const PointSet set = rbox(words);
    const std::size_t quick = hull_of(set, with_effort(Effort::kQuick, 5.0, 0)).facet_count();
    EXPECT_LT(hull_of(set, with_effort(Effort::kThorough, 5.0, 0)).facet_count(), quick * 4 / 5);
    const double width = hull_of(set, with_effort(Effort::kQuick, 0.0, quick / 2)).max_facet_width;
    EXPECT_LT(hull_of(set, with_effort(Effort::kThorough, 0.0, quick / 2)).max_facet_width, 0.95 * width);
  }
}

// Some simplices of a cube's hull, with points above them, fit below no plane that turning finds for them
// alone.
TEST(EffortExample, ACubeWithSimplicesThatDoNotFitAloneHasFewerFacets) {
  const PointSet set = family_points(PointFamily::kCube, 1000, 6, 5);
  const std::size_t quick = hull_of(set, with_effort(Effort::kQuick, 1.0, 0)).facet_count();
  EXPECT_LT(hull_of(set, with_effort(Effort::kThorough, 1.0, 0)).facet_count(), quick * 9 / 10);
}

// So many are left out that the fits see the furthest over each simplex only.
TEST(EffortLaw, AWidthHoldsForPointsThatTheFitsHaveNotSeen) {
  const PointSet set = family_points(PointFamily::kSphere, 200'000, 4, 20261128);
  const Hull quick = hull_of(set, with_effort(Effort::kQuick, 5.0, 0));
  const Hull thorough = hull_of(set, with_effort(Effort::kThorough, 5.0, 0));
  EXPECT_LT(thorough.facet_count(), quick.facet_count());
  EXPECT_LE(thorough.max_facet_width, 0.05 * extent_of(set));
  EXPECT_LE(measured_width(thorough, set.view()), thorough.max_facet_width * (1.0L + 1e-9L));
}

TEST(EffortLaw, WidthsHoldUnderALimitOnMemory) {
  const PointSet set = rbox("150 s D7 t1");
  for (const std::uint64_t megabytes : {16U, 24U, 32U, 64U}) {
    HullOptions options = with_effort(Effort::kThorough, 1.0, 0);
    options.limits.max_memory_bytes = megabytes << 20;
    const Hull hull = hull_of(set, options);
    EXPECT_LE(measured_width(hull, set.view()), hull.max_facet_width * (1.0L + 1e-9L));
    if (hull.status == HullStatus::kComplete) {
      EXPECT_LE(hull.max_facet_width, 0.01 * extent_of(set));
    }
  }
}

TEST(LaterAreas, AreTheSameForAllThreadsThatAskAndAfterAMove) {
  const PointSet set = rbox("120 s D6 t1");
  Hull made = hull_of(set, with_effort(Effort::kQuick, 3.0, 0));
  const Hull hull = std::move(made), other = hull_of(set, with_effort(Effort::kQuick, 3.0, 0));
  std::vector<double> alone(hull.facet_count()), together(hull.facet_count());
  for (std::uint32_t id = 0; id < alone.size(); ++id) alone[id] = hull.area_of(FacetId{id});
  tbb::parallel_for(std::size_t{0}, together.size(), [&](std::size_t id) {
    together[id] = other.area_of(FacetId{static_cast<std::uint32_t>(id)});
  });
  EXPECT_TRUE(alone == together);
}

TEST(EffortLaw, TheSameForAnyNumberOfThreads) {
  const PointSet set = rbox("300 s D6 t1");
  const auto planes_of = [&](HullOptions options, unsigned threads) {
    options.threads = threads;
    const Hull hull = hull_of(set, options);
    std::vector<double> planes;
    for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
      const auto normal = hull.normal(FacetId{id});
      planes.insert(planes.end(), normal.begin(), normal.end());
      planes.insert(planes.end(), {hull.outer_offset(FacetId{id}), hull.inner_offset(FacetId{id})});
    }
    return planes;
  };
  for (const HullOptions& options :
       {with_effort(Effort::kThorough, 3.0, 0), with_effort(Effort::kThorough, 0.0, 300)}) {
    const std::vector<double> alone = planes_of(options, 1);
    EXPECT_TRUE(planes_of(options, 2) == alone);
    EXPECT_TRUE(planes_of(options, 4) == alone);
  }
}

TEST(EffortLaw, WidthsHoldWhenTimeHasRunOut) {
  const PointSet set = rbox("200 s D6 t1");
  for (const double seconds : {0.002, 0.02, 0.1}) {
    HullOptions options = with_effort(Effort::kThorough, 2.0, 0);
    options.limits.max_seconds = seconds;
    const Hull hull = hull_of(set, options);
    EXPECT_EQ(hull.points_outside, 0U);
    if (hull.status == HullStatus::kComplete) {
      EXPECT_LE(hull.max_facet_width, 0.02 * extent_of(set));
    }
    EXPECT_LE(measured_width(hull, set.view()), hull.max_facet_width * (1.0L + 1e-9L));
  }
}

}  // namespace
}  // namespace ndhull
