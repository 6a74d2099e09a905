#include "approx/geometry/boundedness.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "approx/geometry/even_normals.h"
#include "approx/geometry/subspace.h"
#include "core/error.h"
#include "core/linear/column_table.h"
#include "core/linear/dense_views.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// [ratio] Evenly spread unit normals that reach less far than this in a direction leave it open. Far above
/// the rounding of the map, far below any region one would want to look at.
constexpr double kOpen = 1e-10;

/// Unit normals, one a row, in the coordinates of the subspace.
RowMatrix unit_rows(const Eigen::Ref<const RowMatrix>& normals, const MatrixXd& directions) {
  RowMatrix rows = normals * directions;
  rows.rowwise().normalize();
  return rows;
}

ColumnTable table_of(const RowMatrix& rows) {
  const auto height = static_cast<std::size_t>(rows.cols());
  ColumnTable table(height, static_cast<std::size_t>(rows.rows()));
  for (Index row = 0; row < rows.rows(); ++row) {
    table.set(static_cast<std::size_t>(row), {rows.data() + row * rows.cols(), height}, 1.0);
  }
  return table;
}

LpResult solve(ColumnTable& table, const VectorXd& right_side) {
  ColumnSimplex lp({right_side.data(), static_cast<std::size_t>(right_side.size())});
  return solve_lp(lp, [&table](const LpQuery& query) { return table.price(query); });
}

/// The first row of so many each.
RowMatrix every(Index step, const Eigen::Ref<const RowMatrix>& rows) {
  RowMatrix part((rows.rows() + step - 1) / step, rows.cols());
  for (Index row = 0; row < part.rows(); ++row) part.row(row) = rows.row(row * step);
  return part;
}

