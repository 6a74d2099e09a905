// Growth in regions beside growth that adds one point after the other.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "core/complex/complex_check.h"
#include "core/growth/growth.h"
#include "tests/prepared_growth.h"
#include "tests/simplex_sets.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

struct Grown {
  Grown(
      const PointSet& set, bool in_regions, int threads, std::uint64_t pause_rows = 0,
      const GrowthOptions& options = {},
      const std::function<void(GrowthOptions&)>& at_pause = [](GrowthOptions&) {}) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    work.options = options;
    if (options.by_gauge) work.options.gradient_factor = unequal_axes(work.rank);
    work.options.in_regions = in_regions;
    work.options.pause_rows = pause_rows;
    tbb::task_arena arena(threads);
    arena.execute([&] {
      start_growth(work, frame.simplex, FirstPoints());
      while (grow(work) == GrowthStop::kPaused) {
        EXPECT_TRUE(check_complex(work.complex).sound());
        ++pauses;
        pause_rows += pause_rows / 2;  // growth has taken it back
        work.options.pause_rows = pause_rows;
        at_pause(work.options);
      }
    });
  }
  std::size_t live_rows() const { return work.complex.row_count - work.free_count; }

  std::vector<double> coordinates;
  GrowthWork work;
  int pauses = 0;
};

/// As `Grown` is told to grow.
GrowthOptions by_gauge() {
  GrowthOptions options;
  options.by_gauge = true;
  return options;
}

struct Case {
  const char* words;  // of rbox
  std::size_t insertions;
};

class GrowthInRegions : public testing::TestWithParam<Case> {};

// Of points in general position there is one hull.
TEST_P(GrowthInRegions, MakesTheSimplicesOfGrowthByOne) {
  const PointSet set = rbox(GetParam().words);
  const Grown alone(set, false, 1), parted(set, true, 2);
  EXPECT_EQ(alone.work.counters.in_regions, 0u);
  EXPECT_GE(parted.work.counters.in_regions, GetParam().insertions);
  EXPECT_EQ(parted.work.points_outside, 0u);
  const ComplexCheck check = check_complex(parted.work.complex);
  EXPECT_TRUE(check.sound()) << check.first_problem;
  EXPECT_EQ(check.simplices, parted.live_rows());
  EXPECT_EQ(simplices_of(parted.work.complex), simplices_of(alone.work.complex));
  // Points that are added too early make simplices that do not stay.
  EXPECT_LE(parted.work.counters.created, alone.work.counters.created / 20 * 21);
}

