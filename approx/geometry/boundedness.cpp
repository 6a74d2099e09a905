#include "approx/geometry/boundedness.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "approx/geometry/even_normals.h"
#include "approx/geometry/subspace.h"
#include "core/column_table.h"
#include "core/error.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// [ratio] Evenly spread unit normals that reach less far than this in a direction leave it open. Far above
/// the rounding of the map, far below any region one would want to look at.
constexpr double kOpen = 1e-10;
/// Weightings of the selected normals that completions are tried with.
constexpr std::uint32_t kWeightings = 8;

/// Unit normals, one a row, in the coordinates of the subspace.
RowMatrix unit_rows(std::span<const double> normals, std::size_t dimension, const MatrixXd& directions) {
  const auto columns = static_cast<Index>(dimension);
  const Eigen::Map<const RowMatrix> given(normals.data(), static_cast<Index>(normals.size() / dimension),
                                          columns);
  RowMatrix rows = given * directions;
  rows.rowwise().normalize();
  return rows;
}

ColumnTable table_of(const RowMatrix& rows, double cost) {
  const auto height = static_cast<std::size_t>(rows.cols());
  ColumnTable table(height, static_cast<std::size_t>(rows.rows()));
  for (Index row = 0; row < rows.rows(); ++row) {
    table.set(static_cast<std::size_t>(row), {rows.data() + row * rows.cols(), height}, cost);
  }
  return table;
}

LpResult solve(ColumnTable& table, const VectorXd& right_side) {
  ColumnSimplex lp({right_side.data(), static_cast<std::size_t>(right_side.size())});
  return solve_lp(lp, [&table](const LpQuery& query) { return table.price(query); });
}

/// A direction of the even normals, or of some of them, that they leave open.
std::optional<VectorXd> open_among(const RowMatrix& rows) {
  const Index rank = rows.cols();
  if (rows.rows() == 0) return VectorXd(VectorXd::Unit(rank, 0));
  ColumnTable table = table_of(rows, 1.0);
  // -(1, .., 1) and the unit vectors span the space positively.
  for (Index k = 0; k <= rank; ++k) {
    const VectorXd direction =
        k < rank ? VectorXd(VectorXd::Unit(rank, k))
                 : VectorXd(VectorXd::Constant(rank, -1.0 / std::sqrt(static_cast<double>(rank))));
    const LpResult result = solve(table, direction);
    const bool reached = result.status == LpStatus::kOptimal && result.objective * kOpen < 1.0;
    if (reached) continue;
    return Eigen::Map<const VectorXd>(result.duals.data(), rank).normalized();
  }
  return std::nullopt;
}

/// Of the first `count` rows; all of them say what is even.
std::optional<VectorXd> open_direction(const RowMatrix& rows, Index count) {
  const EvenNormals even = spread_evenly(rows);
  if (even.orthogonal) return even.orthogonal;
  std::optional<VectorXd> direction = open_among(even.rows.topRows(count));
  if (direction) direction = (even.map * *direction).normalized();
  return direction;
}

RowMatrix rows_of(const RowMatrix& all, const std::vector<std::uint32_t>& ids) {
  RowMatrix rows(static_cast<Index>(ids.size()), all.cols());
  for (std::size_t k = 0; k < ids.size(); ++k) rows.row(static_cast<Index>(k)) = all.row(ids[k]);
  return rows;
}

/// Finds rows that complete a selection among evenly spread normals.
class Completion {
 public:
  Completion(const RowMatrix& rows, std::span<const std::uint32_t> selected)
      : rows_(rows), selected_(selected.begin(), selected.end()) {}

  bool is_bounded(const std::vector<std::uint32_t>& added) const {
    std::vector<std::uint32_t> ids = selected_;
    ids.insert(ids.end(), added.begin(), added.end());
    return !open_among(rows_of(rows_, ids));
  }

