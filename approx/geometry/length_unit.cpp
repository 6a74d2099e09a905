#include "approx/geometry/length_unit.h"

#include <Eigen/Core>
#include <cmath>

#include "approx/geometry/frame_planes.h"
#include "approx/geometry/orthonormal.h"
#include "core/linear/dense_views.h"

namespace ndhull {
namespace {

/// [ratio] Sums of squares between these neither overflow nor lose digits.
constexpr double kLeastSquares = 0x1p-900, kMostSquares = 0x1p900;

int largest_exponent(const Eigen::Ref<const Eigen::MatrixXd>& entries) {
  int exponent = 0;
  std::frexp(entries.size() == 0 ? 0.0 : entries.cwiseAbs().maxCoeff(), &exponent);
  return exponent;
}

/// The length of a vector that may be tiny or huge.
double safe_length(const Eigen::VectorXd& entries) {
  const double square = entries.squaredNorm();
  if (square > kLeastSquares && square < kMostSquares) return std::sqrt(square);
  const int exponent = largest_exponent(entries);
  const Eigen::VectorXd scaled =
      entries.unaryExpr([exponent](double entry) { return std::ldexp(entry, -exponent); });
  return std::ldexp(scaled.norm(), exponent);
}

}  // namespace

LengthUnit::LengthUnit(const Frame& frame, bool unit_cube) {
  if (!unit_cube) return;
  extents_.resize(frame.dimension);
  for (std::size_t k = 0; k < frame.dimension; ++k) extents_[k] = frame.column_max[k] - frame.column_min[k];
  if (frame.rank == frame.dimension) return;
  Eigen::MatrixXd spanned = as_rows(frame.basis, frame.dimension).transpose();
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    spanned.row(static_cast<Eigen::Index>(k)) *= extents_[k] > 0.0 ? 1.0 / extents_[k] : 0.0;
  }
  for (Eigen::Index column = 0; column < spanned.cols(); ++column) {
    const int exponent = largest_exponent(spanned.col(column));
    for (double& entry : spanned.col(column)) entry = std::ldexp(entry, -exponent);
    spanned.col(column).normalize();
  }
  const RowMatrix thin = orthonormal_columns(spanned, spanned.cols()).transpose();
  directions_.assign(thin.data(), thin.data() + thin.size());
}

std::vector<double> LengthUnit::gradient(std::span<const double> normal) const {
  std::vector<double> scaled(normal.begin(), normal.end());
  if (extents_.empty()) return scaled;
  for (std::size_t k = 0; k < normal.size(); ++k) scaled[k] *= extents_[k];
  if (directions_.empty()) return scaled;
  const Eigen::VectorXd inside =
      as_rows(directions_, normal.size()) *
      Eigen::Map<const Eigen::VectorXd>(scaled.data(), static_cast<Eigen::Index>(scaled.size()));
  return {inside.data(), inside.data() + inside.size()};
}

double LengthUnit::input_per_unit(std::span<const double> normal) const {
  if (extents_.empty()) return 1.0;
  if (directions_.empty()) {  // the most usual case, without memory of its own
    double square = 0.0;
    for (std::size_t k = 0; k < normal.size(); ++k)
      square += normal[k] * extents_[k] * (normal[k] * extents_[k]);
    if (square > kLeastSquares && square < kMostSquares) return std::sqrt(square);
  }
  const std::vector<double> scaled = gradient(normal);
  return safe_length(
      Eigen::Map<const Eigen::VectorXd>(scaled.data(), static_cast<Eigen::Index>(scaled.size())));
}

std::vector<double> gradient_factor(const Frame& frame, const LengthUnit& unit) {
  const std::size_t rank = frame.rank;
  std::vector<double> axes(rank * rank, 0.0), normals(rank * frame.dimension), lengths(rank);
  for (std::size_t i = 0; i < rank; ++i) axes[i * rank + i] = 1.0;
  NormalMap(frame).map(axes.data(), rank, normals.data(), lengths.data());
  Eigen::MatrixXd gradients;
  for (std::size_t i = 0; i < rank; ++i) {
    const std::vector<double> column = unit.gradient({normals.data() + i * frame.dimension, frame.dimension});
    gradients.conservativeResize(static_cast<Eigen::Index>(column.size()), static_cast<Eigen::Index>(rank));
    gradients.col(static_cast<Eigen::Index>(i)) =
        lengths[i] *
        Eigen::Map<const Eigen::VectorXd>(column.data(), static_cast<Eigen::Index>(column.size()));
  }
  const int exponent = largest_exponent(gradients);
  const auto times = [](int power) { return [power](double entry) { return std::ldexp(entry, power); }; };
  const RowMatrix upper = upper_factor(gradients.unaryExpr(times(-exponent))).unaryExpr(times(exponent));
  return {upper.data(), upper.data() + upper.size()};
}

}  // namespace ndhull
