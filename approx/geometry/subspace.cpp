#include "approx/geometry/subspace.h"

#include "approx/geometry/orthonormal.h"
#include "core/linear/dense_views.h"

namespace ndhull {

Eigen::MatrixXd subspace_directions(std::size_t dimension, std::span<const double> equations) {
  const auto columns = static_cast<Eigen::Index>(dimension);
  if (equations.empty()) return Eigen::MatrixXd::Identity(columns, columns);
  const auto rows = as_rows(equations, dimension + 1);
  return orthonormal_columns(rows.leftCols(columns).transpose(), columns).rightCols(columns - rows.rows());
}

}  // namespace ndhull
