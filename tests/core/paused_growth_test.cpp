// Growth that pauses beside growth that does not.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "core/complex/complex_check.h"
#include "core/growth/growth.h"
#include "tests/prepared_growth.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

/// Pauses whenever the hull has grown by half; `between` is called at each pause.
class GrownInParts {
 public:
  GrownInParts(const PointSet& set, std::uint64_t pause_rows,
               const std::function<void(GrownInParts&)>& between) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    work.options.pause_rows = pause_rows;
    start_growth(work, frame.simplex, FirstPoints());
    GrowthStop stop = GrowthStop::kPaused;
    while ((stop = go_on()) == GrowthStop::kPaused) {
      EXPECT_NE(work.paused, nullptr);
      ++pauses;
      pause_rows += pause_rows / 2;
      work.options.pause_rows = pause_rows;
      between(*this);
    }
    EXPECT_EQ(stop, GrowthStop::kNoOutsidePoints);
    EXPECT_EQ(work.paused, nullptr);
    const ComplexCheck check = check_complex(work.complex);
    EXPECT_TRUE(check.sound()) << check.first_problem;
  }

  void move_points() {
    std::vector<double> elsewhere = coordinates;
    std::fill(coordinates.begin(), coordinates.end(), NAN);
    before.push_back(std::move(coordinates));
    coordinates = std::move(elsewhere);
    work.points = coordinates.data();
  }
  bool is_same(const GrownInParts& other) const {
    const SimplicialComplex &a = work.complex, &b = other.work.complex;
    return a.row_count == b.row_count &&
           std::memcmp(a.planes.data(), b.planes.data(), a.row_count * a.rank * sizeof(double)) == 0 &&
           std::memcmp(a.topology.data(), b.topology.data(), a.row_count * 2 * a.rank * 4) == 0 &&
           std::memcmp(a.state.data(), b.state.data(), a.row_count) == 0;
  }

  int threads = 2;
  std::size_t pauses = 0;
  GrowthWork work;

 private:
  GrowthStop go_on() {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return grow(work); });
  }

  std::vector<double> coordinates;
  std::vector<std::vector<double>> before;
};

class PausedGrowth : public testing::TestWithParam<const char*> {};

TEST_P(PausedGrowth, GoesOnAsIfItHadNotPaused) {
  const PointSet set = rbox(GetParam());
  const GrownInParts whole(set, 0, [](GrownInParts&) {});
  EXPECT_EQ(whole.pauses, 0u);
  const std::function<void(GrownInParts&)> between[] = {
      [](GrownInParts&) {},
      [](GrownInParts& grown) { grown.move_points(); },
      [](GrownInParts& grown) { grown.threads = 3 - grown.threads; },
      [](GrownInParts& grown) { grown.work.paused.reset(); },
      [](GrownInParts& grown) { make_room_for(grown.work, 4 * grown.work.complex.row_count); },
  };
  for (const auto& change : between) {
    const GrownInParts parts(set, 20, change);
    EXPECT_GE(parts.pauses, 5u);
    EXPECT_TRUE(parts.is_same(whole)) << &change - between;
  }
}

// The tables move at 512 and at 8192 rows.
INSTANTIATE_TEST_SUITE_P(Sets, PausedGrowth,
                         testing::Values("400 s D3 t1", "300 s D4 t2", "1500 s D5 t3", "200 D7 t4"));

}  // namespace
}  // namespace ndhull
