#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "approx/geometry/even_normals.h"
#include "approx/polytope/halfspace_region.h"
#include "core/linear/column_table.h"
#include "core/linear/dense_views.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Support values of planes about the origin, each program started from the last one's basis.
class SupportPrograms {
 public:
  SupportPrograms(const RowMatrix& normals, const VectorXd& heights)
      : table_(static_cast<std::size_t>(normals.cols()), static_cast<std::size_t>(normals.rows())) {
    for (Index row = 0; row < normals.rows(); ++row) {
      table_.set(static_cast<std::size_t>(row),
                 {normals.data() + row * normals.cols(), static_cast<std::size_t>(normals.cols())},
                 heights[row]);
    }
  }

  /// The point furthest along `direction`, or the direction in which there is none.
  bool furthest(const VectorXd& direction, VectorXd& answer) {
    ColumnSimplex lp(as_span(direction));
    if (!basis_.empty()) lp.start_from(basis_);
    const LpResult result = solve_lp(lp, [this](const LpQuery& query) { return table_.price(query); });
    answer = as_vector(result.duals);
    if (result.status == LpStatus::kInfeasible) return false;
    remember(result);
    return true;
  }

 private:
  void remember(const LpResult& result) {
    basis_.clear();
    entries_.clear();
    for (const LpColumnId id : result.basis) {
      if (!id.valid()) return basis_.clear();
      const LpColumn column = table_.column(id.value);
      entries_.emplace_back(column.entries.begin(), column.entries.end());
      basis_.push_back({column.id, column.cost, {}});
    }
    for (std::size_t k = 0; k < basis_.size(); ++k) basis_[k].entries = entries_[k];
  }

  ColumnTable table_;
  std::vector<LpColumn> basis_;
  std::vector<std::vector<double>> entries_;
};

/// The mean of the points that are furthest along rank directions and their opposites, which span all that the
/// region does. Something: along it there is no furthest.
std::optional<VectorXd> find_middle(SupportPrograms& programs, Index rank, VectorXd& middle) {
  MatrixXd span(rank, 0);
  VectorXd first;
  middle = VectorXd::Zero(rank);
  for (Index step = 0; step < rank; ++step) {
    // The unit vector with most outside the span so far, less its part inside.
    const MatrixXd outside = MatrixXd::Identity(rank, rank) - span * span.transpose();
    Index longest = 0;
    outside.colwise().norm().maxCoeff(&longest);
    VectorXd direction = outside.col(longest).normalized();
    VectorXd ends[2];
    for (VectorXd& end : ends) {
      if (!programs.furthest(direction, end)) return end;
      middle += end;
      direction = -direction;
    }
    if (step == 0) first = ends[0];
    VectorXd edge = std::abs(direction.dot(ends[0] - first)) > std::abs(direction.dot(ends[1] - first))
                        ? VectorXd(ends[0] - first)
                        : VectorXd(ends[1] - first);
    for (int pass = 0; pass < 2; ++pass) edge -= span * (span.transpose() * edge);
    span.conservativeResize(rank, step + 1);
    span.col(step) = edge.normalized();
  }
  middle /= static_cast<double>(2 * rank);
  return std::nullopt;
}

}  // namespace

RegionCentre centre_region(const HalfspaceSet& halfspaces, const HalfspaceRegion& region) {
  RegionCentre centre;
  const Index rank = region.directions.cols();
  if (rank == 0) {
    centre.point = region.point;
    return centre;
  }
  const auto open = [&](const VectorXd& local) {
    const VectorXd direction = (region.directions * local).normalized();
    centre.direction.assign(direction.data(), direction.data() + direction.size());
    return centre;
  };
  if (region.planes.empty()) return open(VectorXd::Unit(rank, 0));
  RowMatrix normals(static_cast<Index>(region.planes.size()), rank);
  VectorXd heights(normals.rows());
  for (Index row = 0; row < normals.rows(); ++row) {
    const std::uint32_t id = region.planes[static_cast<std::size_t>(row)];
    const VectorXd inside =
        region.directions.transpose() * as_vector(halfspaces.normal(id)) / halfspaces.length(id);
    normals.row(row) = inside.normalized().transpose();
    heights[row] = -halfspaces.distance(id, region.point) / inside.norm();
  }
  const EvenNormals even = spread_evenly(normals);
  if (even.orthogonal) return open(*even.orthogonal);
  // n.(map w) = (n' . w) |n map|
  for (Index row = 0; row < heights.size(); ++row) heights[row] /= (normals.row(row) * even.map).norm();
  SupportPrograms programs(even.rows, heights);
  VectorXd middle;
  if (const std::optional<VectorXd> ray = find_middle(programs, rank, middle)) return open(even.map * *ray);
  const VectorXd point = as_vector(region.point) + region.directions * (even.map * middle);
  centre.point.assign(point.data(), point.data() + point.size());
  return centre;
}

}  // namespace ndhull
