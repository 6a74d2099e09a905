#include "core/linear/column_simplex.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/linear/dense_solve.h"
#include "core/linear/dense_views.h"
#include "core/scramble.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;

/// Entries of a pivot column below this share of the largest are not pivoted on: the inverse would lose the
/// other digits.
constexpr double kSmallestPivot = 1e-9;
/// Values below this share of the largest are taken for 0, and ratios that differ by less for equal: some
/// thousand times the rounding of a value when the basis is well conditioned.
constexpr double kValueRoundoff = 1e-12;
/// How far an entry of the perturbation may be overdrawn for the sake of a larger pivot. They start between 0.5
/// and 1.
constexpr double kPerturbationSlack = 1e-3;
/// A factorisation with a smaller reciprocal condition has no digits left.
constexpr double kSingular = 1e-14;

/// After kPatience + kPatienceARow * rows pivots the program is taken to go round in circles among nearly
/// parallel columns, and tolerances grow by kLooser; again after as many.
constexpr std::uint64_t kPatience = 250, kPatienceARow = 25;
constexpr double kLooser = 100.0;

double next_unit(std::uint64_t& state) {
  const std::uint64_t number = scramble(state);
  state += kScrambleStep;
  return static_cast<double>(number >> 11) * 0x1p-53;
}

}  // namespace

double LpQuery::reduced_cost(const LpColumn& column) const {
  double sum = cost_weight * column.cost;
  for (std::size_t row = 0; row < duals.size(); ++row) sum -= duals[row] * column.entries[row];
  return sum;
}

ColumnSimplex::ColumnSimplex(std::span<const double> rhs, const LpOptions& options)
    : options_(options),
      rhs_(Eigen::Map<const Vector>(rhs.data(), static_cast<Index>(rhs.size()))),
      basis_(rhs.size()) {
  if (options_.max_pivots == 0) options_.max_pivots = 1000 + 100 * rhs.size();
  own_costs_ = Vector::Zero(rhs_.size());
  start_artificial();
  begin_phase_one();
}

void ColumnSimplex::start_artificial() {
  std::fill(basis_.begin(), basis_.end(), LpColumnId());
  own_costs_.setZero();
  columns_ = rhs_.unaryExpr([](double value) { return value < 0.0 ? -1.0 : 1.0; }).asDiagonal();
  inverse_ = columns_;
  values_ = rhs_.cwiseAbs();
  since_refactor_ = 0;
}

void ColumnSimplex::start_from(std::span<const LpColumn> basis) {
  NDHULL_CHECK(basis.size() == basis_.size());
  status_ = LpStatus::kRunning;
  pivots_ = 0;
  random_state_ = 0;
  for (std::size_t k = 0; k < basis.size(); ++k) {
    const auto column = static_cast<Index>(k);
    basis_[k] = basis[k].id;
    own_costs_[column] = basis[k].cost;
    columns_.col(column) = Eigen::Map<const Vector>(basis[k].entries.data(), rhs_.size());
  }
  if (!refactor()) start_artificial();
  begin_phase_one();
}

/// The inverse of a column with its sign changed is the inverse's row with its sign changed: an artificial
/// column opposite a basic one makes a negative value positive and leaves all others.
void ColumnSimplex::begin_phase_one() {
  for (Index k = 0; k < values_.size(); ++k) {
    if (values_[k] >= 0.0) continue;
    basis_[static_cast<std::size_t>(k)] = LpColumnId();
    own_costs_[k] = 0.0;
    columns_.col(k) *= -1.0;
    inverse_.row(k) *= -1.0;
    values_[k] = -values_[k];
  }
  phase_one_ = true;
  costs_.resize(values_.size());
  for (Index k = 0; k < values_.size(); ++k) {
    costs_[k] = basis_[static_cast<std::size_t>(k)].valid() ? 0.0 : 1.0;
  }
  draw_perturbation();
  compute_duals();
  if (held_by_artificials() == 0.0) leave_phase_one();
}

void ColumnSimplex::leave_phase_one() {
  phase_one_ = false;
  for (Index k = 0; k < values_.size(); ++k) {
    if (!basis_[static_cast<std::size_t>(k)].valid()) values_[k] = 0.0;
  }
  costs_ = own_costs_;
  draw_perturbation();
  compute_duals();
}

