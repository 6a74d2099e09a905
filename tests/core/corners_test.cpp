// Which points are vertices, beside a plain pass over all rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "core/complex/simplicial_complex.h"

namespace ndhull {
namespace {

/// Rows with vertices only, no hull; every seventh is free.
SimplicialComplex rows_of_vertices(std::size_t rank, std::size_t rows, std::uint32_t points, unsigned seed) {
  SimplicialComplex complex(rank, rows);
  complex.row_count = rows;
  std::mt19937 random(seed);
  for (std::size_t row = 0; row < rows; ++row) {
    complex.state[row] = row % 7 == 3 ? SimplexState::kFree : SimplexState::kLive;
    for (std::size_t k = 0; k < rank; ++k)
      complex.topology[row * 2 * rank + k] = static_cast<std::uint32_t>(random() % points);
  }
  return complex;
}

std::vector<bool> corners_one_by_one(const SimplicialComplex& complex, std::size_t begin, std::size_t end,
                                     std::size_t point_count) {
  std::vector<bool> is_corner(point_count, false);
  for (std::size_t row = begin; row < end; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    for (const PointId id : complex.vertices(SimplexId{static_cast<std::uint32_t>(row)}))
      is_corner[id.value] = true;
  }
  return is_corner;
}

// With 50,000 rows the first of several blocks has them all; with 10^5 points none has.
TEST(Corners, AreThoseOfEachRow) {
  constexpr std::size_t kRows = 50'000;
  for (const std::uint32_t used : {40u, 3'000u, 100'000u}) {
    const SimplicialComplex complex = rows_of_vertices(5, kRows, used, used);
    for (const std::size_t point_count : {std::size_t{used}, std::size_t{used} + 1}) {
      const std::vector<bool> expected = corners_one_by_one(complex, 0, kRows, point_count);
      EXPECT_EQ(find_corners(complex, 0, kRows, point_count), expected);
      const auto most = static_cast<std::size_t>(std::count(expected.begin(), expected.end(), true));
      EXPECT_EQ(find_corners(complex, 0, kRows, point_count, most), expected);
      EXPECT_EQ(find_corners(complex, 20'001, 20'040, point_count),
                corners_one_by_one(complex, 20'001, 20'040, point_count));
    }
  }
}

}  // namespace
}  // namespace ndhull