/// A direction of the even normals, or of some of them, that they leave open.
std::optional<VectorXd> open_among(const RowMatrix& rows) {
  const Index rank = rows.cols();
  if (rows.rows() == 0) return VectorXd(VectorXd::Unit(rank, 0));
  ColumnTable table = table_of(rows);
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

/// Many evenly spread normals, of which few are to be found.
class NormalTable {
 public:
  /// Cost 1 each.
  explicit NormalTable(const RowMatrix& rows) : table_(table_of(rows)) {}
  /// Unit rows that `map` makes of the normals.
  NormalTable(const Eigen::Map<const RowMatrix>& normals, const MatrixXd& directions, const MatrixXd& map)
      : table_(static_cast<std::size_t>(map.cols()), static_cast<std::size_t>(normals.rows())) {
    for_each_block(table_.count(), kPart, [&](std::size_t begin, std::size_t end) {
      RowMatrix rows;
      for (std::size_t row = begin; row < end; row += kRowsAtATime) {
        const auto used = static_cast<Index>(std::min(kRowsAtATime, end - row));
        rows = unit_rows(normals.middleRows(static_cast<Index>(row), used), directions) * map;
        rows.rowwise().normalize();
        for (Index k = 0; k < used; ++k)
          table_.set(row + static_cast<std::size_t>(k), {&rows(k, 0), table_.height()}, 1.0);
      }
    });
  }

  std::size_t count() const { return table_.count(); }
  std::size_t rank() const { return table_.height(); }
  void set_cost(std::uint32_t row, double cost) { table_.set_cost(row, cost); }
  VectorXd row(std::uint32_t id) const {
    VectorXd values(static_cast<Index>(rank()));
    for (std::size_t k = 0; k < rank(); ++k) values[static_cast<Index>(k)] = table_.entry(id, k);
    return values;
  }
  RowMatrix rows(std::span<const std::uint32_t> ids) const {
    RowMatrix rows(static_cast<Index>(ids.size()), static_cast<Index>(rank()));
    for (std::size_t k = 0; k < ids.size(); ++k) rows.row(static_cast<Index>(k)) = row(ids[k]).transpose();
    return rows;
  }
  std::uint32_t furthest_along(const VectorXd& direction) const {
    std::vector<double> multipliers(direction.data(), direction.data() + direction.size());
    multipliers.push_back(0.0);
    return static_cast<std::uint32_t>(table_.largest_product(multipliers).column);
  }

  /// A sum of rows, each times 0 or more, that is `right_side`, at the least cost.
  LpResult balance(const VectorXd& right_side) {
    ColumnSimplex lp(as_span(right_side));
    std::size_t part = 0;
    return solve_lp(lp, [&](const LpQuery& query) { return price(query, part); });
  }

 private:
  static constexpr std::size_t kPart = 4096;  // columns
  static constexpr std::size_t kRowsAtATime = 256;

  /// The best column of the first part, from `part` on, that has one that improves (partial pricing); the
  /// best of all where none has.
  std::optional<LpColumn> price(const LpQuery& query, std::size_t& part) {
    constexpr double kRounding = 1e-9;  // of products of unit rows
    if (count() == 0) return std::nullopt;
    const std::size_t parts = (count() + kPart - 1) / kPart;
    std::vector<double> multipliers(query.duals.begin(), query.duals.end());
    multipliers.push_back(-query.cost_weight);
    ColumnTable::Best best{0, -HUGE_VAL};
    for (std::size_t k = 0; k < parts && best.product <= kRounding; ++k, part = (part + 1) % parts) {
      const ColumnTable::Best found =
          table_.largest_product(multipliers, part * kPart, std::min(count(), (part + 1) * kPart));
      if (found.product > best.product) best = found;
    }
    return table_.column(best.column);
  }

  ColumnTable table_;
};

/// Finds rows that complete a selection among evenly spread normals.
class Completion {
 public:
  Completion(NormalTable& normals, std::vector<std::uint32_t> selected)
      : normals_(normals), selected_(std::move(selected)) {}

  bool is_bounded(const std::vector<std::uint32_t>& added) const {
    return !open_among(normals_.rows(together(added)));
  }

  /// What the selected normals sum up to, weighted, has to be balanced: that takes at most rank normals, and
  /// new ones cost while selected ones do not.
  std::vector<std::uint32_t> complete(std::uint32_t weighting) {
    std::vector<std::uint32_t> added;
    std::vector<bool> is_chosen(normals_.count(), false);
    const auto choose = [&](std::uint32_t id) {
      if (is_chosen[id]) return false;
      is_chosen[id] = true;
      normals_.set_cost(id, 0.0);
      return true;
    };
    const auto add = [&](std::uint32_t id) {
      const bool is_new = choose(id);
      if (is_new) added.push_back(id);
      return is_new;
    };
    for (const std::uint32_t id : selected_) choose(id);
    std::optional<VectorXd> open;
    do {
      bool progress = false;
      for (const LpColumnId id : normals_.balance(imbalance(added, weighting)).basis) {
        if (id.valid()) progress |= add(id.value);
      }
      open = open_among(normals_.rows(together(added)));
      if (open && !progress && !add(normals_.furthest_along(*open))) break;
    } while (open);
    for (const std::uint32_t id : added) normals_.set_cost(id, 1.0);
    return open ? std::vector<std::uint32_t>() : thinned(std::move(added));
  }

 private:
  std::vector<std::uint32_t> together(const std::vector<std::uint32_t>& added) const {
    std::vector<std::uint32_t> ids = selected_;
    ids.insert(ids.end(), added.begin(), added.end());
    return ids;
  }

  VectorXd imbalance(const std::vector<std::uint32_t>& added, std::uint32_t weighting) const {
    VectorXd sum = VectorXd::Zero(static_cast<Index>(normals_.rank()));
    std::uint32_t place = 0;
    for (const std::uint32_t id : together(added)) {
      // Weights 1 first, then all kinds between 1/2 and 3/2 (fractional parts of multiples of the golden
      // ratio).
      const double turn = 0.6180339887498949 * static_cast<double>(++place * weighting);
      sum += (weighting == 0 ? 1.0 : 0.5 + turn - std::floor(turn)) * normals_.row(id);
    }
    return sum.norm() > 0.0 ? VectorXd(-sum.normalized()) : sum;
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

  NormalTable& normals_;
  std::vector<std::uint32_t> selected_;
};

/// The map that spreads the normals evenly; of many an even part tells. Nothing: all are orthogonal to
/// something.
std::optional<MatrixXd> even_map(const Eigen::Map<const RowMatrix>& normals, const MatrixXd& directions) {
  constexpr Index kEnough = 32'768;
  const auto of_each = [&](Index step) -> std::optional<MatrixXd> {
    const EvenNormals even = spread_evenly(unit_rows(every(step, normals), directions));
    if (even.orthogonal) return std::nullopt;
    return even.map;
  };
  const Index step = normals.rows() / kEnough + 1;
  std::optional<MatrixXd> map = of_each(step);
  return map || step == 1 ? map : of_each(1);
}

/// The smallest completion of several weightings. Empty: there is none.
std::vector<std::uint32_t> smallest_completion(NormalTable& normals,
                                               std::span<const std::uint32_t> selected) {
  constexpr std::uint32_t kWeightings = 8;
  Completion completion(normals, {selected.begin(), selected.end()});
  std::vector<std::uint32_t> best = completion.complete(0);
  for (std::uint32_t weighting = 1; weighting < kWeightings && best.size() != 1; ++weighting) {
    std::vector<std::uint32_t> added = completion.complete(weighting);
    if (!added.empty() && added.size() < best.size()) best = std::move(added);
  }
  return best;
}

/// Of these rows; those and `others` say what is even.
Boundedness open_direction_of(const RowMatrix& given, const RowMatrix& others, const MatrixXd& directions) {
  const RowMatrix rows = unit_rows(given, directions);
  RowMatrix all = rows;
  if (others.rows() > 0) {
    all.conservativeResize(rows.rows() + others.rows(), Eigen::NoChange);
    all.bottomRows(others.rows()) = unit_rows(others, directions);
  }
  const std::optional<VectorXd> open = open_direction(all, rows.rows());
  if (!open) return {true, {}, 0.0};
  const VectorXd direction = directions * *open;
  return {false, std::vector<double>(direction.data(), direction.data() + direction.size()),
          rows.rows() == 0 ? 0.0 : (rows * *open).maxCoeff()};
}

/// Of `count` rows, `rows_of(step)` being the first of so many each. Of many a part is asked first: what bounds
/// a region does so with more.
template <class RowsOf>
Boundedness ask_part_first(Index count, const RowsOf& rows_of, const RowMatrix& others, std::size_t dimension,
                           std::span<const double> equations) {
  constexpr Index kPart = 16'384;
  const MatrixXd directions = subspace_directions(dimension, equations);
  if (directions.cols() == 0) return {true, {}, 0.0};  // a point
  if (count > kPart) {
    Boundedness of_part = open_direction_of(rows_of((count + kPart - 1) / kPart), others, directions);
    if (of_part.bounded) return of_part;
  }
  return open_direction_of(rows_of(1), others, directions);
}

}  // namespace

Boundedness find_open_direction(std::span<const double> normals, std::size_t dimension,
                                std::span<const double> equations) {
  const Eigen::Map<const RowMatrix> all = as_rows(normals, dimension);
  return ask_part_first(
      all.rows(), [&](Index step) { return every(step, all); }, RowMatrix(0, all.cols()), dimension,
      equations);
}

Boundedness find_open_direction_of(std::span<const double> normals, std::size_t dimension,
                                   std::span<const std::uint32_t> selected,
                                   std::span<const double> equations) {
  constexpr Index kEnoughForShape = 4096;
  const Eigen::Map<const RowMatrix> all = as_rows(normals, dimension);
  const auto rows_of = [&](Index step) {
    RowMatrix rows((std::ssize(selected) + step - 1) / step, all.cols());
    for (Index row = 0; row < rows.rows(); ++row)
      rows.row(row) = all.row(selected[static_cast<std::size_t>(row * step)]);
    return rows;
  };
  return ask_part_first(std::ssize(selected), rows_of, every(all.rows() / kEnoughForShape + 1, all),
                        dimension, equations);
}

std::vector<std::uint32_t> complete_to_bounded(std::span<const double> normals, std::size_t dimension,
                                               std::span<const std::uint32_t> selected,
                                               std::span<const double> equations) {
  const MatrixXd directions = subspace_directions(dimension, equations);
  if (directions.cols() == 0) return {};
  const Eigen::Map<const RowMatrix> rows = as_rows(normals, dimension);
  if (const std::optional<MatrixXd> map = even_map(rows, directions)) {
    NormalTable table(rows, directions, *map);
    if (Completion(table, {selected.begin(), selected.end()}).is_bounded({})) return {};
    std::vector<std::uint32_t> best = smallest_completion(table, selected);
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