void expect_same_bytes(const GrowthWork& one, const GrowthWork& other) {
  const SimplicialComplex &a = one.complex, &b = other.complex;
  const std::size_t rows = a.row_count, rank = one.rank;
  ASSERT_EQ(b.row_count, rows);
  EXPECT_EQ(other.counters.created, one.counters.created);
  EXPECT_EQ(std::memcmp(a.planes.data(), b.planes.data(), rows * rank * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(a.topology.data(), b.topology.data(), rows * 2 * rank * sizeof(std::uint32_t)), 0);
  EXPECT_EQ(std::memcmp(a.state.data(), b.state.data(), rows), 0);
  EXPECT_TRUE(
      std::equal(one.free_rows.data(), one.free_rows.data() + one.free_count, other.free_rows.data()));
}

TEST_P(GrowthInRegions, HasTheSameBytesForAnyNumberOfThreads) {
  const PointSet set = rbox(GetParam().words);
  for (const GrowthOptions& options : {GrowthOptions(), by_gauge()}) {
    const Grown one(set, true, 1, 0, options);
    for (const int threads : {2, 3}) expect_same_bytes(one.work, Grown(set, true, threads, 0, options).work);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, GrowthInRegions,
                         testing::Values(Case{"20000 s D3 t1", 6000}, Case{"6000 s D4 t2", 2000},
                                         Case{"4000 s D5 t3", 2000}, Case{"2500 s D6 t4", 600}));

TEST_P(GrowthInRegions, MayGoByGauges) {
  const PointSet set = rbox(GetParam().words);
  const Grown alone(set, false, 1, 0, by_gauge()), parted(set, true, 2, 0, by_gauge());
  EXPECT_GE(parted.work.counters.in_regions, GetParam().insertions);
  EXPECT_EQ(simplices_of(parted.work.complex), simplices_of(alone.work.complex));
  // In that order: by distances, which are very unequal, more would be made.
  EXPECT_LE(parted.work.counters.created, alone.work.counters.created / 20 * 21);
}

// The order of growth, and whether it goes on in regions, may change where it pauses.
TEST(GrowthInRegionsOfOtherData, ChangesItsOrderWhereItPauses) {
  const PointSet set = rbox("4000 s D5 t8");
  const auto grow_by_turns = [&](int threads) {
    auto grown = std::make_unique<Grown>(set, false, threads, 9000, by_gauge(), [](GrowthOptions& options) {
      options.by_gauge = !options.by_gauge;
      options.in_regions = !options.in_regions;
    });
    EXPECT_GT(grown->pauses, 2);
    EXPECT_GT(grown->work.counters.in_regions, 0u);
    return grown;
  };
  const auto one = grow_by_turns(1), two = grow_by_turns(2);
  EXPECT_EQ(simplices_of(one->work.complex), simplices_of(Grown(set, false, 1).work.complex));
  expect_same_bytes(one->work, two->work);
}

TEST(GrowthInRegionsOfOtherData, IsAHullWhereItPauses) {
  const Grown parted(rbox("4000 s D5 t5"), true, 2, 9000);
  EXPECT_GT(parted.pauses, 0);
  EXPECT_GT(parted.work.counters.in_regions, 0u);
  EXPECT_TRUE(check_complex(parted.work.complex).sound());
  EXPECT_EQ(simplices_of(parted.work.complex),
            simplices_of(Grown(rbox("4000 s D5 t5"), false, 1).work.complex));
}

// Points that are lower than growth has to come down to are left for later, as by growth by one.
TEST(GrowthInRegionsOfOtherData, AddsNoMoreThanAHeightNeeds) {
  constexpr double kHeight = 0.02;
  const auto grown_to_height = [&](bool in_regions, GrowthOptions options) {
    options.pause_height = kHeight;
    const PointSet set = rbox("6000 s D5 t7");
    GrowthWork grown;
    std::vector<double> coordinates;
    const Frame frame = prepare_growth(set.view(), coordinates, grown);
    grown.options = options;
    grown.options.gradient_factor = std::vector<double>(grown.rank * grown.rank, 0.0);
    for (std::size_t k = 0; k < grown.rank; ++k) grown.options.gradient_factor[k * (grown.rank + 1)] = 1.0;
    grown.options.in_regions = in_regions;
    grown.options.pause_rows = 1;
    start_growth(grown, frame.simplex, FirstPoints());
    EXPECT_EQ(grow(grown), GrowthStop::kPaused);
    EXPECT_LE(grown.heights.furthest().height, kHeight);
    return grown.counters;
  };
  for (const GrowthOptions& options : {GrowthOptions(), by_gauge()}) {
    const GrowthCounters alone = grown_to_height(false, options), parted = grown_to_height(true, options);
    EXPECT_GT(parted.in_regions, alone.insertions / 4);
    EXPECT_LE(parted.insertions, alone.insertions + alone.insertions / 20);
  }
}

/// Points of a sphere that is cut off across the first axis, and a dozen where that cuts it: one facet.
PointSet cut_sphere() {
  constexpr double kCut = 0.498;  // of a radius of 0.5: nearly as near as neighbours are, so these come late
  const PointSet sphere = rbox("5000 s D4 t6");
  PointSet set;
  set.dimension = 4;
  std::size_t on_facet = 0;
  for (std::size_t row = 0; row < sphere.rows(); ++row) {
    const std::span<const double> point = sphere.row(row);
    std::vector<double> x(point.begin(), point.end());
    if (x[0] > kCut) continue;
    if (x[0] > 0.0 && on_facet++ < 12) {
      const double scale = std::sqrt((0.25 - kCut * kCut) / (0.25 - x[0] * x[0]));
      x = {kCut, scale * x[1], scale * x[2], scale * x[3]};
    }
    set.coordinates.insert(set.coordinates.end(), x.begin(), x.end());
  }
  return set;
}

// Points in one plane have gauges near 0: those are added one after the other.
TEST(GrowthInRegionsOfOtherData, LeavesWhatIsNotGeneralToGrowthByOne) {
  const PointSet set = cut_sphere();
  const Grown parted(set, true, 2);
  EXPECT_GT(parted.work.counters.in_regions, 0u);
  EXPECT_GT(parted.work.shifted_points.size(), 0u);
  const ComplexCheck check = check_complex(parted.work.complex);
  EXPECT_TRUE(check.sound()) << check.first_problem;
}

}  // namespace
}  // namespace ndhull
