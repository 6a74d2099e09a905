// Principal components: eigenvectors of the covariance about the mean. Moments are taken about the centre,
// which is inside the points, so data far from the origin lose no digits.
#include "approx/drawing/drawing_axes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "approx/geometry/subspace.h"

namespace ndhull {
namespace {

Eigen::MatrixXd covariance(const PointView& points, std::span<const double> centre,
                           const Eigen::VectorXd& scales) {
  const auto dimension = static_cast<Eigen::Index>(points.dimension);
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(dimension, dimension);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(dimension);
  const Eigen::Map<const Eigen::VectorXd> middle(centre.data(), dimension);
  // [rows] Products of blocks are matrix products; a block fits the second-level cache.
  constexpr std::size_t kBlockRows = 512;
  Eigen::MatrixXd block(dimension, static_cast<Eigen::Index>(kBlockRows));
  for (std::size_t start = 0; start < points.rows; start += kBlockRows) {
    const std::size_t rows = std::min(kBlockRows, points.rows - start);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto column = static_cast<Eigen::Index>(row);
      points.copy_row(start + row, block.col(column).data());
      block.col(column) = (block.col(column) - middle).cwiseProduct(scales);
    }
    const auto filled = block.leftCols(static_cast<Eigen::Index>(rows));
    moments.noalias() += filled * filled.transpose();
    sum += filled.rowwise().sum();
  }
  const auto count = static_cast<double>(points.rows);
  return moments / count - (sum / count) * (sum / count).transpose();
}

/// The equations of a subspace in coordinates that are scaled column by column. (Those of directions would
/// lose what columns of very different extents have.)
std::vector<double> scaled_equations(std::span<const double> equations, const Eigen::VectorXd& scales) {
  std::vector<double> scaled(equations.begin(), equations.end());
  const auto stride = static_cast<std::size_t>(scales.size()) + 1;
  for (std::size_t at = 0; at < scaled.size(); ++at) {
    const std::size_t column = at % stride;
    if (column + 1 == stride) continue;
    const double scale = scales[static_cast<Eigen::Index>(column)];
    if (scale > 0.0) scaled[at] /= scale;
  }
  return scaled;
}

/// "62 %: 0.58 carat + 0.57 x - 0.1 depth", the largest parts first.
std::string remark_on(const Eigen::VectorXd& component, double share, std::span<const std::string> names) {
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto size = [&](std::size_t k) { return std::abs(component[static_cast<Eigen::Index>(k)]); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  constexpr std::size_t kMostParts = 3;
  constexpr double kLeastPart = 0.1;  // [ratio] smaller parts say little
  char number[32];
  std::snprintf(number, sizeof number, "%.0f %%:", 100.0 * share);
  std::string text = number;
  for (std::size_t place = 0; place < std::min(order.size(), kMostParts); ++place) {
    const double part = component[static_cast<Eigen::Index>(order[place])];
    if (std::abs(part) < kLeastPart) break;
    std::snprintf(number, sizeof number, "%s%.2f\xC2\xA0",
                  part < 0.0 ? " \xE2\x88\x92" : (place == 0 ? " " : " +"), std::abs(part));
    text += number + names[order[place]];
  }
  return text;
}

}  // namespace

std::vector<std::string> column_names_or_numbers(std::vector<std::string> names, std::size_t dimension) {
  if (names.size() == dimension) return names;
  names.clear();
  for (std::size_t column = 0; column < dimension; ++column)
    names.push_back("x" + std::to_string(column + 1));
  return names;
}

DrawingAxes column_axes(std::span<const std::size_t> columns, std::span<const double> centre,
                        std::span<const std::string> column_names) {
  DrawingAxes axes;
  axes.dimension = centre.size();
  axes.centre.assign(centre.begin(), centre.end());
  axes.directions.assign(columns.size() * axes.dimension, 0.0);
  for (std::size_t axis = 0; axis < columns.size(); ++axis) {
    axes.directions[axis * axes.dimension + columns[axis]] = 1.0;
    axes.origin.push_back(centre[columns[axis]]);
    axes.names.push_back(column_names[columns[axis]]);
    axes.remarks.emplace_back();
  }
  axes.measures = axes.directions;
  return axes;
}

DrawingAxes principal_axes(const PointView& points, std::size_t count, std::span<const double> centre,
                           std::span<const double> extents, std::span<const std::string> column_names,
                           std::span<const double> equations) {
  const auto dimension = static_cast<Eigen::Index>(points.dimension);
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(dimension);
  for (std::size_t k = 0; k < extents.size(); ++k) {
    scales[static_cast<Eigen::Index>(k)] = extents[k] > 0.0 ? 1.0 / extents[k] : 0.0;
  }
  const Eigen::MatrixXd spread = covariance(points, centre, scales);
  Eigen::MatrixXd inside = Eigen::MatrixXd::Identity(dimension, dimension);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(spread);
  // Where points vary less than rounding of how they vary most all directions look alike: those out of their
  // subspace must not be among them. (Elsewhere its equations may be less exact than the covariance.)
  constexpr double kLost = 1e-12;
  if (solver.eigenvalues()[dimension - static_cast<Eigen::Index>(count)] < kLost * spread.trace()) {
    inside = subspace_directions(points.dimension, scaled_equations(equations, scales));
    solver.compute(inside.transpose() * spread * inside);
  }
  const Eigen::VectorXd variances = solver.eigenvalues().cwiseMax(0.0);
  const double all = std::max(variances.sum(), std::numeric_limits<double>::min());
  DrawingAxes axes;
  axes.dimension = points.dimension;
  axes.centre.assign(centre.begin(), centre.end());
  axes.origin.assign(count, 0.0);
  for (std::size_t axis = 0; axis < count; ++axis) {
    const Eigen::Index column = inside.cols() - 1 - static_cast<Eigen::Index>(axis);  // ascending eigenvalues
    Eigen::VectorXd component = inside * solver.eigenvectors().col(column);
    Eigen::Index largest = 0;
    component.cwiseAbs().maxCoeff(&largest);
    if (component[largest] < 0.0) component = -component;
    for (Eigen::Index k = 0; k < dimension; ++k) {
      axes.directions.push_back(scales[k] > 0.0 ? component[k] / scales[k] : 0.0);
      axes.measures.push_back(component[k] * scales[k]);
    }
    axes.names.push_back("PC" + std::to_string(axis + 1));
    axes.remarks.push_back(remark_on(component, variances[column] / all, column_names));
  }
  return axes;
}

}  // namespace ndhull
