// Linear programs with few rows: against all bases, closed forms, and the proofs that each end comes with.
#include "core/linear/column_simplex.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "core/linear/column_table.h"
#include "tests/support/named_polytopes.h"

namespace ndhull {
namespace {

/// A program written down: column j is entries.col(j).
struct Program {
  Eigen::MatrixXd entries;
  Eigen::VectorXd costs, rhs;

  std::size_t rows() const { return static_cast<std::size_t>(entries.rows()); }
  std::size_t columns() const { return static_cast<std::size_t>(entries.cols()); }
  std::span<const double> column(std::size_t j) const {
    return {entries.col(static_cast<Eigen::Index>(j)).data(), rows()};
  }
  ColumnTable table() const {
    ColumnTable table(rows(), columns());
    for (std::size_t j = 0; j < columns(); ++j) table.set(j, column(j), costs[static_cast<Eigen::Index>(j)]);
    return table;
  }
};

std::span<const double> as_span(const Eigen::VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

LpResult solve(const Program& program) {
  ColumnTable table = program.table();
  ColumnSimplex lp(as_span(program.rhs));
  return solve_lp(lp, [&](const LpQuery& query) { return table.price(query); });
}

/// sum lambda_j column_j - rhs, largest entry.
double residual(const Program& program, const LpResult& result) {
  Eigen::VectorXd rest = -program.rhs;
  for (std::size_t k = 0; k < result.basis.size(); ++k) {
    if (result.basis[k].valid()) rest += result.values[k] * program.entries.col(result.basis[k].value);
  }
  return rest.cwiseAbs().maxCoeff();
}

/// Expects an optimum by what proves one: a feasible point, feasible duals, equal objectives.
void expect_optimal(const Program& program, const LpResult& result) {
  ASSERT_EQ(result.status, LpStatus::kOptimal);
  const double size = 1.0 + std::abs(result.objective);
  EXPECT_LE(residual(program, result), 1e-11 * (1.0 + program.rhs.cwiseAbs().maxCoeff()));
  for (const double value : result.values) EXPECT_GE(value, 0.0);
  const Eigen::Map<const Eigen::VectorXd> duals(result.duals.data(), program.entries.rows());
  const Eigen::VectorXd reduced = program.costs - program.entries.transpose() * duals;
  EXPECT_GE(reduced.minCoeff(), -1e-11 * (1.0 + duals.cwiseAbs().maxCoeff()));
  EXPECT_NEAR(duals.dot(program.rhs), result.objective, 1e-11 * size);
  double objective = 0.0;
  for (std::size_t k = 0; k < result.basis.size(); ++k) {
    if (result.basis[k].valid()) objective += result.values[k] * program.costs[result.basis[k].value];
  }
  EXPECT_NEAR(objective, result.objective, 1e-12 * size);
}

void expect_infeasible(const Program& program, const LpResult& result) {
  ASSERT_EQ(result.status, LpStatus::kInfeasible);
  const Eigen::Map<const Eigen::VectorXd> duals(result.duals.data(), program.entries.rows());
  EXPECT_GT(duals.dot(program.rhs), 0.0);
  EXPECT_LE((program.entries.transpose() * duals).maxCoeff(), 1e-11 * duals.cwiseAbs().maxCoeff());
}

void expect_unbounded(const Program& program, const LpResult& result) {
  ASSERT_EQ(result.status, LpStatus::kUnbounded);
  EXPECT_LE(residual(program, result), 1e-11);
  Eigen::VectorXd move = program.entries.col(result.ray_column.value);
  double slope = program.costs[result.ray_column.value];
  for (std::size_t k = 0; k < result.basis.size(); ++k) {
    EXPECT_GE(result.ray[k], -1e-9);
    if (!result.basis[k].valid()) continue;
    move += result.ray[k] * program.entries.col(result.basis[k].value);
    slope += result.ray[k] * program.costs[result.basis[k].value];
  }
  EXPECT_LT(slope, 0.0);
  EXPECT_LE(move.cwiseAbs().maxCoeff(), 1e-10);
}

/// Smallest objective over all bases; +inf when none is feasible.
double best_of_all_bases(const Program& program) {
  const std::size_t rows = program.rows();
  std::vector<bool> chosen(program.columns(), false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(rows), true);
  double best = std::numeric_limits<double>::infinity();
  do {
    Eigen::MatrixXd basis(program.entries.rows(), program.entries.rows());
    Eigen::VectorXd costs(program.entries.rows());
    for (std::size_t j = 0, at = 0; j < chosen.size(); ++j) {
      if (!chosen[j]) continue;
      basis.col(static_cast<Eigen::Index>(at)) = program.entries.col(static_cast<Eigen::Index>(j));
      costs[static_cast<Eigen::Index>(at++)] = program.costs[static_cast<Eigen::Index>(j)];
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> factors(basis);
    if (!factors.isInvertible()) continue;
    const Eigen::VectorXd values = factors.solve(program.rhs);
    if (values.minCoeff() >= -1e-12) best = std::min(best, costs.dot(values));
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return best;
}

Program random_program(std::size_t rows, std::size_t columns, bool integers, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> small(-2, 2);
  const auto draw = [&] { return integers ? static_cast<double>(small(random)) : normal(random); };
  const auto m = static_cast<Eigen::Index>(rows), n = static_cast<Eigen::Index>(columns);
  Program program{Eigen::MatrixXd(m, n), Eigen::VectorXd(n), Eigen::VectorXd(m)};
  for (double& value : program.entries.reshaped()) value = draw();
  for (double& value : program.costs) value = draw();
  for (double& value : program.rhs) value = draw();
  return program;
}

TEST(ColumnSimplexOracle, SmallProgramsEndAsAllBasesSay) {
  std::mt19937_64 random(20240601);
  int optimal = 0, infeasible = 0, unbounded = 0;
  for (std::size_t round = 0; round < 600; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Program program = random_program(2 + round % 3, 5 + round % 5, round % 2 == 1, random);
    const LpResult result = solve(program);
    const double best = best_of_all_bases(program);
    if (result.status == LpStatus::kOptimal) {
      ++optimal;
      expect_optimal(program, result);
      if (std::isfinite(best)) {
        EXPECT_NEAR(result.objective, best, 1e-10 * (1.0 + std::abs(best)));
      }
    } else if (result.status == LpStatus::kUnbounded) {
      ++unbounded;
      expect_unbounded(program, result);
    } else {
      ++infeasible;
      expect_infeasible(program, result);
      EXPECT_FALSE(std::isfinite(best));
    }
  }
  EXPECT_GT(optimal, 50);
  EXPECT_GT(infeasible, 50);
  EXPECT_GT(unbounded, 50);
}

TEST(ColumnSimplexLaw, LargerProgramsComeWithAProof) {
  std::mt19937_64 random(7);
  for (const std::size_t rows : {5U, 20U, 60U, 200U}) {
    SCOPED_TRACE("rows " + std::to_string(rows));
    Program program = random_program(rows, 8 * rows, false, random);
    program.costs = program.costs.cwiseAbs();                                                    // bounded
    program.rhs = program.entries * Eigen::VectorXd::Random(program.entries.cols()).cwiseAbs();  // feasible
    expect_optimal(program, solve(program));
    program.rhs = program.entries.col(3) * 2.0;  // as degenerate as can be
    expect_optimal(program, solve(program));
  }
}

TEST(ColumnSimplexExample, ProgramThatCyclesUnderTheTextbookRuleEnds) {
  // Beale. Cycling in the dual simplex algorithm. Naval Research Logistics Quarterly 2, 1955.
  Program program{Eigen::MatrixXd(3, 7), Eigen::VectorXd(7), Eigen::VectorXd(3)};
  program.entries << 0.25, -60, -0.04, 9, 1, 0, 0, 0.5, -90, -0.02, 3, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  program.costs << -0.75, 150, -0.02, 6, 0, 0, 0;
  program.rhs << 0, 0, 1;
  const LpResult result = solve(program);
  expect_optimal(program, result);
  EXPECT_NEAR(result.objective, -0.05, 1e-15);
}

/// min sum lambda, sum lambda v = direction: the gauge of the direction in the hull of the points.
Program ray_program(const PointSet& points, const std::vector<double>& direction) {
  const auto d = static_cast<Eigen::Index>(points.dimension);
  const auto n = static_cast<Eigen::Index>(points.view().rows);
  Program program{Eigen::MatrixXd(d, n), Eigen::VectorXd::Ones(n),
                  Eigen::Map<const Eigen::VectorXd>(direction.data(), d)};
  for (Eigen::Index j = 0; j < n; ++j)
    points.view().copy_row(static_cast<std::size_t>(j), &program.entries(0, j));
  return program;
}

TEST(ColumnSimplexExample, RayThroughACubeMeetsTheSideOfItsLargestCoordinate) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (std::size_t d = 2; d <= 12; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    std::vector<double> direction(d);
    double largest = 0.0, sum = 0.0;
    for (double& value : direction) {
      value = normal(random);
      largest = std::max(largest, std::abs(value));
      sum += std::abs(value);
    }
    const Program in_cube = ray_program(cube(d).points, direction);
    LpResult result = solve(in_cube);
    expect_optimal(in_cube, result);
    EXPECT_NEAR(result.objective, largest, 1e-14 * largest);
    for (std::size_t k = 0; k < d; ++k) {  // the duals are the plane of that side
      const double expected = std::abs(direction[k]) == largest ? std::copysign(1.0, direction[k]) : 0.0;
      EXPECT_NEAR(result.duals[k], expected, 1e-14);
    }
    const Program in_cross_polytope = ray_program(cross_polytope(d).points, direction);
    result = solve(in_cross_polytope);
    expect_optimal(in_cross_polytope, result);
    EXPECT_NEAR(result.objective, sum, 1e-14 * sum);
  }
}

TEST(ColumnSimplexExample, WarmStartsEndWhereColdOnesDo) {
  std::mt19937_64 random(11);
  Program program = random_program(8, 400, false, random);
  program.costs = program.costs.cwiseAbs();
  program.rhs = program.entries * Eigen::VectorXd::Random(400).cwiseAbs();
  ColumnTable table = program.table();
  const auto price = [&](const LpQuery& query) { return table.price(query); };
  ColumnSimplex lp(as_span(program.rhs));
  const LpResult cold = solve_lp(lp, price);
  expect_optimal(program, cold);

  const auto start_from = [&](const std::vector<std::uint32_t>& ids) {
    std::vector<LpColumn> columns;
    for (const std::uint32_t id : ids)
      columns.push_back({LpColumnId{id}, program.costs[id], program.column(id)});
    lp.start_from(columns);
    const LpResult warm = solve_lp(lp, price);
    expect_optimal(program, warm);
    EXPECT_NEAR(warm.objective, cold.objective, 1e-12 * std::abs(cold.objective));
    return warm.pivots;
  };
  std::vector<std::uint32_t> optimal;
  for (const LpColumnId id : cold.basis) optimal.push_back(id.value);
  EXPECT_EQ(start_from(optimal), 0U);
  std::vector<std::uint32_t> any(8);
  std::iota(any.begin(), any.end(), 100U);
  start_from(any);                       // negative values
  start_from({1, 1, 2, 3, 4, 5, 6, 7});  // dependent
}

TEST(ColumnSimplexExample, RedundantAndEmptyRowsAreCarriedAlong) {
  std::mt19937_64 random(5);
  Program program = random_program(6, 60, false, random);
  program.costs = program.costs.cwiseAbs();
  program.entries.row(4) = program.entries.row(0) - 2.0 * program.entries.row(2);
  program.entries.row(5).setZero();
  program.rhs = program.entries * Eigen::VectorXd::Random(60).cwiseAbs();
  expect_optimal(program, solve(program));
  program.rhs[5] = 1e-3;
  expect_infeasible(program, solve(program));
}

TEST(ColumnSimplexExample, WithoutColumnsOnlyTheZeroRightSideIsFeasible) {
  const auto none = [](const LpQuery&) { return std::optional<LpColumn>(); };
  const std::vector<double> zero(3, 0.0), one{0.0, 1.0, 0.0};
  ColumnSimplex feasible(zero), infeasible(one);
  EXPECT_EQ(solve_lp(feasible, none).status, LpStatus::kOptimal);
  EXPECT_EQ(solve_lp(infeasible, none).status, LpStatus::kInfeasible);
}

TEST(ColumnSimplexExample, LimitOnPivotsIsSaid) {
  std::mt19937_64 random(9);
  Program program = random_program(10, 100, false, random);
  program.costs = program.costs.cwiseAbs();
  program.rhs = program.entries * Eigen::VectorXd::Random(100).cwiseAbs();
  ColumnTable table = program.table();
  ColumnSimplex lp(as_span(program.rhs), {.max_pivots = 3});
  const LpResult result = solve_lp(lp, [&](const LpQuery& query) { return table.price(query); });
  EXPECT_EQ(result.status, LpStatus::kStalled);
  EXPECT_EQ(result.pivots, 3U);
  EXPECT_GT(result.infeasibility, 0.0);
}

TEST(ColumnTableExample, FindsTheFirstOfTheLargestProducts) {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> small(-3, 3);  // ties; sums are exact
  for (std::size_t count = 1; count <= 200; count += 7) {
    for (const std::size_t height : {1U, 2U, 11U, 40U}) {
      ColumnTable table(height, count);
      std::vector<double> multipliers(height + 1), entries(height), products(count, 0.0);
      for (double& value : multipliers) value = small(random);
      for (std::size_t j = 0; j < count; ++j) {
        for (double& value : entries) value = small(random);
        const double cost = small(random);
        table.set(j, entries, cost);
        products[j] = std::inner_product(entries.begin(), entries.end(), multipliers.begin(), 0.0);
        products[j] += cost * multipliers.back();
      }
      const ColumnTable::Best best = table.largest_product(multipliers);
      const auto expected = std::max_element(products.begin(), products.end());
      EXPECT_EQ(best.product, *expected);
      EXPECT_EQ(best.column, static_cast<std::size_t>(expected - products.begin()))
          << count << " columns of height " << height;
      // Of the columns from a block's first to the end.
      const std::size_t first = count / 64 * 32;
      const ColumnTable::Best part = table.largest_product(multipliers, first, count);
      const auto of_part =
          std::max_element(products.begin() + static_cast<std::ptrdiff_t>(first), products.end());
      EXPECT_EQ(part.product, *of_part);
      EXPECT_EQ(part.column, static_cast<std::size_t>(of_part - products.begin()));
      table.set_cost(count - 1, 1000.0);
      multipliers.back() = 1.0;
      EXPECT_EQ(table.cost(count - 1), 1000.0);
      EXPECT_EQ(table.largest_product(multipliers).column, count - 1);
    }
  }
}

}  // namespace
}  // namespace ndhull
