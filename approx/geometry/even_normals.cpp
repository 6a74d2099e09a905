#include "approx/geometry/even_normals.h"

#include <algorithm>

#include "core/linear/dense_solve.h"

namespace ndhull {

EvenNormals spread_evenly(const RowMatrix& rows) {
  EvenNormals even;
  const Eigen::Index rank = rows.cols();
  if (rows.rows() == 0) {
    even.orthogonal = Eigen::VectorXd::Unit(rank, 0);
    return even;
  }
  const Eigen::VectorXd lengths = rows.colwise().norm().transpose();
  for (Eigen::Index k = 0; k < rank; ++k) {
    if (lengths[k] > 0.0) continue;
    even.orthogonal = Eigen::VectorXd::Unit(rank, k);
    return even;
  }
  const Eigen::MatrixXd scaled = rows * lengths.cwiseInverse().asDiagonal();
  const PivotedFactors factors(scaled, 1e-14 * static_cast<double>(rank));
  const Eigen::MatrixXd permutation = factors.permutation();
  const Eigen::Index found = factors.rank();
  Eigen::MatrixXd upper = Eigen::MatrixXd::Identity(rank, rank);
  upper.topRows(std::min(found, rows.rows())) = factors.upper(std::min(found, rows.rows()));
  const Eigen::MatrixXd inverse =
      upper.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(rank, rank));
  even.map = lengths.cwiseInverse().asDiagonal() * permutation * inverse;
  if (found < rank) {
    even.orthogonal = even.map.col(rank - 1).normalized();
    return even;
  }
  even.rows = rows * even.map;
  even.rows.rowwise().normalize();
  return even;
}

}  // namespace ndhull
