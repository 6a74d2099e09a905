#include "approx/polytope/halfspace_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "approx/geometry/even_normals.h"
#include "core/error.h"
#include "core/linear/column_table.h"
#include "core/linear/dense_solve.h"
#include "core/linear/dense_views.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// [ratio] A unit normal with less than this in the subspace is orthogonal to it: some thousand roundings.
constexpr double kParallel = 1e-12;
/// Programs that are solved one after the other for a ball, each about the last one's centre.
constexpr int kPasses = 3;
/// [ratio] Weights of a combination, which sum to 1, that are more than rounding.
constexpr double kWeightRoundoff = 1e-10;

/// Planes in coordinates w of the subspace: x + basis w is below a plane when normal . w <= height.
struct LocalPlanes {
  MatrixXd basis;     // dimension x rank
  RowMatrix normals;  // unit length
  VectorXd heights;
  std::vector<std::uint32_t> ids;
  std::vector<double> lengths;  // of the halfspace's unit normal in these coordinates
};

Error too_parallel_planes() {
  return Error(ErrorCode::kBadHalfspace,
               "found planes that are parallel but for rounding, so that doubles do not tell what they "
               "enclose, expected equal ones or others; remove copies, scale the coordinates to similar "
               "extents, or name an interior point");
}

class RegionFinder {
 public:
  explicit RegionFinder(const HalfspaceSet& halfspaces) : halfspaces_(halfspaces), equations_(halfspaces) {
    const auto dimension = static_cast<Index>(halfspaces.dimension());
    point_ = VectorXd::Zero(dimension);
    region_.directions = MatrixXd::Identity(dimension, dimension);
    for (std::uint32_t id = 0; id < halfspaces.count(); ++id) region_.planes.push_back(id);
  }

  HalfspaceRegion run() {
    while (true) {
      LocalPlanes planes = local_planes();
      if (region_.empty) return std::move(region_);
      region_.planes = planes.ids;
      if (region_.directions.cols() == 0 || planes.ids.empty()) {
        region_.radius = planes.ids.empty() && region_.directions.cols() > 0
                             ? std::numeric_limits<double>::infinity()
                             : 0.0;
        break;
      }
      if (find_ball(planes) || find_ball_evenly(planes)) break;
      settle();
      if (region_.empty) return std::move(region_);
    }
    region_.point.assign(point_.data(), point_.data() + point_.size());
    std::sort(region_.equalities.begin(), region_.equalities.end());
    return std::move(region_);
  }

 private:
  double tolerance(std::uint32_t id) const { return flat_tolerance(halfspaces_, id, point_); }

  VectorXd unit_normal(std::uint32_t id) const { return unit_normal_of(halfspaces_, id); }

  /// Planes that are parallel to the subspace bound nothing in it: they hold everywhere, or nowhere.
  LocalPlanes local_planes() {
    const MatrixXd& directions = region_.directions;
    LocalPlanes planes;
    RowMatrix normals(static_cast<Index>(region_.planes.size()), directions.cols());
    VectorXd heights(static_cast<Index>(region_.planes.size()));
    Index kept = 0;
    for (const std::uint32_t id : region_.planes) {
      const VectorXd inside = directions.transpose() * unit_normal(id);
      const double height = -halfspaces_.distance(id, as_span(point_)), length = inside.norm();
      if (length > kParallel) {
        normals.row(kept) = inside.transpose() / length;
        heights[kept++] = height / length;
        planes.ids.push_back(id);
        planes.lengths.push_back(length);
        continue;
      }
      const auto [at_equations, rounding] = equations_.height_at(point_, id);
      if (at_equations < -rounding) {
        prove_empty({{id, 1.0}});
        return planes;
      }
      if (at_equations <= rounding) region_.equalities.push_back(id);
    }
    planes.basis = directions;
    planes.normals = normals.topRows(kept);
    planes.heights = heights.head(kept);
    return planes;
  }

