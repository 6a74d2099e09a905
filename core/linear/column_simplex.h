// Linear programs with few rows and very many columns that are never written down: a search names the next
// column. Chebyshev centres, facets hit by rays and planes of least width are such programs.
//
// Papers  Dantzig, Wolfe. Decomposition principle for linear programs. Operations Research 8(1), 1960
//         (columns from a search). Dantzig, Orden, Wolfe. The generalized simplex method. Pacific J. Math. 5,
//         1955 (ties settled by a perturbation of the right side that is never given a size).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ndhull {

/// A column of a linear program; the caller numbers them. None stands for an artificial column.
using LpColumnId = Id<struct LpColumnTag>;

/// One column: its cost and its entry in each row. The entries are read before the next call only.
struct LpColumn {
  LpColumnId id;
  double cost = 0.0;
  std::span<const double> entries;
};

/// What the simplex method wants to know: which column has the most negative reduced cost
/// cost_weight * cost - duals . entries. The weight is 0 while a feasible basis is sought, then 1.
struct LpQuery {
  std::span<const double> duals;
  double cost_weight = 0.0;

  double reduced_cost(const LpColumn& column) const;
};

enum class LpStatus {
  kRunning,     ///< asks for another column
  kOptimal,     ///< no column improves
  kInfeasible,  ///< duals prove it: duals . entries <= 0 for every column, duals . rhs > 0
  kUnbounded,   ///< the ray proves it
  kStalled,     ///< ended by the limit on pivots; values are feasible unless infeasibility > 0
};

struct LpOptions {
  /// Relative to the size of its terms: a reduced cost less negative than this is rounding. 1e-12 is some
  /// fifty times the error of a sum of a hundred terms and of duals from a fresh factorisation.
  double cost_tolerance = 1e-12;
  /// [ratio] to the sum of |rhs|: artificial columns that hold less than this are rounding.
  double feasibility_tolerance = 1e-11;
  std::uint64_t max_pivots = 0;  ///< 0: 1000 + 100 a row
};

/// The end of a run, or how far it is. Row k of the tables belongs to column basis[k].
struct LpResult {
  LpStatus status = LpStatus::kRunning;
  double objective = 0.0;         ///< of the values
  double infeasibility = 0.0;     ///< what artificial columns hold, >= 0
  std::vector<LpColumnId> basis;  ///< as many as rows; none where an artificial column was left, at value 0
  std::vector<double> values;     ///< lambda of each, >= 0
  std::vector<double> duals;      ///< one a row
  /// kUnbounded: adding any multiple of `ray` to the basis's values and of 1 to ray_column's keeps all rows,
  /// keeps all values >= 0, and lowers the objective without end.
  std::vector<double> ray;
  LpColumnId ray_column;
  std::uint64_t pivots = 0;
};

/// Minimises sum cost_j lambda_j subject to sum lambda_j column_j = rhs, lambda >= 0, one column at a time.
///
/// Use     while (lp.running()) lp.offer(the column that answers lp.query(), or nothing);
///         so that a caller with many programs can price them together. `solve_lp` is that loop.
/// Scale   rows and columns should be of size 1 or so: tolerances are relative to the largest terms.
/// Ties    of the ratio test are settled by a second right side, a random vector (always the same one) that
///         is infinitely smaller than the first: no cycling on degenerate programs.
/// Rounding  Columns that are parallel but for 1e-11 of their size may be exchanged without end. After 250
///         pivots and 25 a row the tolerances are 100 times larger, after twice as many 10,000 times: `pivots`
///         says so.
/// Cost    O(rows^2) a pivot, and O(rows^3) for each of the regular refactorisations.
class ColumnSimplex {
 public:
  explicit ColumnSimplex(std::span<const double> rhs, const LpOptions& options = {});

  /// Starts over from these columns, as many as rows. When they are no feasible basis of this right side,
  /// artificial columns take the places of those that would be negative; when they are dependent, of all.
  void start_from(std::span<const LpColumn> basis);

  bool running() const { return status_ == LpStatus::kRunning; }
  LpQuery query() const;
  /// Answers the query: the best column, or nothing when there are no columns at all. Whether it improves is
  /// decided here.
  void offer(const std::optional<LpColumn>& best);
  LpResult result() const;

 private:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  void start_artificial();
  void begin_phase_one();
  void leave_phase_one();
  bool refactor();
  void compute_duals();
  void draw_perturbation();
  Vector values_of(const Vector& right_side) const;
  Eigen::Index choose_row(const Vector& alpha) const;
  void pivot(Eigen::Index row, const LpColumn& column, const Vector& entries, const Vector& alpha);
  void conclude();
  double held_by_artificials() const;
  double looseness() const;
  bool is_feasible() const;

  LpOptions options_;
  Vector rhs_;
  Matrix columns_;       // of the basis
  Matrix inverse_;       // of columns_
  Vector values_;        // inverse_ * rhs_, zeros exact
  Vector perturbation_;  // the same of the second right side; >= 0 where values_ is 0
  Vector costs_;         // of the basis, in this phase
  Vector own_costs_;     // of the basis, the program's
  Vector duals_;
  std::vector<LpColumnId> basis_;
  Vector ray_;
  LpColumnId ray_column_;
  bool phase_one_ = true;
  std::uint64_t since_refactor_ = 0;
  std::uint64_t pivots_ = 0;
  std::uint64_t random_state_ = 0;
  LpStatus status_ = LpStatus::kRunning;
};

/// Finds the column that answers a query, nothing when there are no columns.
using PriceColumns = std::function<std::optional<LpColumn>(const LpQuery&)>;

/// Runs `lp` to its end.
LpResult solve_lp(ColumnSimplex& lp, const PriceColumns& price);

}  // namespace ndhull
