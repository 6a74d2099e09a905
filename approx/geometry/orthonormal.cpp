#include "approx/geometry/orthonormal.h"

#include <Eigen/QR>

namespace ndhull {

Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& spanning, Eigen::Index count) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(spanning);
  return factors.householderQ() * Eigen::MatrixXd::Identity(spanning.rows(), count);
}

Eigen::MatrixXd upper_factor(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(columns);
  return factors.matrixQR().topRows(columns.cols()).triangularView<Eigen::Upper>();
}

}  // namespace ndhull
