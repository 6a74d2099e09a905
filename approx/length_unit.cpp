#include "approx/length_unit.h"

#include <Eigen/Dense>

namespace ndhull {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Map<const RowMatrix> rows_of(const std::vector<double>& values, std::size_t columns) {
  return {values.data(), static_cast<Eigen::Index>(values.size() / columns),
          static_cast<Eigen::Index>(columns)};
}

}  // namespace

LengthUnit::LengthUnit(const Frame& frame, bool unit_cube) {
  if (!unit_cube) return;
  extents_.resize(frame.dimension);
  for (std::size_t k = 0; k < frame.dimension; ++k) extents_[k] = frame.column_max[k] - frame.column_min[k];
  if (frame.rank == frame.dimension) return;
  Eigen::MatrixXd spanned = rows_of(frame.basis, frame.dimension).transpose();
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    spanned.row(static_cast<Eigen::Index>(k)) *= extents_[k] > 0.0 ? 1.0 / extents_[k] : 0.0;
  }
  for (Eigen::Index column = 0; column < spanned.cols(); ++column) spanned.col(column).normalize();
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(spanned);
  const RowMatrix thin =
      (factors.householderQ() * Eigen::MatrixXd::Identity(spanned.rows(), spanned.cols())).transpose();
  directions_.assign(thin.data(), thin.data() + thin.size());
}

double LengthUnit::input_per_unit(std::span<const double> normal) const {
  if (extents_.empty()) return 1.0;
  Eigen::VectorXd scaled(static_cast<Eigen::Index>(normal.size()));
  for (std::size_t k = 0; k < normal.size(); ++k)
    scaled[static_cast<Eigen::Index>(k)] = normal[k] * extents_[k];
  if (directions_.empty()) return scaled.norm();
  return (rows_of(directions_, normal.size()) * scaled).norm();
}

}  // namespace ndhull
