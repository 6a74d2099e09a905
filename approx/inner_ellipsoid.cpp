#include "approx/inner_ellipsoid.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/dense_views.h"
#include "core/dimension_switch.h"

namespace ndhull {
namespace {

using Matrix = RowMatrix;
using Vector = Eigen::VectorXd;

constexpr double kUnitRoundoff = 0x1p-53;
/// What is taken off for all that is not counted one by one.
constexpr double kMargin = 1e-3;

}  // namespace

InnerEllipsoid::InnerEllipsoid(const Frame& frame, const double* points, std::size_t count, double reach)
    : rank_(frame.rank),
      dimension_(frame.dimension),
      is_diagonal_(frame.is_diagonal),
      centre_(frame.centre),
      map_(frame.map),
      rounding_(static_cast<double>(frame.dimension + 4) * kUnitRoundoff * reach) {
  const auto rank = static_cast<Eigen::Index>(rank_);
  const Eigen::Map<const Matrix> sample(points, static_cast<Eigen::Index>(count), rank);
  const Vector mean = sample.colwise().mean().transpose();
  const Matrix centred = sample.rowwise() - mean.transpose();
  const Eigen::LLT<Matrix> covariance(centred.transpose() * centred / static_cast<double>(count));
  const Matrix factor = covariance.matrixL();
  mean_.assign(mean.data(), mean.data() + rank);
  if (covariance.info() != Eigen::Success || !factor.allFinite() || factor.diagonal().minCoeff() <= 0.0)
    return;
  factor_.assign(factor.data(), factor.data() + rank * rank);
  for (Eigen::Index i = 0; i < rank; ++i) inverse_pivots_.push_back(1.0 / factor(i, i));
}

void InnerEllipsoid::fit(const SimplicialComplex& complex) {
  radius_sq_ = 0.0;
  if (factor_.empty()) return;
  const auto rank = static_cast<Eigen::Index>(rank_);
  const Eigen::Map<const Matrix> factor(factor_.data(), rank, rank);
  const Eigen::Map<const Vector> mean(mean_.data(), rank);
  const Matrix sizes = factor.cwiseAbs();
  double radius = HUGE_VAL;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    const Eigen::Map<const Vector> plane(complex.plane(SimplexId{row}).data(), rank);
    const double below = (1.0 - kMargin) * (1.0 - plane.dot(mean)) - plane.norm() * rounding_;
    const double substitution = static_cast<double>(rank_ + 2) * kUnitRoundoff;
    const double slope =
        (factor.transpose() * plane).norm() + substitution * (sizes.transpose() * plane.cwiseAbs()).norm();
    radius = std::min(radius, below / slope);
  }
  if (radius > 0.0 && radius < HUGE_VAL) radius_sq_ = radius * radius;
}

bool InnerEllipsoid::contains(const double* x) const {
  if (radius_sq_ == 0.0) return false;
  std::array<double, kMaxRank> z;
  double sum = 0.0;
  for (std::size_t i = 0; i < rank_; ++i) {
    double y = -mean_[i];
    if (is_diagonal_) {
      y += map_[i * dimension_ + i] * (x[i] - centre_[i]);
    } else {
      for (std::size_t k = 0; k < dimension_; ++k) y += map_[i * dimension_ + k] * (x[k] - centre_[k]);
    }
    for (std::size_t k = 0; k < i; ++k) y -= factor_[i * rank_ + k] * z[k];
    z[i] = y * inverse_pivots_[i];
    sum += z[i] * z[i];
    if (sum >= radius_sq_) return false;
  }
  return true;
}

}  // namespace ndhull
