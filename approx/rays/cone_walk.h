// One walk to a facet: a basis of points whose cone holds a ray, or that holds on to a ridge, changed point
// by point until no point is above its plane.
//
// Facets are the vertices a of the dual polytope a.x <= 1. Along a ray r the facet that is hit maximises a.r:
//   max a.r  s.t. a.x <= 1 for all points x     or, the dual,     min sum lambda  s.t. sum lambda_i x_i = r.
// The second form has one row a dimension; its basis is a set of points whose cone holds r, and its prices
// a.x - 1 are the gauges of the points above the basis' plane. So a pivot takes in the point that is furthest
// above the plane, and gives up the one whose lambda falls to 0 first. For a random ray no lambda is 0 by
// chance: degenerate data, with many points on one plane, are degenerate in the first form only, and the walk
// cannot circle. Source: Dantzig. Linear Programming and Extensions, 1963, ch. 9 (the revised method).
//
// Across a ridge the same pivot gives up the same place always: it turns the plane about the ridge outwards
// until no point is above. That is gift wrapping (Chand, Kapur. An algorithm for convex polytopes. JACM 17,
// 1970) by Dinkelbach's iteration for the least ratio (Management Science 13, 1967).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/linear/dense_views.h"

namespace ndhull {

/// The points of a walk: rows x rank, row-major, in the frame (0 is inside).
struct FramePoints {
  const double* coordinates = nullptr;
  std::size_t rank = 0;
  double largest_length = 0.0;
  const double* row(std::uint32_t id) const { return coordinates + id * rank; }
  Eigen::Map<const Eigen::VectorXd> point(std::uint32_t id) const {
    return {row(id), static_cast<Eigen::Index>(rank)};
  }
  RowMatrix rows_of(std::span<const std::uint32_t> ids) const;
};

class ConeWalk {
 public:
  static constexpr std::size_t kAnyPlace = static_cast<std::size_t>(-1);

  /// A walk along the ray through `direction` from points inside the hull, on the axes: row `first_axis` + k
  /// of the points is `radius` times axis k, row first_axis + rank + k its opposite. Their cone holds the
  /// ray, and no inverse is to be computed.
  void start_ray(const Eigen::VectorXd& direction, std::uint32_t first_axis, double radius);
  /// A walk from a facet through `basis` over the ridge without the point at `place`.
  /// False when the basis spans no plane.
  bool start_ridge(const FramePoints& points, std::vector<std::uint32_t> basis, std::size_t place);
  /// From the facet of a walk that was started over another ridge of it, and has made no pivot yet.
  void start_ridge(const ConeWalk& begun, std::size_t place);

  /// True before the first pivot of a walk over a ridge: then not a plane but `turn_direction` asks for the
  /// first point to take in.
  bool turns() const { return turns_; }
  Eigen::VectorXd turn_direction() const { return -inverse_.row(static_cast<Eigen::Index>(place_)); }

  /// Takes in `id`, which is above the plane (or furthest along the turn direction).
  /// False when rounding leaves no point to give up.
  bool pivot(const FramePoints& points, std::uint32_t id);
  /// Computes plane, determinant and weights from the basis alone, and the inverse where it is used. False
  /// when the basis spans no plane.
  bool refresh(const FramePoints& points);

  const std::vector<std::uint32_t>& basis() const { return basis_; }
  const Eigen::VectorXd& plane() const { return plane_; }
  /// Of the points of the basis, since the last `refresh`.
  double determinant() const { return determinant_; }
  /// Ray: lambda, one for each point of the basis.
  const Eigen::VectorXd& weights() const { return weights_; }
  /// Ray: how far out it is, sum lambda = a.r; at most 1 as soon as r is proven to be in the hull.
  double gauge() const { return weights_.sum(); }
  std::size_t pivot_count() const { return pivot_count_; }

 private:
  std::size_t leaving_place(const Eigen::VectorXd& entering) const;
  bool solve(const FramePoints& points, bool with_inverse);
  bool find_inverse(const FramePoints& points);

  std::vector<std::uint32_t> basis_;
  // Row j: c_j with x_i . c_j = 1 for i = j, else 0, over the points x_i of the basis. Empty: not known yet.
  RowMatrix inverse_;
  Eigen::VectorXd plane_;
  double determinant_ = 0.0;
  Eigen::VectorXd weights_;    // lambda
  Eigen::VectorXd direction_;  // of the ray; empty for a ridge
  std::size_t place_ = kAnyPlace;
  std::size_t pivot_count_ = 0, pivots_since_refresh_ = 0;
  bool turns_ = false;
};

}  // namespace ndhull
