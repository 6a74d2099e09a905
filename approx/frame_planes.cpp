#include "approx/frame_planes.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "approx/orthonormal.h"
#include "core/blocks.h"
#include "core/dense_views.h"

namespace ndhull {

double volume_scale(const Frame& frame) {
  const auto map = as_rows(frame.map, frame.dimension);
  if (frame.rank == frame.dimension) return std::abs(RowMatrix(map).determinant());
  const auto basis = as_rows(frame.basis, frame.dimension);
  const double spanned = RowMatrix(basis * basis.transpose()).determinant();
  return std::abs(RowMatrix(map * basis.transpose()).determinant()) / std::sqrt(spanned);
}

void map_normals(const Frame& frame, const double* planes, std::size_t count, double* out, double* lengths) {
  const std::size_t rank = frame.rank, dimension = frame.dimension;
  RowMatrix to_input = as_rows(frame.map, dimension);
  if (rank < dimension) {  // keep the part of the normal that lies in the subspace
    const auto basis = as_rows(frame.basis, dimension);
    const RowMatrix gram = basis * basis.transpose();
    to_input = (to_input * basis.transpose() * gram.ldlt().solve(RowMatrix(basis))).eval();
  }
  constexpr std::size_t kBlock = 256;
  for_each_block(count, kBlock, [&](std::size_t begin, std::size_t end) {
    const std::size_t used = end - begin;
    RowMatrix block;
    const Eigen::Map<const RowMatrix> in(planes + begin * rank, static_cast<Eigen::Index>(used),
                                         static_cast<Eigen::Index>(rank));
    if (frame.is_diagonal && rank == dimension) {
      block = in * to_input.diagonal().asDiagonal();
    } else {
      block.noalias() = in * to_input;
    }
    for (std::size_t row = 0; row < used; ++row) {
      const auto at = static_cast<Eigen::Index>(row);
      // Scaled first: columns of very different scale can overflow the squares.
      const double largest = block.row(at).lpNorm<Eigen::Infinity>();
      block.row(at) /= largest;
      const double length = block.row(at).norm();
      block.row(at) /= length;
      if (lengths != nullptr) lengths[begin + row] = largest * length;
      std::copy_n(block.row(at).data(), dimension, out + (begin + row) * dimension);
    }
  });
}

std::vector<double> find_subspace_equations(const Frame& frame) {
  std::vector<double> equations;
  const auto columns = static_cast<Eigen::Index>(frame.dimension);
  const auto rank = static_cast<Eigen::Index>(frame.rank);
  if (rank == columns) return equations;
  Eigen::MatrixXd complement = Eigen::MatrixXd::Identity(columns, columns);
  if (rank > 0) {
    const Eigen::Map<const Eigen::MatrixXd> directions(frame.basis.data(), columns, rank);
    complement = orthonormal_columns(directions, columns);
  }
  const Eigen::Map<const Eigen::VectorXd> centre(frame.centre.data(), columns);
  for (Eigen::Index row = rank; row < columns; ++row) {
    const Eigen::VectorXd normal = complement.col(row);
    equations.insert(equations.end(), normal.data(), normal.data() + columns);
    equations.push_back(-normal.dot(centre));
  }
  return equations;
}

double sum_error(std::size_t terms, double size) {
  const double rounding = static_cast<double>(terms) * 0x1p-53;
  return rounding / (1.0 - rounding) * size;
}

}  // namespace ndhull
