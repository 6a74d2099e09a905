// Growth by gauges beside growth by distances.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "core/complex/complex_check.h"
#include "core/growth/growth.h"
#include "tests/prepared_growth.h"
#include "tests/simplex_sets.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

struct Ordered {
  /// `by_gauge_from`: simplices from which on gauges count; 0: always, UINT64_MAX: never.
  Ordered(const PointSet& set, bool has_distances, std::uint64_t by_gauge_from) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    if (has_distances) work.options.gradient_factor = unequal_axes(work.rank);
    work.options.by_gauge = by_gauge_from == 0;
    work.options.pause_rows = by_gauge_from == UINT64_MAX ? 0 : by_gauge_from;
    start_growth(work, frame.simplex, FirstPoints());
    while (grow(work) == GrowthStop::kPaused) work.options.by_gauge = true;
    EXPECT_EQ(work.points_outside, 0u);
    const ComplexCheck check = check_complex(work.complex);
    EXPECT_TRUE(check.sound()) << check.first_problem;
  }

  std::vector<double> coordinates;
  GrowthWork work;
};

class GrowthByGauge : public testing::TestWithParam<const char*> {};

TEST_P(GrowthByGauge, IsGrowthWithoutDistances) {
  const PointSet set = rbox(GetParam());
  const Ordered plain(set, false, UINT64_MAX), by_gauge(set, true, 0), by_distance(set, true, UINT64_MAX);
  const SimplicialComplex &a = plain.work.complex, &b = by_gauge.work.complex;
  ASSERT_EQ(a.row_count, b.row_count);
  EXPECT_EQ(std::memcmp(a.planes.data(), b.planes.data(), a.row_count * a.rank * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(a.topology.data(), b.topology.data(), a.row_count * 2 * a.rank * 4), 0);
  EXPECT_NE(by_gauge.work.counters.created, by_distance.work.counters.created);
}

// Of points in general position there is one hull.
TEST_P(GrowthByGauge, GoesOnFromGrowthByDistances) {
  const PointSet set = rbox(GetParam());
  const Ordered by_distance(set, true, UINT64_MAX), both(set, true, 400);
  EXPECT_LT(both.work.counters.created, by_distance.work.counters.created);
  EXPECT_EQ(simplices_of(both.work.complex), simplices_of(by_distance.work.complex));
}

INSTANTIATE_TEST_SUITE_P(Spheres, GrowthByGauge,
                         testing::Values("600 s D5 t1", "300 s D6 t2", "150 s D7 t3"));

}  // namespace
}  // namespace ndhull