/// A fresh second right side: whatever makes all of the perturbation positive will do. Artificial columns of phase two
/// must stay at nothing at all.
void ColumnSimplex::draw_perturbation() {
  perturbation_.resize(values_.size());
  for (Index k = 0; k < values_.size(); ++k) {
    const bool held = phase_one_ || basis_[static_cast<std::size_t>(k)].valid();
    perturbation_[k] = held ? 0.5 + 0.5 * next_unit(random_state_) : 0.0;
  }
}

double ColumnSimplex::held_by_artificials() const {
  double sum = 0.0;
  for (Index k = 0; k < values_.size(); ++k) {
    if (!basis_[static_cast<std::size_t>(k)].valid()) sum += values_[k];
  }
  return sum;
}

bool ColumnSimplex::is_feasible() const {
  return held_by_artificials() <= looseness() * options_.feasibility_tolerance * rhs_.cwiseAbs().sum();
}

double ColumnSimplex::looseness() const {
  const std::uint64_t patience = kPatience + kPatienceARow * basis_.size();
  return std::pow(kLooser, static_cast<double>(pivots_ / patience));
}

/// One step of refinement: the inverse is good to its condition, the values to rounding.
ColumnSimplex::Vector ColumnSimplex::values_of(const Vector& right_side) const {
  Vector values = inverse_ * right_side;
  values += inverse_ * (right_side - columns_ * values);
  return values;
}

bool ColumnSimplex::refactor() {
  const SquareFactors factors(columns_);
  if (!(factors.reciprocal_condition() > kSingular)) return false;
  inverse_ = factors.inverse();
  values_ = values_of(rhs_);
  const double roundoff = kValueRoundoff * values_.cwiseAbs().maxCoeff();
  values_ = values_.unaryExpr([roundoff](double value) { return std::abs(value) <= roundoff ? 0.0 : value; });
  since_refactor_ = 0;
  return true;
}

void ColumnSimplex::compute_duals() {
  duals_ = inverse_.transpose() * costs_;
  if (since_refactor_ == 0) duals_ += inverse_.transpose() * (costs_ - columns_.transpose() * duals_);
}

LpQuery ColumnSimplex::query() const { return {as_span(duals_), phase_one_ ? 0.0 : 1.0}; }

/// The row whose value falls to 0 first, -1 when none does.
Index ColumnSimplex::choose_row(const Vector& alpha) const {
  const double smallest = kSmallestPivot * alpha.cwiseAbs().maxCoeff();
  if (!phase_one_) {
    // An artificial column that would move, up or down, leaves at 0.
    Index leaving = -1;
    for (Index k = 0; k < alpha.size(); ++k) {
      if (basis_[static_cast<std::size_t>(k)].valid() || std::abs(alpha[k]) <= smallest) continue;
      if (leaving < 0 || std::abs(alpha[k]) > std::abs(alpha[leaving])) leaving = k;
    }
    if (leaving >= 0) return leaving;
  }
  const double roundoff = kValueRoundoff * values_.maxCoeff();
  double step = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < alpha.size(); ++k) {
    if (alpha[k] > smallest) step = std::min(step, (values_[k] + roundoff) / alpha[k]);
  }
  const auto is_tied = [&](Index k) { return alpha[k] > smallest && values_[k] <= step * alpha[k]; };
  double perturbation_step = std::numeric_limits<double>::infinity();
  // Entries of rows that are not near 0 may be negative; among tied rows only the order matters.
  for (Index k = 0; k < alpha.size(); ++k) {
    if (is_tied(k))
      perturbation_step = std::min(perturbation_step, (perturbation_[k] + kPerturbationSlack) / alpha[k]);
  }
  Index leaving = -1;
  for (Index k = 0; k < alpha.size(); ++k) {
    if (!is_tied(k) || perturbation_[k] > perturbation_step * alpha[k]) continue;
    if (leaving < 0 || alpha[k] > alpha[leaving]) leaving = k;
  }
  return leaving;
}

