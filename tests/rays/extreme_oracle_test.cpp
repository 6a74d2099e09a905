// Vertices against linear programs that another library solves in exact arithmetic.
#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#include <gtest/gtest.h>

#include "approx/rays/extreme_points.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

/// Is no combination of the other points, with weights >= 0 that sum to 1, equal to this one?
bool is_vertex_exactly(const PointSet& set, std::size_t row) {
  CGAL::Quadratic_program<double> program(CGAL::EQUAL, true, 0.0, false, 0.0);
  int column = 0;
  for (std::size_t other = 0; other < set.rows(); ++other) {
    if (other == row) continue;
    for (std::size_t k = 0; k < set.dimension; ++k) {
      program.set_a(column, static_cast<int>(k), set.row(other)[k]);
    }
    program.set_a(column++, static_cast<int>(set.dimension), 1.0);
  }
  for (std::size_t k = 0; k < set.dimension; ++k) program.set_b(static_cast<int>(k), set.row(row)[k]);
  program.set_b(static_cast<int>(set.dimension), 1.0);
  return CGAL::solve_nonnegative_linear_program(program, CGAL::Gmpzf()).is_infeasible();
}

TEST(ExtremePointsOracle, AgreeWithExactLinearPrograms) {
  for (const PointFamily family :
       {PointFamily::kGaussian, PointFamily::kCube, PointFamily::kBall, PointFamily::kLattice}) {
    for (const std::size_t d : {3U, 5U, 8U}) {
      SCOPED_TRACE(std::string(to_string(family)) + " " + std::to_string(d));
      const PointSet set = family_points(family, family == PointFamily::kLattice ? 27 : 40, d, 21);
      std::vector<PointId> expected;
      for (std::uint32_t row = 0; row < set.rows(); ++row) {
        if (is_vertex_exactly(set, row)) expected.push_back(PointId{row});
      }
      EXPECT_EQ(extreme_points(set.view()).vertices, expected);
    }
  }
}

}  // namespace
}  // namespace ndhull
