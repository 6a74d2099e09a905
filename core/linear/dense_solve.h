// Small dense systems. Apart from their users because Eigen's factorisations take seconds to compile for each
// of them.
#pragma once

#include <Eigen/LU>
#include <Eigen/QR>

namespace ndhull {

/// LU factors of a square matrix, partial pivoting. Singular ones give infinities and NaN, as Eigen does.
class SquareFactors {
 public:
  explicit SquareFactors(const Eigen::MatrixXd& rows);

  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;
  Eigen::MatrixXd inverse() const;
  double determinant() const;
  /// Of tiny or huge entries: the determinant is what is returned times 2^exponent.
  double determinant(int& exponent) const;
  double reciprocal_condition() const;  ///< an estimate

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
};

/// QR factors of a matrix, Householder, columns pivoted: matrix x permutation = QR.
class PivotedFactors {
 public:
  /// `threshold`: pivots below this share of the largest count as 0; 0: what rounding leaves.
  explicit PivotedFactors(const Eigen::MatrixXd& matrix, double threshold = 0.0);

  /// Least squares; where columns depend on others, these get 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;
  Eigen::Index rank() const;
  Eigen::MatrixXd permutation() const;
  Eigen::MatrixXd q() const;                       ///< all of it, square
  Eigen::MatrixXd upper(Eigen::Index rows) const;  ///< the first rows of R, at most as many as the matrix has

 private:
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors_;
};

/// The upper triangular map W with W^T covariance W = 1: rows times W have the unit matrix for a covariance.
Eigen::MatrixXd whitening_map(const Eigen::MatrixXd& covariance);

/// Of several the shortest.
Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right_side);

}  // namespace ndhull
