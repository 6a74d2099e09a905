// A view of the input points: rows x dimension, float or double, any strides, not copied.
#pragma once

#include <cstddef>

namespace ndhull {

/// The element type of a view.
enum class ScalarType { kFloat32, kFloat64 };

/// Points as they stand in memory (an array of the caller's, a mapped file). Row-major arrays have
/// row_stride = dimension and column_stride = 1; Fortran order has 1 and rows. Strides count elements.
/// The memory must outlive the view. Cost of a copy: a few words.
struct PointView {
  const void* data = nullptr;
  std::size_t rows = 0;
  std::size_t dimension = 0;
  ScalarType type = ScalarType::kFloat64;
  std::size_t row_stride = 0;
  std::size_t column_stride = 1;
  /// The data are a file mapped read-only: of large inputs what was read is given back to the system, since
  /// it comes again from the file when it is wanted.
  bool is_file_mapping = false;

  static PointView row_major(const double* data, std::size_t rows, std::size_t dimension) {
    return {data, rows, dimension, ScalarType::kFloat64, dimension, 1, false};
  }
  static PointView row_major(const float* data, std::size_t rows, std::size_t dimension) {
    return {data, rows, dimension, ScalarType::kFloat32, dimension, 1, false};
  }

  /// Coordinate `column` of point `row` as a double (exact for both types).
  double at(std::size_t row, std::size_t column) const {
    const std::size_t index = row * row_stride + column * column_stride;
    return type == ScalarType::kFloat64 ? static_cast<const double*>(data)[index]
                                        : static_cast<double>(static_cast<const float*>(data)[index]);
  }
  /// Copies point `row` to `out` (dimension doubles).
  void copy_row(std::size_t row, double* out) const {
    const std::size_t first = row * row_stride;
    if (type == ScalarType::kFloat64) {
      const double* const from = static_cast<const double*>(data) + first;
      for (std::size_t column = 0; column < dimension; ++column) out[column] = from[column * column_stride];
    } else {
      const float* const from = static_cast<const float*>(data) + first;
      for (std::size_t column = 0; column < dimension; ++column)
        out[column] = static_cast<double>(from[column * column_stride]);
    }
  }
};

}  // namespace ndhull