void ColumnSimplex::pivot(Index row, const LpColumn& column, const Vector& entries, const Vector& alpha) {
  const bool drives_out = !phase_one_ && !basis_[static_cast<std::size_t>(row)].valid();
  const double step = drives_out ? 0.0 : values_[row] / alpha[row];
  const double perturbation_step = perturbation_[row] / alpha[row];
  const double roundoff = kValueRoundoff * values_.maxCoeff();
  for (Index k = 0; k < alpha.size(); ++k) {
    const double value = values_[k] - step * alpha[k];
    values_[k] = value <= roundoff && value < values_[k] ? 0.0 : value;
    perturbation_[k] -= perturbation_step * alpha[k];
    if (values_[k] == 0.0) perturbation_[k] = std::max(perturbation_[k], 0.0);
  }
  values_[row] = step;
  perturbation_[row] = perturbation_step;
  const Eigen::RowVectorXd pivot_row = inverse_.row(row) / alpha[row];
  inverse_.noalias() -= alpha * pivot_row;
  inverse_.row(row) = pivot_row;
  columns_.col(row) = entries;
  basis_[static_cast<std::size_t>(row)] = column.id;
  own_costs_[row] = column.cost;
  costs_[row] = phase_one_ ? 0.0 : column.cost;
  ++pivots_;
  ++since_refactor_;
  if (drives_out) draw_perturbation();
}

void ColumnSimplex::offer(const std::optional<LpColumn>& best) {
  NDHULL_CHECK(running());
  if (!best) return conclude();
  const Eigen::Map<const Vector> given(best->entries.data(), rhs_.size());
  const double weight = phase_one_ ? 0.0 : 1.0;
  const double size = weight * std::abs(best->cost) + duals_.cwiseAbs().dot(given.cwiseAbs());
  if (!(query().reduced_cost(*best) < -looseness() * options_.cost_tolerance * size)) return conclude();
  if (pivots_ >= options_.max_pivots) {
    status_ = LpStatus::kStalled;
    return;
  }
  const Vector entries = given;
  const Vector alpha = inverse_ * entries;
  const Index row = choose_row(alpha);
  if (row < 0) {
    if (since_refactor_ > 0) return conclude();  // look again with a fresh inverse
    // While a feasible basis is sought the objective cannot fall without end: only rounding says so.
    status_ = phase_one_ ? LpStatus::kStalled : LpStatus::kUnbounded;
    ray_ = -alpha;
    ray_column_ = best->id;
    return;
  }
  pivot(row, *best, entries, alpha);
  if (phase_one_ && (held_by_artificials() == 0.0 || (looseness() > 1.0 && is_feasible()))) {
    return leave_phase_one();
  }
  const auto interval = std::max<std::uint64_t>(20, basis_.size() / 2);
  if (since_refactor_ >= interval) return conclude();
  compute_duals();
}

/// Nothing improves, or the inverse is stale. Only with a fresh inverse is the end believed.
void ColumnSimplex::conclude() {
  if (since_refactor_ > 0) {
    if (!refactor()) {
      start_artificial();
      return begin_phase_one();
    }
    for (Index k = 0; k < values_.size(); ++k) {
      if (values_[k] == 0.0) perturbation_[k] = std::max(perturbation_[k], 0.0);
    }
    const bool lost = (values_.array() < 0.0).any();
    if (lost || (!phase_one_ && !is_feasible())) return begin_phase_one();
    return compute_duals();
  }
  if (!phase_one_) {
    status_ = LpStatus::kOptimal;
  } else if (!is_feasible()) {
    status_ = LpStatus::kInfeasible;
  } else {
    leave_phase_one();
  }
}

LpResult ColumnSimplex::result() const {
  LpResult result;
  result.status = status_;
  result.basis = basis_;
  result.values.assign(values_.data(), values_.data() + values_.size());
  result.duals.assign(duals_.data(), duals_.data() + duals_.size());
  result.objective = own_costs_.dot(values_);
  result.infeasibility = held_by_artificials();
  if (status_ == LpStatus::kUnbounded) result.ray.assign(ray_.data(), ray_.data() + ray_.size());
  result.ray_column = ray_column_;
  result.pivots = pivots_;
  return result;
}

LpResult solve_lp(ColumnSimplex& lp, const PriceColumns& price) {
  while (lp.running()) lp.offer(price(lp.query()));
  return lp.result();
}

}  // namespace ndhull
