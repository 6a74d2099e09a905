// Planes that a region lies in, as equations with roundings of their own.
#include "approx/polytope/region_equations.h"

#include <algorithm>
#include <cmath>

#include "core/linear/dense_solve.h"
#include "core/linear/dense_views.h"

namespace ndhull {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double flat_tolerance(const HalfspaceSet& halfspaces, std::uint32_t id, const VectorXd& point) {
  return kFlatRoundings * halfspaces.roundoff(id, as_span(point));
}

VectorXd unit_normal_of(const HalfspaceSet& halfspaces, std::uint32_t id) {
  return as_vector(halfspaces.normal(id)) / halfspaces.length(id);
}

MatrixXd RegionEquations::normals() const {
  MatrixXd normals(static_cast<Index>(halfspaces_.dimension()), static_cast<Index>(weights_.size()));
  for (std::size_t k = 0; k < weights_.size(); ++k)
    normals.col(static_cast<Index>(k)) = unit_normal_of(halfspaces_, weights_[k].halfspace);
  return normals;
}

void RegionEquations::hold(VectorXd& point) const {
  constexpr int kPasses = 3;  // what is left of the coordinates cancels fewer digits each time
  if (empty()) return;
  const MatrixXd rows = normals().transpose();
  VectorXd heights(rows.rows());
  for (int pass = 0; pass < kPasses; ++pass) {
    for (std::size_t k = 0; k < weights_.size(); ++k)
      heights[static_cast<Index>(k)] = -halfspaces_.distance(weights_[k].halfspace, as_span(point));
    point += solve_least_squares(rows, heights);
  }
}

std::pair<double, double> RegionEquations::height_at(const VectorXd& point, std::uint32_t id) const {
  double height = -halfspaces_.distance(id, as_span(point));
  double rounding = flat_tolerance(halfspaces_, id, point);
  if (empty()) return {height, rounding};
  const VectorXd shares = solve_least_squares(normals(), unit_normal_of(halfspaces_, id));
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    const std::uint32_t equation = weights_[k].halfspace;
    const double share = shares[static_cast<Index>(k)];
    height += share * halfspaces_.distance(equation, as_span(point));
    rounding += std::abs(share) * flat_tolerance(halfspaces_, equation, point);
  }
  return {height, rounding};
}

std::vector<WeightedHalfspace> RegionEquations::lifted(const std::vector<WeightedHalfspace>& weights) const {
  if (empty()) return weights;
  VectorXd sum = VectorXd::Zero(static_cast<Index>(halfspaces_.dimension()));
  for (const WeightedHalfspace& term : weights)
    sum += term.weight * unit_normal_of(halfspaces_, term.halfspace);
  const VectorXd share = solve_least_squares(normals(), sum);
  double multiple = 0.0;
  for (std::size_t k = 0; k < weights_.size(); ++k)
    multiple = std::max(multiple, share[static_cast<Index>(k)] / weights_[k].weight);
  std::vector<WeightedHalfspace> all = weights;
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    // Twice the multiple, so that the weights of equations stay positive.
    const double weight = 2.0 * multiple * weights_[k].weight - share[static_cast<Index>(k)];
    if (weight > 0.0) all.push_back({weights_[k].halfspace, weight});
  }
  return all;
}

}  // namespace ndhull
