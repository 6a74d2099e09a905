// Normals spread over all directions by a linear map: what is thin becomes round, and tolerances mean
// something.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/linear/dense_views.h"

namespace ndhull {

/// Normals n' = n map / |n map|, or a direction that all normals are orthogonal to.
struct EvenNormals {
  RowMatrix rows;       ///< unit rows
  Eigen::MatrixXd map;  ///< rank x rank: the point w among the even normals is map w among the others
  std::optional<Eigen::VectorXd> orthogonal;  ///< unit length; then rows is empty
};

/// The map that makes the columns of `rows` orthonormal: QR of the rows with their columns scaled and
/// pivoted. Normals of a flat lens, (1e-13, .., 1), have their digits in small entries; scaling first keeps
/// these.
///
/// Shapes  rows: unit normals, any number, in rank coordinates.
/// Cost    O(rows rank^2).
/// Source  Golub, Van Loan. Matrix Computations, 4th ed., sec. 5.4 (QR with column pivoting).
EvenNormals spread_evenly(const RowMatrix& rows);

}  // namespace ndhull
