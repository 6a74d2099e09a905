// The tree of heights beside a search through all of them.
#include "core/outside_heights.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

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
    const OutsideHeights::Furthest found = heights.furthest(), expected = furthest_of(places);
    ASSERT_EQ(found.height, expected.height) << "round " << round;
    ASSERT_EQ(found.row, expected.row) << "round " << round;
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

}  // namespace
}  // namespace ndhull
