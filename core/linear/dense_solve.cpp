#include "core/linear/dense_solve.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace ndhull {

SquareFactors::SquareFactors(const Eigen::MatrixXd& rows) : factors_(rows) {}

Eigen::VectorXd SquareFactors::solve(const Eigen::VectorXd& right_side) const {
  return factors_.solve(right_side);
}

Eigen::MatrixXd SquareFactors::inverse() const { return factors_.inverse(); }

double SquareFactors::determinant() const { return factors_.determinant(); }

double SquareFactors::determinant(int& exponent) const {
  double product = static_cast<double>(factors_.permutationP().determinant());
  exponent = 0;
  for (const double pivot : factors_.matrixLU().diagonal()) {
    int power = 0;
    product *= std::frexp(pivot, &power);
    exponent += power;
  }
  return product;
}

double SquareFactors::reciprocal_condition() const { return factors_.rcond(); }

PivotedFactors::PivotedFactors(const Eigen::MatrixXd& matrix, double threshold) : factors_(matrix) {
  if (threshold > 0.0) factors_.setThreshold(threshold);
}

Eigen::VectorXd PivotedFactors::solve(const Eigen::VectorXd& right_side) const {
  return factors_.solve(right_side);
}

Eigen::Index PivotedFactors::rank() const { return factors_.rank(); }

Eigen::MatrixXd PivotedFactors::permutation() const { return factors_.colsPermutation(); }

Eigen::MatrixXd PivotedFactors::q() const {
  return factors_.householderQ() * Eigen::MatrixXd::Identity(factors_.rows(), factors_.rows());
}

Eigen::MatrixXd PivotedFactors::upper(Eigen::Index rows) const {
  return factors_.matrixR().topRows(rows).triangularView<Eigen::Upper>();
}

Eigen::MatrixXd whitening_map(const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  return root.matrixU().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
}

Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right_side) {
  return matrix.completeOrthogonalDecomposition().solve(right_side);
}

}  // namespace ndhull
