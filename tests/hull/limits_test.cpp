// A limit ends growth, not the promise: what is there is a sound hull whose outer planes bound every point.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <stop_token>
#include <tuple>

#include "core/complex/complex_check.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr double kSlower = 20.0;
#else
constexpr double kSlower = 1.0;
#endif

/// The status, certified planes over all points, and a sound complex.
void expect_certified_with(HullStatus status, const PointSet& set, const HullOptions& options) {
  const Hull hull = hull_of(set, options);
  EXPECT_EQ(hull.status, status) << to_string(hull.status);
  EXPECT_GT(hull.facet_count(), 0U);
  expect_sound(hull, set);
  // Points were left out, and the numbers say so.
  EXPECT_GT(hull.max_outside_gauge, 0.0);
  EXPECT_GT(hull.max_outer_offset, 0.0);
}

PointSet sphere(std::size_t n, std::size_t d) { return family_points(PointFamily::kSphere, n, d, 71); }

TEST(LimitsLaw, AFacetLimitLeavesACertifiedHull) {
  for (std::size_t d = 2; d <= 8; ++d) {
    for (const std::uint64_t limit : {std::uint64_t{2 * d}, std::uint64_t{100}, std::uint64_t{1000}}) {
      SCOPED_TRACE("sphere, n 2000, d " + std::to_string(d) + ", seed 71, max_facets " +
                   std::to_string(limit));
      const PointSet set = sphere(2000, d);
      const HullOptions options{.limits = {.max_facets = limit}};
      expect_certified_with(HullStatus::kFacetLimit, set, options);
      EXPECT_LE(hull_of(set, options).simplices().row_count, limit);
    }
  }
}

TEST(LimitsLaw, AFacetLimitLeavesACertifiedHullOfDegenerateInputs) {
  for (std::size_t d = 3; d <= 6; ++d) {
    for (const DegenerateCase& input : degenerate_cases(150, d, 72)) {
      SCOPED_TRACE(input.description + ", max_facets 40");
      const Hull hull = hull_of(input.points, {.limits = {.max_facets = 40}});
      EXPECT_TRUE(hull.status == HullStatus::kFacetLimit || hull.status == HullStatus::kComplete);
      expect_sound(hull, input.points);
    }
  }
}

TEST(LimitsExample, ALimitThatIsNotReachedChangesNothing) {
  const PointSet set = sphere(100, 5);
  const Hull free = hull_of(set);
  const Hull limited = hull_of(
      set, {.limits = {
                .max_facets = 1'000'000, .max_seconds = 600.0, .max_memory_bytes = std::uint64_t{1} << 34}});
  EXPECT_EQ(limited.status, HullStatus::kComplete);
  EXPECT_EQ(facet_sets(limited), facet_sets(free));
}

TEST(LimitsExample, TimeEndsGrowth) {
  const PointSet set = sphere(2000, 8);
  expect_certified_with(HullStatus::kTimeLimit, set, {.limits = {.max_seconds = 0.05}});
}

// What each facet will take afterwards is foreseen: so much of it leaves no time to grow at all.
TEST(LimitsExample, GrowthEndsInTimeForWhatComesAfterTheCall) {
  const PointSet set = sphere(200, 6);
  const Limits patient{.max_seconds = 600.0};
  EXPECT_EQ(hull_of(set, {.limits = patient}).status, HullStatus::kComplete);
  Limits busy = patient;
  busy.share_afterwards = 1e12;
  expect_certified_with(HullStatus::kTimeLimit, set, {.limits = busy});
  busy.max_seconds = 0.0;  // without a limit there is nothing to foresee
  EXPECT_EQ(hull_of(set, {.limits = busy}).status, HullStatus::kComplete);
}

