// Growth that pauses, or ends and goes on, beside growth that does not.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include "core/complex/complex_check.h"
#include "core/growth/growth.h"
#include "tests/prepared_growth.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

bool is_same(const GrowthWork& one, const GrowthWork& other) {
  const SimplicialComplex &a = one.complex, &b = other.complex;
  return a.row_count == b.row_count &&
         std::memcmp(a.planes.data(), b.planes.data(), a.row_count * a.rank * sizeof(double)) == 0 &&
         std::memcmp(a.topology.data(), b.topology.data(), a.row_count * 2 * a.rank * 4) == 0 &&
         std::memcmp(a.state.data(), b.state.data(), a.row_count) == 0;
}

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
      EXPECT_NE(work.grower, nullptr);
      ++pauses;
      pause_rows += pause_rows / 2;
      work.options.pause_rows = pause_rows;
      between(*this);
    }
    EXPECT_EQ(stop, GrowthStop::kNoOutsidePoints);
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
      [](GrownInParts& grown) { grown.work.grower.reset(); },
      [](GrownInParts& grown) { make_room_for(grown.work, 4 * grown.work.complex.row_count); },
  };
  for (const auto& change : between) {
    const GrownInParts parts(set, 20, change);
    EXPECT_GE(parts.pauses, 5u);
    EXPECT_TRUE(is_same(parts.work, whole.work)) << &change - between;
  }
}

/// Growth with a width, at whose end all points left out go back.
class GrownTwice {
 public:
  explicit GrownTwice(bool keeps_grower) {
    const PointSet set = rbox("400 s D4 t5");
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    const std::size_t rank = work.rank;
    work.options.gradient_factor.assign(rank * rank, 0.0);
    for (std::size_t k = 0; k < rank; ++k) work.options.gradient_factor[k * rank + k] = 1.0;
    work.options.outside_width = 0.1;
    start_growth(work, frame.simplex, FirstPoints());
    EXPECT_EQ(grow(work), GrowthStop::kNoOutsidePoints);
    EXPECT_NE(work.grower, nullptr);
    if (!keeps_grower) work.grower.reset();
    put_back_all();
    put_back = work.points_outside;
    work.options.outside_width = 0.0;
    EXPECT_EQ(grow(work), GrowthStop::kNoOutsidePoints);
    const ComplexCheck check = check_complex(work.complex);
    EXPECT_TRUE(check.sound()) << check.first_problem;
  }

  GrowthWork work;
  std::uint64_t put_back = 0;

 private:
  void put_back_all() {
    for (std::uint32_t id = 0; id < work.point_count; ++id) {
      double highest = 2.0 * work.options.shift;
      std::uint32_t below = 0;
      for (std::uint32_t row = 0; row < work.complex.row_count; ++row) {
        if (work.complex.state[row] != SimplexState::kLive) continue;
        const std::span<const double> plane = work.complex.plane(SimplexId{row});
        const double gauge =
            std::inner_product(plane.begin(), plane.end(), work.points + std::size_t{id} * work.rank, -1.0);
        if (gauge > highest) below = row;
        highest = std::max(highest, gauge);
      }
      if (highest > 2.0 * work.options.shift)
        push_outside(work, id, below, height_above(work, below, highest));
    }
  }

  std::vector<double> coordinates;
};

TEST(EndedGrowth, GoesOnWithPointsPutBackAsIfItBeganAnew) {
  const GrownTwice kept(true), anew(false);
  EXPECT_GE(kept.put_back, 50u);
  EXPECT_EQ(kept.work.most_vertices(), 400u);
  EXPECT_TRUE(is_same(kept.work, anew.work));
}

// The tables move at 512 and at 8192 rows.
INSTANTIATE_TEST_SUITE_P(Sets, PausedGrowth,
                         testing::Values("400 s D3 t1", "300 s D4 t2", "1500 s D5 t3", "200 D7 t4"));

}  // namespace
}  // namespace ndhull
