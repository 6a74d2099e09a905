// Eigen's view of numbers that are elsewhere, and the other way round.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace ndhull {

/// Rows as the rest of the code has them: one after the other.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline std::span<const double> as_span(const Eigen::VectorXd& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

inline Eigen::Map<const Eigen::VectorXd> as_vector(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// Precondition: columns > 0, and a whole number of rows.
inline Eigen::Map<const RowMatrix> as_rows(std::span<const double> values, std::size_t columns) {
  return {values.data(), static_cast<Eigen::Index>(values.size() / columns),
          static_cast<Eigen::Index>(columns)};
}

}  // namespace ndhull
