#include "approx/facets/flat_plane.h"

#include "core/linear/dense_solve.h"

namespace ndhull {

void fit_flat_plane(const double* points, std::size_t rank, std::span<const PointId> ids, double* plane) {
  using Eigen::Index;
  Eigen::MatrixXd rows(static_cast<Index>(ids.size()), static_cast<Index>(rank));
  for (std::size_t i = 0; i < ids.size(); ++i)
    for (std::size_t k = 0; k < rank; ++k)
      rows(static_cast<Index>(i), static_cast<Index>(k)) = points[std::size_t{ids[i].value} * rank + k];
  Eigen::Map<Eigen::VectorXd> kept(plane, static_cast<Index>(rank));
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.rows());
  Eigen::VectorXd residual = ones - rows * kept;
  const double before = residual.lpNorm<Eigen::Infinity>();
  const Eigen::VectorXd fitted = kept + PivotedFactors(rows).solve(residual);
  residual = ones - rows * fitted;
  if (residual.lpNorm<Eigen::Infinity>() < before) kept = fitted;
}

}  // namespace ndhull
