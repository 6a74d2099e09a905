#include "core/linear/simplex_planes.h"

#include "core/linear/dense_solve.h"

namespace ndhull {

Eigen::VectorXd plane_through(const double* points, std::size_t rank, std::span<const PointId> corners) {
  const auto size = static_cast<Eigen::Index>(rank);
  Eigen::MatrixXd rows(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double* const point = points + std::size_t{corners[static_cast<std::size_t>(i)].value} * rank;
    rows.row(i) = Eigen::Map<const Eigen::RowVectorXd>(point, size);
  }
  const SquareFactors factors(rows);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(size);
  Eigen::VectorXd plane = factors.solve(ones);
  plane += factors.solve(ones - rows * plane);
  return plane;
}

std::vector<Eigen::VectorXd> simplex_planes(const double* points, std::size_t rank,
                                            std::span<const PointId> corners) {
  std::vector<Eigen::VectorXd> planes;
  std::vector<PointId> others(corners.begin() + 1, corners.end());  // without corner k
  for (std::size_t k = 0; k <= rank; ++k) {
    planes.push_back(plane_through(points, rank, others));
    if (k < rank) others[k] = corners[k];
  }
  return planes;
}

}  // namespace ndhull