TEST(LimitsLaw, TheTimeLimitIsForTheWholeCallAndGrowthIsRecorded) {
  const PointSet set = sphere(5000, 9);
  for (const double seconds : {0.25 * kSlower, 1.0 * kSlower}) {
    // A machine with other work can hold up any call: the times of the best of some are the engine's own.
    bool is_in_time = false;
    for (int round = 0; round < 6 && !is_in_time; ++round) {
      const auto start = std::chrono::steady_clock::now();
      const Hull hull = hull_of(set, {.limits = {.max_seconds = seconds}});
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      is_in_time = elapsed.count() < 3.0 * kSlower + seconds &&  // alone it is 0.7 to 1.1 times
                   hull.statistics.seconds[static_cast<std::size_t>(Phase::kGrowth)] < 0.95 * seconds;
      EXPECT_EQ(hull.status, HullStatus::kTimeLimit);
      const std::vector<GrowthRecord>& curve = hull.statistics.growth_curve;
      ASSERT_GT(curve.size(), 3U);
      for (std::size_t i = 1; i < curve.size(); ++i) {
        EXPECT_GE(curve[i].seconds, curve[i - 1].seconds);
        EXPECT_GT(curve[i].simplices, curve[i - 1].simplices);
        EXPECT_LE(curve[i].furthest, curve[i - 1].furthest);
      }
      // What the last record says of an earlier hull holds for the one returned.
      EXPECT_LE(hull.max_outside_gauge, curve.back().furthest * (1.0 + 1e-9));
    }
    EXPECT_TRUE(is_in_time) << seconds << " s";
  }
}

TEST(LimitsLaw, AnEndLaterGivesANarrowerHull) {
  const PointSet set = sphere(3000, 7);
  double last_width = HUGE_VAL, last_gauge = HUGE_VAL;
  for (const std::uint64_t limit : {200U, 2000U, 20'000U, 200'000U}) {
    const Hull hull = hull_of(set, {.limits = {.max_facets = limit}});
    EXPECT_LT(hull.max_outside_gauge, last_gauge) << limit;
    EXPECT_LT(hull.max_facet_width, last_width) << limit;
    last_gauge = hull.max_outside_gauge;
    last_width = hull.max_facet_width;
  }
}

TEST(LimitsLaw, TimeEndsApproximateHullsWithACertifiedResult) {
  const PointSet set = sphere(8000, 7);
  Accuracy width, count, merging;
  width.width = {.value = 0.5, .is_percent = true};  // far finer than the time allows
  count.facets = 500;
  merging.outside_width = {.value = 1e-3, .is_percent = false};
  merging.centrum_radius = {.value = 1e-3, .is_percent = false};
  for (const Accuracy& accuracy : {width, count, merging}) {
    const auto start = std::chrono::steady_clock::now();
    const Hull hull = hull_of(set, {.accuracy = accuracy, .limits = {.max_seconds = 0.25}});
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(hull.status, HullStatus::kTimeLimit);
    // On a machine with other work: alone it is about 0.25, without a limit 1.5 to many.
    EXPECT_LT(elapsed.count(), 8.0 * kSlower);
    EXPECT_GT(hull.facet_count(), hull.rank);
    EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
    EXPECT_LE(largest_inner_excess(hull, set.view()), 0.0L);
  }
}