  /// Moves the point to the centre of a largest ball. True when there is a ball; otherwise `tight_`,
  /// `objective_` and `roundoff_` are what `settle` decides by.
  bool find_ball(LocalPlanes& planes) {
    const Index rank = planes.normals.cols();
    VectorXd right_side = VectorXd::Zero(rank + 1);
    right_side[rank] = 1.0;  // the weights of a combination sum to 1
    LpResult ball;
    // Then about the centre found: what is left of the coordinates then cancels no digits.
    for (int pass = 0; pass < kPasses; ++pass) {
      ColumnTable table = table_of(planes);
      ColumnSimplex lp(as_span(right_side));
      if (pass > 0) warm_start(lp, table, ball);
      ball = solve_lp(lp, [&table](const LpQuery& query) { return table.price(query); });
      const bool is_open = ball.status == LpStatus::kInfeasible;
      const VectorXd duals = as_vector(ball.duals).head(rank), before = point_;
      const double radius = planes.heights.minCoeff();
      point_ += planes.basis * (is_open ? outwards(planes, duals) : duals);
      equations_.hold(point_);
      set_heights(planes);
      if (!is_open && pass > 0 && planes.heights.minCoeff() < radius) {  // rounding had led away
        point_ = before;
        set_heights(planes);
      }
      if (!is_open) continue;
      region_.radius = std::numeric_limits<double>::infinity();
      return planes.heights.minCoeff() > 0.0;
    }
    find_tight(planes, ball);
    region_.radius = planes.heights.minCoeff();
    return region_.radius > roundoff_;
  }

