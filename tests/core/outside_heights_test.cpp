// The tree of heights beside a search through all of them.
#include "core/search/outside_heights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "core/growth/growth.h"
#include "tests/prepared_growth.h"

namespace ndhull {
namespace {

struct Place {
  std::uint32_t row;
  double height;
};

OutsideHeights::Furthest furthest_of(const std::map<std::uint32_t, Place>& places) {
  OutsideHeights::Furthest furthest{OutsideHeights::kNotOutside, 0};
  for (const auto& [point, place] : places) {
    if (place.height > furthest.height || (place.height == furthest.height && place.row < furthest.row))
      furthest = {place.height, place.row};
  }
  return furthest;
}

class OutsideHeightsOfSizes : public testing::TestWithParam<std::uint32_t> {};

TEST_P(OutsideHeightsOfSizes, NamesTheFurthestOfAllAndTheLowestRowOfTies) {
  const std::uint32_t count = GetParam();
  std::mt19937 random(count);
  const auto below = [&](std::uint32_t bound) { return static_cast<std::uint32_t>(random() % bound); };
  OutsideHeights heights;
  heights.reset(count);
  std::map<std::uint32_t, Place> places;
  for (unsigned round = 0; round < 400; ++round) {
    for (unsigned change = 0; change < below(40); ++change) {
      const std::uint32_t point = below(count);
      if (below(3) == 0) {
        heights.remove(point);
        places.erase(point);
      } else {  // few different heights: ties in one block, between blocks, and of the largest
        const Place place{below(1000), 0.25 * below(round % 2 == 0 ? 7 : 1'000'000)};
        heights.put(point, place.row, place.height);
        places[point] = place;
        ASSERT_EQ(heights.height(point), place.height);
      }
    }
    for (unsigned change = 0; change < below(20); ++change) {
      const std::uint32_t point = below(count);
      const Place place{below(1000), 0.25 * below(7)};
      heights.put_apart(point, place.row, place.height);
      heights.settle(point);
      places[point] = place;
    }
    const OutsideHeights::Furthest found = heights.furthest(), expected = furthest_of(places);
    ASSERT_EQ(found.height, expected.height) << "round " << round;
    ASSERT_EQ(found.row, expected.row) << "round " << round;
    const double low = 0.25 * below(7);
    std::vector<std::uint32_t> above, expected_above;
    heights.list_above(low, above);
    for (const auto& [point, place] : places)
      if (place.height > low) expected_above.push_back(point);
    ASSERT_EQ(above, expected_above) << "round " << round;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, OutsideHeightsOfSizes, testing::Values(1, 63, 64, 65, 4096, 4097, 300'000));

TEST(OutsideHeights, KeepsWhatIsOutsideWhenThereAreMorePoints) {
  OutsideHeights heights;
  heights.reset(10);
  heights.put(3, 7, 0.5);
  heights.put(9, 8, 0.0);
  heights.extend(5000);
  EXPECT_EQ(heights.furthest().row, 7u);
  heights.remove(3);
  EXPECT_EQ(heights.furthest().row, 8u);
  heights.put(4999, 1, 0.25);
  EXPECT_EQ(heights.furthest().row, 1u);
  heights.remove(4999);
  heights.remove(9);
  EXPECT_EQ(heights.furthest().height, OutsideHeights::kNotOutside);
}

/// The points of an outside set, as its list has them.
std::vector<std::uint32_t> points_of(const GrowthWork& work, std::uint32_t row) {
  std::vector<std::uint32_t> points;
  for (std::uint32_t next = work.complex.outside_head[row]; next != 0; next = work.next_outside[next - 1])
    points.push_back(next - 1);
  return points;
}

TEST(OutsideSets, APointTakenOutLeavesTheOthersTheFurthestFirst) {
  std::mt19937 random(3);
  std::vector<double> rows(300 * 4);
  for (double& x : rows) x = static_cast<double>(random()) * 0x1p-32;
  const PointView points = PointView::row_major(rows.data(), 300, 4);
  std::vector<double> coordinates;
  GrowthWork work;
  const Frame frame = prepare_growth(points, coordinates, work);
  start_growth(work, frame.simplex, FirstPoints());
  std::size_t taken = 0;
  for (std::uint32_t row = 0; row < work.complex.row_count; ++row) {
    for (std::vector<std::uint32_t> left = points_of(work, row); !left.empty(); ++taken) {
      const std::uint32_t point = left[taken % 3 * (left.size() - 1) / 2];  // first, middle, last
      const std::uint64_t outside = work.points_outside;
      take_from_outside(work, point);
      EXPECT_EQ(work.points_outside, outside - 1);
      EXPECT_EQ(work.heights.height(point), OutsideHeights::kNotOutside);
      left.erase(std::find(left.begin(), left.end(), point));
      std::vector<std::uint32_t> found = points_of(work, row);
      for (const std::uint32_t other : found)
        EXPECT_LE(work.heights.height(other), work.heights.height(found[0]));
      std::vector<std::uint32_t> expected = left;
      std::sort(expected.begin(), expected.end());
      left = found;
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected);
    }
  }
  EXPECT_GT(taken, 100U);
  EXPECT_EQ(work.points_outside, 0U);
}

}  // namespace
}  // namespace ndhull