// Facets are as wide as the points make them that the limit has left out; simplices are many more.
TEST(LimitsLaw, AWidthThatALimitDoesNotAllowIsAnsweredByFewFacets) {
  for (const auto& [family, n, d, limit] : {std::tuple{PointFamily::kSphere, 1500U, 5U, 5000U},
                                            {PointFamily::kGaussian, 2000U, 6U, 8000U},
                                            {PointFamily::kSphere, 300U, 8U, 60'000U}}) {
    SCOPED_TRACE("d " + std::to_string(d));
    const PointSet set = family_points(family, n, d, 71);
    HullOptions options{.limits = {.max_facets = limit}};
    const Hull simplices = hull_of(set, options);
    options.accuracy.width = {.value = 0.5, .is_percent = true};
    const Hull hull = hull_of(set, options);
    EXPECT_EQ(hull.status, HullStatus::kFacetLimit);
    EXPECT_TRUE(hull.is_approximate);
    EXPECT_GT(hull.max_facet_width, hull.chosen.width_asked);
    EXPECT_GT(hull.chosen.outside_width, 0.0);  // some were left out
    EXPECT_LT(4 * hull.facet_count(), simplices.facet_count());
    EXPECT_LT(hull.max_facet_width, 1.5 * simplices.max_facet_width);
    EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
    EXPECT_LE(largest_inner_excess(hull, set.view()), 0.0L);
  }
}

// Far more facets than there is time for: thin slabs would be turned to points far above them for seconds.
TEST(LimitsLaw, ManyFacetsAreLookedForInTime) {
  const PointSet set = sphere(200, 12);
  const auto start = std::chrono::steady_clock::now();
  const Hull hull = hull_of(set, {.accuracy = {.facets = 100'000}, .limits = {.max_seconds = 0.3}});
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  EXPECT_LT(elapsed.count(), 3.0 * kSlower);  // alone it is about 0.7, and was 5 to 10
  EXPECT_EQ(hull.status, HullStatus::kTimeLimit);
  EXPECT_LE(hull.facet_count(), 100'000U);
  EXPECT_GT(hull.facet_count(), hull.rank);
  EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
}

TEST(LimitsLaw, AStopIsFollowedByNoLongWork) {
  // Every point is a vertex: proving each plane against each point would take minutes.
  const PointSet set = sphere(100'000, 10);
  std::stop_source source;
  std::chrono::steady_clock::time_point stopped;
  HullOptions options{.stop = source.get_token()};
  options.progress = [&](const Progress& progress) {
    if (progress.simplices < 200'000 || source.stop_requested()) return;
    source.request_stop();
    stopped = std::chrono::steady_clock::now();
  };
  const Hull hull = hull_of(set, options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - stopped;
  EXPECT_EQ(hull.status, HullStatus::kInterrupted);
  EXPECT_LT(elapsed.count(), 20.0 * kSlower);  // alone it is about 1
  // On a sphere the ball around all points bounds far better than the scaled hull: by some |x - c| - h, not s
  // h.
  EXPECT_GT(hull.max_outer_offset, 0.0);
  EXPECT_LT(hull.max_outer_offset, 1.2);
  long double excess = 0.0L;
  for (std::uint32_t facet = 0; facet < hull.facet_count(); facet += 997) {
    for (std::size_t row = 0; row < set.rows(); ++row) {
      long double distance = hull.centred_offset(FacetId{facet});
      for (std::size_t k = 0; k < 10; ++k)
        distance += static_cast<long double>(hull.normal(FacetId{facet})[k]) *
                    (static_cast<long double>(set.row(row)[k]) - hull.reference[k]);
      excess = std::max(excess, distance - hull.outer_offset(FacetId{facet}));
    }
  }
  EXPECT_LE(excess, 0.0L);
}

TEST(LimitsLaw, AStopEndsApproximateHullsWithACertifiedResult) {
  const PointSet set = sphere(20'000, 7);
  std::stop_source source;
  HullOptions options{.stop = source.get_token()};
  options.accuracy.width = {.value = 0.5, .is_percent = true};
  options.progress = [&](const Progress& progress) {
    if (progress.simplices > 2000) source.request_stop();
  };
  const Hull hull = hull_of(set, options);
  EXPECT_EQ(hull.status, HullStatus::kInterrupted);
  EXPECT_GT(hull.facet_count(), 2000U);
  EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
}

TEST(LimitsLaw, MemoryThatIsShortForMergingGoesIntoGrowth) {
  const PointSet set = sphere(5000, 7);
  HullOptions options{.limits = {.max_memory_bytes = 24'000'000}};
  options.accuracy.width = {.value = 1.0, .is_percent = true};
  const Hull hull = hull_of(set, options);
  EXPECT_EQ(hull.status, HullStatus::kMemoryLimit);
  EXPECT_FALSE(hull.is_approximate);
  EXPECT_GT(hull.facet_count() * (16U * 7U + 53U), 14'000'000U);
  EXPECT_LT(hull.facet_count() * (16U * 7U + 53U), 24'000'000U);
  EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
  // A number of facets is kept all the same.
  options.accuracy = {.facets = 300};
  const Hull few = hull_of(set, options);
  EXPECT_LE(few.facet_count(), 300U);
  EXPECT_LE(largest_outer_excess(few, set.view()), 0.0L);
}

// Growth has ended by itself: its simplices keep the width, and nothing else is looked for.
TEST(LimitsLaw, SimplicesThatKeepAWidthStayWhereMemoryIsShortForSlabs) {
  const PointSet set = sphere(2000, 5);
  // With a limit on time nothing is tried without the complex.
  HullOptions options{.limits = {.max_seconds = 600.0, .max_memory_bytes = 11'000'000}};
  options.accuracy.width = {.value = 0.2, .is_percent = true};
  const Hull hull = hull_of(set, options);
  EXPECT_EQ(hull.status, HullStatus::kMemoryLimit);
  EXPECT_FALSE(hull.is_approximate);
  EXPECT_LE(hull.max_facet_width, hull.chosen.width_asked);
  EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
  // It is the number of slabs that takes memory: of wider ones there are fewer.
  options.accuracy.width.value = 6.0;
  const Hull wide = hull_of(set, options);
  EXPECT_EQ(wide.status, HullStatus::kComplete);
  EXPECT_LT(wide.facet_count(), hull.facet_count() / 10U);
}

// Facets that there is no memory to choose are not asked for.
TEST(LimitsLaw, FewerFacetsThanAskedForWhereMemoryIsShort) {
  const PointSet set = sphere(2000, 5);
  HullOptions options{.limits = {.max_memory_bytes = 40'000'000}};
  options.accuracy = {.facets = 30'000};
  const Hull hull = hull_of(set, options);
  EXPECT_EQ(hull.status, HullStatus::kMemoryLimit);
  EXPECT_LE(hull.facet_count(), 40'000'000U / 1'100U);
  EXPECT_GT(hull.facet_count(), 10'000U);
  EXPECT_LE(largest_outer_excess(hull, set.view()), 0.0L);
  options.limits.max_memory_bytes = 200'000'000;
  EXPECT_EQ(hull_of(set, options).status, HullStatus::kComplete);
}

TEST(LimitsLaw, MergingIsCountedInTheMemory) {
  // A cube's simplices are merged: that takes about as much memory again.
  const PointSet cube = family_points(PointFamily::kCubeCorners, 0, 9, 1);
  const HullOptions options{.limits = {.max_memory_bytes = 64'000'000}};
  const Hull hull = hull_of(cube, options);
  EXPECT_EQ(hull.status, HullStatus::kMemoryLimit);
  EXPECT_LT(hull.simplices().row_count * (32U * 9U + 53U + 64U), 64'000'000U);
  EXPECT_GT(hull.simplices().row_count * (32U * 9U + 53U + 64U), 40'000'000U);
  EXPECT_LE(largest_outer_excess(hull, cube.view()), 0.0L);
}

TEST(LimitsExample, MemoryEndsGrowth) {
  const PointSet set = sphere(2000, 8);
  const HullOptions options{.limits = {.max_memory_bytes = 3'000'000}};
  expect_certified_with(HullStatus::kMemoryLimit, set, options);
  EXPECT_LT(hull_of(set, options).simplices().row_count, 3'000'000U / 133U);
}

TEST(LimitsLaw, TheMachinesMemoryEndsGrowthAndChangesNothingBefore) {
  const PointSet set = sphere(2000, 8);
  expect_certified_with(HullStatus::kMemoryLimit, set, {.limits = {.machine_memory_bytes = 3'000'000}});
  // A limit of the user's is the one in force.
  expect_certified_with(HullStatus::kMemoryLimit, set,
                        {.limits = {.max_memory_bytes = 3'000'000, .machine_memory_bytes = 1'000'000'000}});
  const PointSet whole = sphere(300, 6);
  for (const double percent : {0.0, 5.0}) {
    HullOptions options;
    if (percent > 0.0) options.accuracy.width = {.value = percent, .is_percent = true};
    const Hull free = hull_of(whole, options);
    options.limits.machine_memory_bytes = 100'000'000;
    const Hull kept = hull_of(whole, options);
    EXPECT_EQ(kept.status, HullStatus::kComplete);
    ASSERT_EQ(kept.facet_count(), free.facet_count());
    for (std::uint32_t id = 0; id < free.facet_count(); ++id)
      ASSERT_EQ(kept.outer_offset(FacetId{id}), free.outer_offset(FacetId{id}));
  }
}

TEST(LimitsExample, AStopRequestedBeforeLeavesTheFirstSimplexOrMore) {
  std::stop_source source;
  source.request_stop();
  const PointSet set = sphere(2000, 8);
  expect_certified_with(HullStatus::kInterrupted, set, {.stop = source.get_token()});
}

TEST(LimitsExample, AStopRequestedDuringGrowthLeavesACertifiedHull) {
  std::stop_source source;
  const PointSet set = sphere(2000, 7);
  std::uint64_t calls = 0;
  HullOptions options{.stop = source.get_token()};
  options.progress = [&](const Progress& progress) {
    EXPECT_LE(progress.points_left, set.rows());
    EXPECT_GE(progress.elapsed_seconds, 0.0);
    ++calls;
    source.request_stop();
  };
  expect_certified_with(HullStatus::kInterrupted, set, options);
  EXPECT_GE(calls, 1U);
}

}  // namespace
}  // namespace ndhull
