// Orthonormal directions from dense ones. Apart from its users because the factorisation's templates take
// seconds to compile.
#pragma once

#include <Eigen/Core>

namespace ndhull {

/// The first `count` columns of Q in spanning = QR: the first spanning.cols() span what the columns of
/// `spanning` do, the rest is orthogonal to it.
///
/// Shapes  spanning: n x k, k <= n, independent columns; result: n x count, count <= n.
/// Cost    O(n^2 count).
/// Source  Golub, Van Loan. Matrix Computations, 4th ed., sec. 5.2 (Householder QR).
Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& spanning, Eigen::Index count);

/// R of columns = QR: k x k, upper triangular, for columns of n x k, k <= n.
Eigen::MatrixXd upper_factor(const Eigen::MatrixXd& columns);

}  // namespace ndhull
