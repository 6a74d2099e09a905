// The affine subspace that flat data lie in, as directions instead of equations.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace ndhull {

/// Orthonormal directions that all equations leave free: dimension x rank, one a column; the unit vectors
/// when there are no equations.
///
/// Shapes  equations: rows of dimension + 1 numbers (normal, offset), independent, as
///         Hull::subspace_equations.
/// Source  Golub, Van Loan. Matrix Computations, 4th ed., sec. 5.2 (Householder QR).
Eigen::MatrixXd subspace_directions(std::size_t dimension, std::span<const double> equations);

}  // namespace ndhull
