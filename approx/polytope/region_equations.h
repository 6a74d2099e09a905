// The planes that contain a region which has no inside, and the point that is kept on all of them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "approx/polytope/halfspace_set.h"

namespace ndhull {

/// A halfspace and its weight in a sum.
struct WeightedHalfspace {
  std::uint32_t halfspace;
  double weight;
};

/// Roundings of a plane's value at a point within which it counts as 0.
inline constexpr double kFlatRoundings = 32.0;

/// Halfspaces whose planes contain the region, with positive weights for which their unit normals sum up to
/// 0: none of them can be left.
class RegionEquations {
 public:
  explicit RegionEquations(const HalfspaceSet& halfspaces) : halfspaces_(halfspaces) {}

  bool empty() const { return weights_.empty(); }
  /// `all`: those so far among them, on unit normals.
  void set(std::vector<WeightedHalfspace> all) { weights_ = std::move(all); }

  /// The directions of the subspace are rounded: a way along them leads off the equations. Moves the point
  /// back to where they hold to the rounding of what is left of its coordinates.
  void hold(Eigen::VectorXd& point) const;

  /// Of a plane whose normal is in the span of the equations': its height above the point if these held
  /// exactly there, and the rounding of that.
  std::pair<double, double> height_at(const Eigen::VectorXd& point, std::uint32_t id) const;

  /// The combination of normals, which is 0 in the subspace, with as much of the equations added as makes it
  /// 0 in all of space, and so many multiples of their own combination that no weight is negative.
  std::vector<WeightedHalfspace> lifted(const std::vector<WeightedHalfspace>& weights) const;

 private:
  Eigen::MatrixXd normals() const;  // dimension x equations, unit length

  const HalfspaceSet& halfspaces_;
  std::vector<WeightedHalfspace> weights_;
};

/// Of a plane's value at the point.
double flat_tolerance(const HalfspaceSet& halfspaces, std::uint32_t id, const Eigen::VectorXd& point);
Eigen::VectorXd unit_normal_of(const HalfspaceSet& halfspaces, std::uint32_t id);

}  // namespace ndhull