  /// The planes that hold the ball, with weights for which their normals sum up to 0: the program's are known
  /// to its own rounding, that of planes as far away as those of its basis without weight. Heights above the
  /// present point, weighted so, have the rounding of these planes alone.
  void find_tight(const LocalPlanes& planes, const LpResult& ball) {
    constexpr double kSumRoundoff = 1e-13;
    std::vector<std::size_t> rows;
    std::vector<double> weights;
    for (const double least : {kWeightRoundoff, 0.0}) {
      rows.clear();
      weights.clear();
      for (std::size_t k = 0; k < ball.basis.size(); ++k) {
        if (!ball.basis[k].valid() || ball.values[k] <= least) continue;
        rows.push_back(ball.basis[k].value);
        weights.push_back(ball.values[k]);
      }
      const VectorXd exact = weights_without_sum(planes, rows);
      if (exact.size() == 0 || exact.minCoeff() <= 0.0) continue;
      VectorXd sum = VectorXd::Zero(planes.normals.cols());
      for (std::size_t k = 0; k < rows.size(); ++k)
        sum += exact[static_cast<Index>(k)] * planes.normals.row(static_cast<Index>(rows[k])).transpose();
      if (sum.norm() > kSumRoundoff) continue;
      weights.assign(exact.data(), exact.data() + exact.size());
      break;
    }
    tight_.clear();
    objective_ = roundoff_ = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double length = planes.lengths[rows[k]];
      objective_ += weights[k] * planes.heights[static_cast<Index>(rows[k])];
      roundoff_ = std::max(roundoff_, tolerance(planes.ids[rows[k]]) / length);
      if (weights[k] > kWeightRoundoff) tight_.push_back({planes.ids[rows[k]], weights[k] / length});
    }
  }

  /// Of these planes: with a sum of 1, so that the normals sum up to as little as can be.
  static VectorXd weights_without_sum(const LocalPlanes& planes, const std::vector<std::size_t>& rows) {
    if (rows.empty()) return {};
    const Index rank = planes.normals.cols();
    MatrixXd columns = MatrixXd::Ones(rank + 1, static_cast<Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k)
      columns.col(static_cast<Index>(k)).head(rank) =
          planes.normals.row(static_cast<Index>(rows[k])).transpose();
    return solve_least_squares(columns, VectorXd::Unit(rank + 1, rank));
  }

  /// The same where it is the planes' normals that are thin: about a lens of thickness 1e-13 all are
  /// parallel but for their last digits.
  bool find_ball_evenly(const LocalPlanes& planes) {
    const EvenNormals even = spread_evenly(planes.normals);
    if (even.orthogonal) return false;
    LocalPlanes spread = planes;
    spread.basis = planes.basis * even.map;
    spread.normals = even.rows;
    std::vector<double> stretch;
    for (std::size_t k = 0; k < planes.ids.size(); ++k) {
      stretch.push_back((planes.normals.row(static_cast<Index>(k)) * even.map).norm());
      spread.lengths[k] *= stretch.back();
    }
    set_heights(spread);
    const bool is_found = find_ball(spread);
    if (!is_found || std::isinf(region_.radius)) return is_found;
    region_.radius = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < stretch.size(); ++k)
      region_.radius = std::min(region_.radius, spread.heights[static_cast<Index>(k)] * stretch[k]);
    return true;
  }

  /// There is no ball: the region is empty, or lies in a subspace.
  void settle() {
    // No plane holds the ball: the way out that was found leads through planes, to rounding.
    if (tight_.empty()) throw too_long_a_region();
    if (objective_ > roundoff_) throw too_parallel_planes();  // a ball, but no point of which it is the ball
    if (objective_ < -roundoff_) {
      prove_empty(tight_);
    } else {
      flatten(tight_);
    }
  }

  void set_heights(LocalPlanes& planes) const {
    planes.heights.resize(planes.normals.rows());
    for (std::size_t k = 0; k < planes.ids.size(); ++k) {
      planes.heights[static_cast<Index>(k)] =
          -halfspaces_.distance(planes.ids[k], as_span(point_)) / planes.lengths[k];
    }
  }

  static ColumnTable table_of(const LocalPlanes& planes) {
    const Index rank = planes.normals.cols();
    ColumnTable table(static_cast<std::size_t>(rank) + 1, planes.ids.size());
    VectorXd column = VectorXd::Ones(rank + 1);
    for (Index row = 0; row < planes.normals.rows(); ++row) {
      column.head(rank) = planes.normals.row(row).transpose();
      table.set(static_cast<std::size_t>(row), as_span(column), planes.heights[row]);
    }
    return table;
  }

  static void warm_start(ColumnSimplex& lp, ColumnTable& table, const LpResult& last) {
    std::vector<std::vector<double>> entries;
    std::vector<LpColumn> columns;
    for (const LpColumnId id : last.basis) {
      if (!id.valid()) return;
      const LpColumn column = table.column(id.value);
      entries.emplace_back(column.entries.begin(), column.entries.end());
      columns.push_back({column.id, column.cost, {}});
    }
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k].entries = entries[k];
    lp.start_from(columns);
  }

  /// The way inside along a direction that leads away from all planes.
  static VectorXd outwards(const LocalPlanes& planes, const VectorXd& direction) {
    const VectorXd slopes = planes.normals * direction;
    double step = 0.0, size = 0.0;
    for (Index row = 0; row < slopes.size(); ++row) {
      if (slopes[row] < 0.0) step = std::max(step, planes.heights[row] / slopes[row]);
      size = std::max(size, std::abs(planes.heights[row]));
    }
    step += (size > 0.0 ? size : 1.0) / std::max(-slopes.maxCoeff(), 1e-3 * direction.norm());
    return direction * step;
  }

  void prove_empty(const std::vector<WeightedHalfspace>& weights) {
    region_.empty = true;
    region_.proof = equations_.lifted(weights);
    double total = 0.0;
    for (const WeightedHalfspace& term : region_.proof) total += term.weight;
    for (WeightedHalfspace& term : region_.proof) {
      term.weight /= total * halfspaces_.length(term.halfspace);  // from unit normals to those given
    }
    std::sort(region_.proof.begin(), region_.proof.end(),
              [](const auto& a, const auto& b) { return a.halfspace < b.halfspace; });
    // The sum of normals is 0 to rounding only: it proves that nothing is as near as gap / |sum|. Where the
    // region is 10^12 times as long as thick, normals count as parallel that are not, and that is not far.
    double gap = 0.0, reach = point_.norm();
    VectorXd sum = VectorXd::Zero(point_.size());
    for (const WeightedHalfspace& term : region_.proof) {
      gap += term.weight * halfspaces_.offset(term.halfspace);
      sum += term.weight * as_vector(halfspaces_.normal(term.halfspace));
      reach =
          std::max(reach, std::abs(halfspaces_.offset(term.halfspace)) / halfspaces_.length(term.halfspace));
    }
    if (!(gap > sum.norm() * reach)) throw too_parallel_planes();
  }

  /// The planes with positive weights contain the region: on to what they have in common.
  void flatten(const std::vector<WeightedHalfspace>& tight) {
    const Index count = static_cast<Index>(tight.size()), rank = region_.directions.cols();
    MatrixXd normals(rank, count);
    VectorXd heights(count);
    for (Index k = 0; k < count; ++k) {
      const std::uint32_t id = tight[static_cast<std::size_t>(k)].halfspace;
      const VectorXd inside = region_.directions.transpose() * unit_normal(id);
      normals.col(k) = inside.normalized();
      heights[k] = -halfspaces_.distance(id, as_span(point_)) / inside.norm();
    }
    point_ += region_.directions * solve_least_squares(normals.transpose(), heights);
    const PivotedFactors factors(normals, kParallel);
    region_.directions = region_.directions * factors.q().rightCols(rank - factors.rank());
    std::vector<WeightedHalfspace> all = equations_.lifted(tight);
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.halfspace < b.halfspace; });
    equations_.set(std::move(all));
    equations_.hold(point_);
    for (const WeightedHalfspace& term : tight) {
      region_.equalities.push_back(term.halfspace);
      std::erase(region_.planes, term.halfspace);
    }
  }

  const HalfspaceSet& halfspaces_;
  RegionEquations equations_;
  HalfspaceRegion region_;
  VectorXd point_;
  std::vector<WeightedHalfspace> tight_;  // planes that hold the last ball, weights on unit normals
  double objective_ = 0.0;                // radius of the last ball, negative when planes miss each other
  double roundoff_ = 0.0;                 // of that radius
};

}  // namespace

