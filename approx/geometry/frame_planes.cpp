#include "approx/geometry/frame_planes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "approx/geometry/orthonormal.h"
#include "core/dimension_switch.h"
#include "core/linear/dense_solve.h"
#include "core/linear/dense_views.h"

namespace ndhull {

ScaledRatio volume_scale(const Frame& frame) {
  const auto map = as_rows(frame.map, frame.dimension);
  ScaledRatio scale;
  if (frame.rank == frame.dimension) {
    scale.ratio = std::abs(SquareFactors(map).determinant(scale.exponent));
    return scale;
  }
  const auto basis = as_rows(frame.basis, frame.dimension);
  const double spanned = SquareFactors(basis * basis.transpose()).determinant();
  scale.ratio =
      std::abs(SquareFactors(map * basis.transpose()).determinant(scale.exponent)) / std::sqrt(spanned);
  return scale;
}

namespace {

/// The power of two at or below a positive number; of subnormal ones, and of 0, the smallest normal number.
double power_below(double x) {
  constexpr std::uint64_t kExponent = 0x7FF0'0000'0000'0000u;
  return std::max(std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & kExponent),
                  std::numeric_limits<double>::min());
}

/// Scales a row of D numbers (0: of `width`) to length 1 and returns the length that it had.
template <std::size_t D>
double normalise(double* row, std::size_t width) {
  if (D > 0) width = D;
  // By a power of two first: columns of very different scale can overflow the squares.
  double largest = 0.0, square = 0.0;
  for (std::size_t k = 0; k < width; ++k) largest = std::max(largest, std::abs(row[k]));
  const double power = power_below(largest), inverse = 1.0 / power;
  for (std::size_t k = 0; k < width; ++k) {
    row[k] *= inverse;
    square += row[k] * row[k];
  }
  const double length = std::sqrt(square);
  for (std::size_t k = 0; k < width; ++k) row[k] /= length;
  return power * length;
}

/// Do sums of the map's rows lose more than some bits? The scale of a column changes nothing of that.
bool cancels(RowMatrix map) {
  constexpr double kMany = 1024.0;
  for (Eigen::Index column = 0; column < map.cols(); ++column) {
    const double largest = map.col(column).cwiseAbs().maxCoeff();
    if (largest > 0.0) map.col(column) /= largest;
  }
  return !(SquareFactors(map * map.transpose()).reciprocal_condition() > 1.0 / (kMany * kMany));
}

double largest_extent(const Frame& frame) {
  double extent = 0.0;
  for (std::size_t k = 0; k < frame.dimension; ++k)
    extent = std::max(extent, frame.column_max[k] - frame.column_min[k]);
  return extent;
}

}  // namespace

NormalMap::NormalMap(const Frame& frame)
    : rank_(frame.rank),
      dimension_(frame.dimension),
      is_diagonal_(frame.is_diagonal && frame.rank == frame.dimension) {
  RowMatrix to_input = as_rows(frame.map, dimension_);
  if (rank_ < dimension_) {  // keep the part of the normal that lies in the subspace
    const auto basis = as_rows(frame.basis, dimension_);
    const RowMatrix gram = basis * basis.transpose();
    to_input = (to_input * basis.transpose() * gram.ldlt().solve(RowMatrix(basis))).eval();
  }
  to_input_.assign(to_input.data(), to_input.data() + to_input.size());
  if (!is_diagonal_ && cancels(to_input)) {
    const RowMatrix columns = to_input.transpose();
    columns_.assign(columns.data(), columns.data() + columns.size());
  }
  if (!is_diagonal_) return;
  for (std::size_t k = 0; k < dimension_; ++k) diagonal_.push_back(to_input_[k * dimension_ + k]);
}

template <std::size_t D>
void NormalMap::scale_rows(const double* planes, std::size_t count, double* out, double* lengths) const {
  const std::size_t width = D > 0 ? D : dimension_;
  for (std::size_t row = 0; row < count; ++row) {
    double* const normal = out + row * width;
    for (std::size_t k = 0; k < width; ++k) normal[k] = planes[row * width + k] * diagonal_[k];
    const double length = normalise<D>(normal, width);
    if (lengths != nullptr) lengths[row] = length;
  }
}

void NormalMap::map(const double* planes, std::size_t count, double* out, double* lengths) const {
  if (is_diagonal_) {
    if (dimension_ > kMaxRank) return scale_rows<0>(planes, count, out, lengths);
    return call_with_dimension<1, kMaxRank>(
        dimension_, [&](auto d) { scale_rows<decltype(d)::value>(planes, count, out, lengths); });
  }
  constexpr std::size_t kRows = 256;
  const auto to_input = as_rows(to_input_, dimension_);
  RowMatrix block;
  for (std::size_t begin = 0; begin < count; begin += kRows) {
    const std::size_t used = std::min(kRows, count - begin);
    if (columns_.empty()) {
      block.noalias() = as_rows({planes + begin * rank_, used * rank_}, rank_) * to_input;
      std::copy_n(block.data(), used * dimension_, out + begin * dimension_);
    } else {
      map_normals(planes + begin * rank_, used, columns_, rank_, out + begin * dimension_);
    }
    for (std::size_t row = begin; row < begin + used; ++row) {
      const double length = normalise<0>(out + row * dimension_, dimension_);
      if (lengths != nullptr) lengths[row] = length;
    }
  }
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

double distance_off_subspace(const PointView& points, const Frame& frame) {
  const std::vector<double> equations = find_subspace_equations(frame);
  const std::size_t columns = frame.dimension + 1;
  std::vector<double> point(frame.dimension);
  const double extent = largest_extent(frame);
  // In parts of the extent: squares of tiny distances are 0.
  const int exponent = extent > 0.0 ? std::ilogb(extent) : 0;
  double furthest_sq = 0.0;
  for (std::size_t id = 0; id < points.rows && !equations.empty(); ++id) {
    points.copy_row(id, point.data());
    double distance_sq = 0.0;
    for (std::size_t at = 0; at < equations.size(); at += columns) {
      double distance = 0.0;  // the centre is in the subspace
      for (std::size_t k = 0; k < frame.dimension; ++k)
        distance += equations[at + k] * std::ldexp(point[k] - frame.centre[k], -exponent);
      distance_sq += distance * distance;
    }
    furthest_sq = std::max(furthest_sq, distance_sq);
  }
  return std::ldexp(std::sqrt(furthest_sq), exponent);
}

bool is_roughly_flat(const PointView& points, const Frame& frame) {
  constexpr double kRough = 1e-13;
  return distance_off_subspace(points, frame) > kRough * largest_extent(frame);
}

double sum_error(std::size_t terms, double size) {
  const double rounding = static_cast<double>(terms) * 0x1p-53;
  return rounding / (1.0 - rounding) * size;
}

}  // namespace ndhull
