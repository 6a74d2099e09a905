#include "approx/inner_ellipsoid.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/blocks.h"
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
  if (dimension_ > kMaxRank || covariance.info() != Eigen::Success || !factor.allFinite() ||
      factor.diagonal().minCoeff() <= 0.0)
    return;
  factor_.assign(factor.data(), factor.data() + rank * rank);
  for (Eigen::Index i = 0; i < rank; ++i) inverse_pivots_.push_back(1.0 / factor(i, i));
}

/// The largest radius, in units of the ellipsoid, that is proven to be below this plane.
double InnerEllipsoid::radius_below(std::span<const double> plane) const {
  double at_mean = 0.0, length_sq = 0.0, slope_sq = 0.0, sizes_sq = 0.0;
  for (std::size_t i = 0; i < rank_; ++i) {
    at_mean += plane[i] * mean_[i];
    length_sq += plane[i] * plane[i];
    double slope = 0.0, size = 0.0;
    for (std::size_t k = i; k < rank_; ++k) {  // the factor is a lower triangle
      const double term = factor_[k * rank_ + i] * plane[k];
      slope += term;
      size += std::abs(term);
    }
    slope_sq += slope * slope;
    sizes_sq += size * size;
  }
  const double below = (1.0 - kMargin) * (1.0 - at_mean) - std::sqrt(length_sq) * rounding_;
  const double substitution = static_cast<double>(rank_ + 2) * kUnitRoundoff;
  return below / (std::sqrt(slope_sq) + substitution * std::sqrt(sizes_sq));
}

void InnerEllipsoid::fit(const SimplicialComplex& complex) {
  constexpr std::size_t kRowsAtATime = 4096;
  radius_sq_ = 0.0;
  if (factor_.empty()) return;
  std::vector<double> radii((complex.row_count + kRowsAtATime - 1) / kRowsAtATime, HUGE_VAL);
  for_each_block(complex.row_count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    double& radius = radii[begin / kRowsAtATime];
    for (std::size_t row = begin; row < end; ++row) {
      if (complex.state[row] != SimplexState::kLive) continue;
      radius = std::min(radius, radius_below(complex.plane(SimplexId{static_cast<std::uint32_t>(row)})));
    }
  });
  const double radius = *std::min_element(radii.begin(), radii.end());
  if (radius > 0.0 && radius < HUGE_VAL) radius_sq_ = radius * radius;
}

// Loops over points inside, so that compilers vectorize them; each point's sums are in the order of its
// columns.
std::uint64_t InnerEllipsoid::contains(const double* points, std::size_t count) const {
  if (radius_sq_ == 0.0 || count == 0) return 0;
  using Lane = std::array<double, kPoints>;
  std::array<Lane, kMaxRank> shifted, z;
  Lane length_sq{};
  for (std::size_t k = 0; k < dimension_; ++k)
    for (std::size_t i = 0; i < kPoints; ++i)  // behind the last point that one again
      shifted[k][i] = points[std::min(i, count - 1) * dimension_ + k] - centre_[k];
  for (std::size_t row = 0; row < rank_; ++row) {
    Lane y;
    y.fill(-mean_[row]);
    for (std::size_t k = is_diagonal_ ? row : 0; k < (is_diagonal_ ? row + 1 : dimension_); ++k)
      for (std::size_t i = 0; i < kPoints; ++i) y[i] += map_[row * dimension_ + k] * shifted[k][i];
    for (std::size_t k = 0; k < row; ++k)
      for (std::size_t i = 0; i < kPoints; ++i) y[i] -= factor_[row * rank_ + k] * z[k][i];
    for (std::size_t i = 0; i < kPoints; ++i) {
      z[row][i] = y[i] * inverse_pivots_[row];
      length_sq[i] += z[row][i] * z[row][i];
    }
  }
  std::uint64_t inside = 0;
  for (std::size_t i = 0; i < count; ++i)
    inside |= static_cast<std::uint64_t>(length_sq[i] < radius_sq_ ? 1 : 0) << i;
  return inside;
}

void InnerEllipsoid::drop_inside(const PointView& points, std::size_t begin, std::size_t end,
                                 RowBits& rows) const {
  if (radius_sq_ == 0.0) return;
  std::vector<double> copies(kPoints * dimension_);
  std::array<std::size_t, kPoints> ids;
  std::size_t count = 0;
  const auto look = [&] {
    for (std::uint64_t inside = contains(copies.data(), count); inside != 0; inside &= inside - 1)
      rows.drop(ids[static_cast<std::size_t>(std::countr_zero(inside))]);
    count = 0;
  };
  rows.for_each(begin, end, [&](std::size_t row) {
    points.copy_row(row, copies.data() + count * dimension_);
    ids[count++] = row;
    if (count == kPoints) look();
  });
  look();
}

}  // namespace ndhull
