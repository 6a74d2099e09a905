#include "approx/subspace.h"

#include "approx/orthonormal.h"

namespace ndhull {

Eigen::MatrixXd subspace_directions(std::size_t dimension, std::span<const double> equations) {
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto columns = static_cast<Eigen::Index>(dimension);
  if (equations.empty()) return Eigen::MatrixXd::Identity(columns, columns);
  const auto count = static_cast<Eigen::Index>(equations.size() / (dimension + 1));
  const Eigen::Map<const RowMatrix> rows(equations.data(), count, columns + 1);
  return orthonormal_columns(rows.leftCols(columns).transpose(), columns).rightCols(columns - count);
}

}  // namespace ndhull