Error too_long_a_region() {
  return Error(ErrorCode::kBadHalfspace,
               "found a region so long that doubles do not tell it from one without end, expected one that "
               "is not; scale the coordinates");
}

HalfspaceRegion find_region(const HalfspaceSet& halfspaces,
                            const std::optional<std::vector<double>>& interior_point) {
  if (!interior_point) return RegionFinder(halfspaces).run();
  for (const double coordinate : *interior_point) {
    if (!std::isfinite(coordinate))
      throw Error(ErrorCode::kNotFinite,
                  "interior point: found NaN or infinity, expected finite numbers; give another, or none");
  }
  HalfspaceRegion region;
  region.point = *interior_point;
  const auto dimension = static_cast<Index>(halfspaces.dimension());
  region.directions = MatrixXd::Identity(dimension, dimension);
  double furthest = -std::numeric_limits<double>::infinity();
  std::uint32_t worst = 0;
  for (std::uint32_t id = 0; id < halfspaces.count(); ++id) {
    const double distance = halfspaces.distance(id, *interior_point);
    if (distance > furthest) {
      furthest = distance;
      worst = id;
    }
    region.planes.push_back(id);
  }
  if (furthest >= 0.0) {
    std::ostringstream message;
    message.precision(3);
    message << "halfspace " << worst << " (counted from 0): found the interior point ";
    furthest > 0.0 ? message << furthest << " above" : message << "on";
    message << " its plane, expected it below; give another point, or none";
    throw Error(ErrorCode::kBadHalfspace, message.str());
  }
  return region;
}

}  // namespace ndhull
