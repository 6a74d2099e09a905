// Growth in regions beside growth that adds one point after the other.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/complex/complex_check.h"
#include "core/growth/growth.h"
#include "tests/prepared_growth.h"
#include "tests/simplex_sets.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

struct Grown {
  explicit Grown(const PointSet& set, bool in_regions, int threads, std::uint64_t pause_rows = 0) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
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
      }
    });
  }
  std::size_t live_rows() const { return work.complex.row_count - work.free_count; }

  std::vector<double> coordinates;
  GrowthWork work;
  int pauses = 0;
};

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

TEST_P(GrowthInRegions, HasTheSameBytesForAnyNumberOfThreads) {
  const PointSet set = rbox(GetParam().words);
  const Grown one(set, true, 1);
  const std::size_t rows = one.work.complex.row_count, rank = one.work.rank;
  for (const int threads : {2, 3}) {
    const Grown more(set, true, threads);
    const SimplicialComplex &a = one.work.complex, &b = more.work.complex;
    ASSERT_EQ(b.row_count, rows);
    EXPECT_EQ(more.work.counters.created, one.work.counters.created);
    EXPECT_EQ(std::memcmp(a.planes.data(), b.planes.data(), rows * rank * sizeof(double)), 0);
    EXPECT_EQ(std::memcmp(a.topology.data(), b.topology.data(), rows * 2 * rank * sizeof(std::uint32_t)), 0);
    EXPECT_EQ(std::memcmp(a.state.data(), b.state.data(), rows), 0);
    EXPECT_TRUE(std::equal(one.work.free_rows.data(), one.work.free_rows.data() + one.work.free_count,
                           more.work.free_rows.data()));
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, GrowthInRegions,
                         testing::Values(Case{"20000 s D3 t1", 6000}, Case{"6000 s D4 t2", 2000},
                                         Case{"4000 s D5 t3", 2000}, Case{"2500 s D6 t4", 600}));

TEST(GrowthInRegionsOfOtherData, IsAHullWhereItPauses) {
  const Grown parted(rbox("4000 s D5 t5"), true, 2, 9000);
  EXPECT_GT(parted.pauses, 0);
  EXPECT_GT(parted.work.counters.in_regions, 0u);
  EXPECT_TRUE(check_complex(parted.work.complex).sound());
  EXPECT_EQ(simplices_of(parted.work.complex),
            simplices_of(Grown(rbox("4000 s D5 t5"), false, 1).work.complex));
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
