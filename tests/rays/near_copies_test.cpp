// Copies of points, beside a look at all pairs.
#include "approx/rays/near_copies.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ndhull {
namespace {

std::vector<std::uint32_t> by_all_pairs(const std::vector<double>& rows, std::size_t dimension,
                                        double distance) {
  std::vector<std::uint32_t> first_of(rows.size() / dimension);
  for (std::uint32_t id = 0; id < first_of.size(); ++id) {
    first_of[id] = id;
    for (std::uint32_t other = 0; other < id && first_of[id] == id; ++other) {
      double distance_sq = 0.0;
      for (std::size_t k = 0; k < dimension; ++k) {
        const double difference = rows[id * dimension + k] - rows[other * dimension + k];
        distance_sq += difference * difference;
      }
      if (first_of[other] == other && distance_sq <= distance * distance) first_of[id] = other;
    }
  }
  return first_of;
}

// On a coarse grid many points are equal, and chains of neighbours are as near to the next as is asked for.
RC_GTEST_PROP(NearCopies, AreThoseOfAllPairs, ()) {
  const std::size_t dimension = *rc::gen::inRange<std::size_t>(1, 5);
  const auto count = *rc::gen::inRange<std::size_t>(1, 80);
  const int side = *rc::gen::inRange(1, 12);
  const double distance = 0.5 * *rc::gen::inRange(0, 5);
  const auto grid = *rc::gen::container<std::vector<int>>(count * dimension, rc::gen::inRange(0, side));
  const std::vector<double> rows(grid.begin(), grid.end());
  RC_ASSERT(find_near_copies(rows.data(), count, dimension, distance) ==
            by_all_pairs(rows, dimension, distance));
}

// Looking at each copy for each other would take hours.
TEST(NearCopies, MillionsOfFewPointsAreNoWork) {
  constexpr std::size_t kCount = 2'000'000, kPoints = 5;
  std::vector<double> rows(kCount);
  for (std::size_t i = 0; i < kCount; ++i) rows[i] = static_cast<double>(i * 3 % kPoints);
  for (const double distance : {0.0, 0.25}) {
    const std::vector<std::uint32_t> first_of = find_near_copies(rows.data(), kCount, 1, distance);
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(first_of[i], i % kPoints);
  }
}

}  // namespace
}  // namespace ndhull