  /// What the selected normals sum up to, weighted, has to be balanced: that takes at most rank normals, and
  /// new ones cost while selected ones do not.
  std::vector<std::uint32_t> complete(std::uint32_t weighting) {
    std::vector<std::uint32_t> added;
    std::vector<bool> is_chosen(static_cast<std::size_t>(rows_.rows()), false);
    for (const std::uint32_t id : selected_) is_chosen[id] = true;
    const auto choose = [&](std::uint32_t id) {
      if (is_chosen[id]) return false;
      is_chosen[id] = true;
      added.push_back(id);
      return true;
    };
    while (true) {
      bool progress = false;
      for (const LpColumnId id : balance(added, is_chosen, weighting).basis) {
        if (id.valid()) progress |= choose(id.value);
      }
      std::vector<std::uint32_t> ids = selected_;
      ids.insert(ids.end(), added.begin(), added.end());
      const std::optional<VectorXd> open = open_among(rows_of(rows_, ids));
      if (!open) return thinned(added);
      if (progress) continue;
      Index furthest = 0;
      (rows_ * *open).maxCoeff(&furthest);
      if (!choose(static_cast<std::uint32_t>(furthest))) return {};
    }
  }

 private:
  LpResult balance(const std::vector<std::uint32_t>& added, const std::vector<bool>& is_chosen,
                   std::uint32_t weighting) {
    ColumnTable table = table_of(rows_, 1.0);
    for (std::size_t row = 0; row < is_chosen.size(); ++row) {
      if (is_chosen[row]) table.set(row, {&rows_(static_cast<Index>(row), 0), table.height()}, 0.0);
    }
    VectorXd sum = VectorXd::Zero(rows_.cols());
    std::uint32_t place = 0;
    const auto add = [&](std::uint32_t id) {
      // Weights 1 first, then all kinds between 1/2 and 3/2 (fractional parts of multiples of the golden
      // ratio).
      const double turn = 0.6180339887498949 * static_cast<double>(++place * weighting);
      sum += (weighting == 0 ? 1.0 : 0.5 + turn - std::floor(turn)) * rows_.row(id).transpose();
    };
    for (const std::uint32_t id : selected_) add(id);
    for (const std::uint32_t id : added) add(id);
    return solve(table, sum.norm() > 0.0 ? VectorXd(-sum.normalized()) : sum);
  }

  std::vector<std::uint32_t> thinned(std::vector<std::uint32_t> added) const {
    for (std::size_t k = 0; k < added.size();) {
      std::vector<std::uint32_t> fewer = added;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      if (is_bounded(fewer)) {
        added = std::move(fewer);
      } else {
        ++k;
      }
    }
    std::sort(added.begin(), added.end());
    return added;
  }

  const RowMatrix& rows_;
  std::vector<std::uint32_t> selected_;
};

}  // namespace

Boundedness find_open_direction(std::span<const double> normals, std::size_t dimension,
                                std::span<const double> equations, std::span<const double> others) {
  const MatrixXd directions = subspace_directions(dimension, equations);
  if (directions.cols() == 0) return {true, {}, 0.0};  // a point
  const RowMatrix rows = unit_rows(normals, dimension, directions);
  RowMatrix all = rows;
  if (!others.empty()) {
    const RowMatrix further = unit_rows(others, dimension, directions);
    all.conservativeResize(rows.rows() + further.rows(), Eigen::NoChange);
    all.bottomRows(further.rows()) = further;
  }
  const std::optional<VectorXd> open = open_direction(all, rows.rows());
  if (!open) return {true, {}, 0.0};
  const VectorXd direction = directions * *open;
  return {false, std::vector<double>(direction.data(), direction.data() + direction.size()),
          rows.rows() == 0 ? 0.0 : (rows * *open).maxCoeff()};
}

std::vector<std::uint32_t> complete_to_bounded(std::span<const double> normals, std::size_t dimension,
                                               std::span<const std::uint32_t> selected,
                                               std::span<const double> equations) {
  const MatrixXd directions = subspace_directions(dimension, equations);
  if (directions.cols() == 0) return {};
  const EvenNormals even = spread_evenly(unit_rows(normals, dimension, directions));
  if (!even.orthogonal) {
    Completion completion(even.rows, selected);
    if (completion.is_bounded({})) return {};
    std::vector<std::uint32_t> best;
    for (std::uint32_t weighting = 0; weighting < kWeightings; ++weighting) {
      std::vector<std::uint32_t> added = completion.complete(weighting);
      if (!added.empty() && (best.empty() || added.size() < best.size())) best = std::move(added);
    }
    if (!best.empty()) return best;
  }
  std::vector<bool> is_selected(normals.size() / dimension, false);
  for (const std::uint32_t id : selected) is_selected[id] = true;
  std::vector<std::uint32_t> rest;
  for (std::uint32_t id = 0; id < is_selected.size(); ++id) {
    if (!is_selected[id]) rest.push_back(id);
  }
  return rest;
}

}  // namespace ndhull
