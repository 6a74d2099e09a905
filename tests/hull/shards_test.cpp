// Points in parts, held by several processes: the result is that of one process with all of them.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "approx/reduction/point_reduction.h"
#include "approx/reduction/reduced_points.h"
#include "tests/hull/hull_support.h"
#include "tests/hull/process_threads.h"

namespace ndhull {
namespace {

bool never_late() { return false; }

std::vector<double> numbers_of(const PointView& points) {
  std::vector<double> numbers(points.rows * points.dimension);
  for (std::size_t row = 0; row < points.rows; ++row)
    points.copy_row(row, numbers.data() + row * points.dimension);
  return numbers;
}

/// Point sets whose reduction takes all its ways: one pass, several, ties, a frame that turns.
std::vector<PointSet> reduced_sets() {
  PointSet skew = family_points(PointFamily::kGaussian, 120'000, 4, 201);
  for (std::size_t row = 0; row < skew.rows(); ++row) {
    skew.row(row)[1] = 1e3 * skew.row(row)[0] + 1e-2 * skew.row(row)[1];
    skew.row(row)[2] += 1e5;
  }
  return {family_points(PointFamily::kGaussian, 150'000, 6, 202),
          family_points(PointFamily::kSphere, 100'000, 5, 203), std::move(skew),
          generate_points({.family = PointFamily::kLattice, .dimension = 4, .count = 0, .side = 18})};
}

TEST(ShardsLaw, WhatIsKeptDoesNotDependOnThePartsNorOnWhoHoldsThem) {
  for (const PointSet& set : reduced_sets()) {
    SCOPED_TRACE(set.header);
    const PointShards whole = PointShards::whole(set.view());
    const std::vector<std::uint32_t> expected = find_points_to_keep(whole, 1, never_late).rows;
    const std::vector<double> rows = numbers_of(ReducedPoints(whole, expected).view());
    const std::size_t n = set.rows();
    const std::vector<std::vector<std::size_t>> cuttings = {
        {0, n}, {0, n / 7, n}, {0, n / 3, n / 3, n - 1, n}};  // one of the four has no rows
    for (const std::vector<std::size_t>& cuts : cuttings) {
      SCOPED_TRACE(std::to_string(cuts.size() - 1) + " processes");
      run_processes(set.view(), cuts, [&](std::size_t process, const PointShards& shards) {
        const ReducedPoints kept(shards, find_points_to_keep(shards, 1, never_late).rows);
        if (process == 0) {
          EXPECT_EQ(kept.ids(), expected);
          EXPECT_EQ(numbers_of(kept.view()), rows);
        } else {
          EXPECT_TRUE(kept.ids().empty());
        }
      });
    }
  }
}

TEST(ShardsLaw, WhatOneProcessFindsNotFiniteAllKeep) {
  PointSet set = family_points(PointFamily::kGaussian, 120'000, 3, 204);
  set.row(119'000)[1] = HUGE_VAL;
  run_processes(set.view(), {0, 50'000, 120'000}, [&](std::size_t process, const PointShards& shards) {
    EXPECT_EQ(find_points_to_keep(shards, 1, never_late).rows.size(), process == 0 ? 50'000U : 70'000U);
  });
}

TEST(ShardsLaw, WhenOneProcessIsLateAllEndTheSamePass) {
  const PointSet set = family_points(PointFamily::kGaussian, 200'000, 7, 205);
  std::size_t kept = 0;
  run_processes(set.view(), {0, 90'000, 200'000}, [&](std::size_t process, const PointShards& shards) {
    const ReducedPoints points(shards, find_points_to_keep(shards, 1, [&] { return process == 1; }).rows);
    if (process == 0) kept = points.ids().size();
  });
  const PointShards whole = PointShards::whole(set.view());
  EXPECT_EQ(kept, find_points_to_keep(whole, 1, [] { return true; }).rows.size());
  EXPECT_GT(kept, find_points_to_keep(whole, 1, never_late).rows.size());
}

}  // namespace
}  // namespace ndhull
