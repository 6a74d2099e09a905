#include "approx/rays/cone_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/dense_solve.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;

/// Pivots after which rounding is taken out of the inverse: each adds about u times its growth.
constexpr std::size_t kPivotsToRefresh = 32;  // at least; or as many as dimensions, which costs as much
/// A point is given up only where its share of the new point is above this part of the largest one: a pivot
/// on rounding noise would make the basis flat.
constexpr double kSmallestPivot = 1e-11;

}  // namespace

RowMatrix FramePoints::rows_of(std::span<const std::uint32_t> ids) const {
  RowMatrix rows(static_cast<Index>(ids.size()), static_cast<Index>(rank));
  for (std::size_t row = 0; row < ids.size(); ++row) rows.row(static_cast<Index>(row)) = point(ids[row]);
  return rows;
}

void ConeWalk::start_ray(const Eigen::VectorXd& direction, std::uint32_t first_axis, double radius) {
  const Index rank = direction.size();
  direction_ = direction;
  place_ = kAnyPlace;
  turns_ = false;
  pivot_count_ = pivots_since_refresh_ = 0;
  basis_.resize(static_cast<std::size_t>(rank));
  inverse_ = RowMatrix::Zero(rank, rank);
  plane_.resize(rank);
  weights_.resize(rank);
  for (Index k = 0; k < rank; ++k) {
    const bool is_negative = direction[k] < 0.0;
    basis_[static_cast<std::size_t>(k)] =
        first_axis + static_cast<std::uint32_t>(k + (is_negative ? rank : 0));
    plane_[k] = inverse_(k, k) = (is_negative ? -1.0 : 1.0) / radius;
    weights_[k] = std::abs(direction[k]) / radius;
  }
}

bool ConeWalk::start_ridge(const FramePoints& points, std::vector<std::uint32_t> basis, std::size_t place) {
  basis_ = std::move(basis);
  direction_.resize(0);
  place_ = place;
  turns_ = true;
  pivot_count_ = 0;
  return solve(points, true);
}

void ConeWalk::start_ridge(const ConeWalk& begun, std::size_t place) {
  *this = begun;
  place_ = place;
}

bool ConeWalk::refresh(const FramePoints& points) {
  // Most walks over a ridge end with this plane: the inverse waits for a pivot.
  return solve(points, direction_.size() > 0);
}

bool ConeWalk::solve(const FramePoints& points, bool with_inverse) {
  const auto rank = static_cast<Index>(points.rank);
  const RowMatrix rows = points.rows_of(basis_);
  const SquareFactors factors(rows);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rank);
  plane_ = factors.solve(ones);
  plane_ += factors.solve(ones - rows * plane_);  // one step of refinement
  determinant_ = factors.determinant();
  pivots_since_refresh_ = 0;
  inverse_.resize(0, 0);
  if (with_inverse) inverse_ = factors.inverse().transpose();
  if (direction_.size() > 0) {
    // rows^T weights = direction
    weights_ = inverse_ * direction_;
    weights_ += inverse_ * (direction_ - rows.transpose() * weights_);
  } else {
    weights_ = Eigen::VectorXd::Zero(rank);
  }
  return plane_.allFinite() && inverse_.allFinite() && weights_.allFinite();
}

bool ConeWalk::find_inverse(const FramePoints& points) {
  inverse_ = SquareFactors(points.rows_of(basis_)).inverse().transpose();
  return inverse_.allFinite();
}

std::size_t ConeWalk::leaving_place(const Eigen::VectorXd& entering) const {
  if (place_ != kAnyPlace) return place_;
  const double smallest = kSmallestPivot * entering.cwiseAbs().maxCoeff();
  std::size_t best = kAnyPlace;
  double best_ratio = HUGE_VAL;
  for (Index k = 0; k < entering.size(); ++k) {
    if (!(entering[k] > smallest)) continue;
    const double ratio = std::max(weights_[k], 0.0) / entering[k];
    if (ratio >= best_ratio) continue;
    best_ratio = ratio;
    best = static_cast<std::size_t>(k);
  }
  return best;
}

bool ConeWalk::pivot(const FramePoints& points, std::uint32_t id) {
  if (inverse_.size() == 0 && !find_inverse(points)) return false;
  const auto point = points.point(id);
  const Eigen::VectorXd entering = inverse_ * point;
  const std::size_t place = leaving_place(entering);
  if (place == kAnyPlace) return false;
  const auto at = static_cast<Index>(place);
  const double share = entering[at];
  if (share == 0.0) return false;
  inverse_.row(at) /= share;
  const Eigen::RowVectorXd pivot_row = inverse_.row(at);
  const double weight = weights_[at] / share;
  for (Index k = 0; k < entering.size(); ++k) {
    if (k == at) continue;
    inverse_.row(k) -= entering[k] * pivot_row;
    weights_[k] -= entering[k] * weight;
  }
  weights_[at] = weight;
  plane_ -= (plane_.dot(point) - 1.0) * pivot_row.transpose();
  basis_[place] = id;
  turns_ = false;
  ++pivot_count_;
  if (++pivots_since_refresh_ >= std::max(kPivotsToRefresh, points.rank)) return refresh(points);
  return plane_.allFinite();
}

}  // namespace ndhull
