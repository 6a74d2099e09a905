// The witness of the complex finds each kind of damage, in a complex of which nothing else is wrong.
#include "core/complex/complex_check.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace ndhull {
namespace {

/// The boundary of a cross-polytope: simplex s has vertex k of axis k, on the side that bit k of s says.
SimplicialComplex cross_polytope(std::size_t rank, std::size_t copies = 1) {
  const std::uint32_t one = 1u << rank;
  SimplicialComplex complex(rank, one * copies);
  complex.row_count = one * copies;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    const std::uint32_t sides = row % one, copy = row / one;
    complex.state[row] = SimplexState::kLive;
    std::uint32_t* const ids = complex.topology.data() + std::size_t{row} * 2 * rank;
    unsigned odd = 0;
    for (std::uint32_t k = 0; k < rank; ++k) {
      const std::uint32_t side = sides >> k & 1u;
      odd ^= side;
      ids[k] = 2 * static_cast<std::uint32_t>(rank) * copy + 2 * k + side;
      ids[rank + k] = one * copy + (sides ^ 1u << k);
    }
    // Each axis that is turned around turns the row's orientation: an exchange turns it back.
    if (odd != 0 && rank > 1) {
      std::swap(ids[0], ids[1]);
      std::swap(ids[rank], ids[rank + 1]);
    }
  }
  return complex;
}

std::uint32_t& vertex(SimplicialComplex& complex, std::uint32_t row, std::size_t slot) {
  return complex.topology[std::size_t{row} * 2 * complex.rank + slot];
}
std::uint32_t& neighbour(SimplicialComplex& complex, std::uint32_t row, std::size_t slot) {
  return complex.topology[std::size_t{row} * 2 * complex.rank + complex.rank + slot];
}

void expect_problem(const SimplicialComplex& complex, const std::string& what) {
  const ComplexCheck check = check_complex(complex);
  EXPECT_FALSE(check.sound());
  EXPECT_NE(check.first_problem.find(what), std::string::npos) << check.first_problem;
}

TEST(ComplexCheckExample, CrossPolytopesAreSound) {
  for (std::size_t rank = 2; rank <= 13; ++rank) {
    const ComplexCheck check = check_complex(cross_polytope(rank));
    EXPECT_TRUE(check.sound()) << check.first_problem;
    EXPECT_EQ(check.simplices, 1u << rank);
  }
}

TEST(ComplexCheckExample, FreeRowsAreNoSimplices) {
  SimplicialComplex complex = cross_polytope(4, 2);
  for (std::uint32_t row = 16; row < 32; ++row) complex.state[row] = SimplexState::kFree;
  EXPECT_TRUE(check_complex(complex).sound());
  EXPECT_EQ(check_complex(complex).simplices, 16u);
  complex.state[3] = SimplexState::kFree;
  expect_problem(complex, "has no live neighbour");
}

TEST(ComplexCheckExample, ARepeatedVertexIsFound) {
  SimplicialComplex complex = cross_polytope(5);
  vertex(complex, 0, 1) = vertex(complex, 0, 4);
  expect_problem(complex, "simplex 0 slot 0: repeats a vertex");
}

TEST(ComplexCheckExample, ANeighbourThatDoesNotNameItBackIsFound) {
  SimplicialComplex complex = cross_polytope(5);
  neighbour(complex, 9, 2) = 22;  // shares two vertices
  expect_problem(complex, "simplex 9 slot 2: is not named back");
}

TEST(ComplexCheckExample, NeighboursInTheWrongSlotsAreFound) {
  SimplicialComplex complex = cross_polytope(5);
  std::swap(neighbour(complex, 9, 2), neighbour(complex, 9, 3));
  expect_problem(complex, "is not named back across the same ridge");
}

TEST(ComplexCheckExample, ATurnedSimplexIsFound) {
  SimplicialComplex complex = cross_polytope(5);
  std::swap(vertex(complex, 31, 2), vertex(complex, 31, 3));
  std::swap(neighbour(complex, 31, 2), neighbour(complex, 31, 3));
  expect_problem(complex, "is oriented against its neighbour");
  EXPECT_EQ(check_complex(complex).problems, 10u);  // five ridges, from both sides
}

TEST(ComplexCheckExample, TwoOfThemDoNotHangTogether) {
  expect_problem(cross_polytope(6, 2), "reaches 64 of 128 simplices");
}

TEST(ComplexCheckExample, ARidgeOfFourSimplicesIsFound) {
  // Two octahedra with an edge in common, which each closes over on its own: every neighbour is named back.
  SimplicialComplex complex = cross_polytope(3, 2);
  for (std::size_t i = 0; i < complex.row_count * std::size_t{6}; i += 6)
    for (std::size_t k = 0; k < 3; ++k)
      if (complex.topology[i + k] == 6 || complex.topology[i + k] == 8) complex.topology[i + k] -= 6;
  expect_problem(complex, "a ridge belongs to other than two simplices");
}

TEST(ComplexCheckExample, NeighboursOfTheSamePairThatAreExchangedAreFound) {
  // The two edges of a digon have both ends in common: each ridge of the pair is a ridge of its own.
  SimplicialComplex complex = cross_polytope(2);
  std::swap(neighbour(complex, 0, 0), neighbour(complex, 0, 1));
  expect_problem(complex, "is not named back across the same ridge");
}

TEST(ComplexCheckLaw, TheSameIsFoundWithAnyNumberOfThreads) {
  SimplicialComplex complex = cross_polytope(12);
  vertex(complex, 3000, 1) = vertex(complex, 3000, 4);
  neighbour(complex, 1000, 2) = 22;
  const ComplexCheck all = check_complex(complex);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const ComplexCheck alone = check_complex(complex);
  EXPECT_EQ(all.problems, alone.problems);
  EXPECT_EQ(all.first_problem, alone.first_problem);
  EXPECT_GT(alone.problems, 13u);
}

}  // namespace
}  // namespace ndhull
