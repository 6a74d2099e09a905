#include "approx/polytope/halfspace_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/plane_value.h"

namespace ndhull {
namespace {

/// Without overflow or underflow on the way.
double length_of(std::span<const double> vector) {
  double largest = 0.0, sum = 0.0;
  for (const double value : vector) largest = std::max(largest, std::abs(value));
  if (largest == 0.0) return 0.0;
  for (const double value : vector) sum += (value / largest) * (value / largest);
  return largest * std::sqrt(sum);
}

}  // namespace

void HalfspaceSet::check_shape(const PointView& rows) {
  if (rows.dimension < 2) {
    throw Error(ErrorCode::kDimensionTooLow,
                "found " + std::to_string(rows.dimension) +
                    " columns, expected the normal and the offset of halfspaces");
  }
  if (rows.rows >= std::size_t{1} << 31) {
    throw Error(ErrorCode::kTooManyPoints,
                "found " + std::to_string(rows.rows) + " halfspaces, expected fewer than 2^31");
  }
}

HalfspaceSet::HalfspaceSet(const PointView& rows) : dimension_(rows.dimension - 1) {
  check_shape(rows);
  rows_.resize(rows.rows * rows.dimension);
  lengths_.resize(rows.rows);
  for (std::size_t row = 0; row < rows.rows; ++row) {
    double* const out = rows_.data() + row * rows.dimension;
    rows.copy_row(row, out);
    for (std::size_t column = 0; column < rows.dimension; ++column) {
      if (std::isfinite(out[column])) continue;
      throw Error(ErrorCode::kNotFinite, "halfspace " + std::to_string(row) + " (counted from 0), column " +
                                             std::to_string(column + 1) +
                                             ": found NaN or infinity, expected a finite number");
    }
    lengths_[row] = length_of(normal(row));
    if (lengths_[row] > 0.0 && std::isfinite(lengths_[row])) continue;
    throw Error(ErrorCode::kBadHalfspace, "halfspace " + std::to_string(row) + " (counted from 0)" +
                                              ": found a normal of length " + std::to_string(lengths_[row]) +
                                              ", expected a positive finite one; remove the row");
  }
}

double HalfspaceSet::distance(std::size_t id, std::span<const double> point) const {
  const CentredPlane plane{.normal = normal(id), .reference = {}, .offset = offset(id)};
  return plane_value_extended(plane, point).value / lengths_[id];
}

double HalfspaceSet::roundoff(std::size_t id, std::span<const double> point) const {
  double sum = std::abs(offset(id));
  const auto row = normal(id);
  for (std::size_t k = 0; k < dimension_; ++k) sum += std::abs(row[k] * point[k]);
  return 0.5 * std::numeric_limits<double>::epsilon() * sum / lengths_[id];
}

}  // namespace ndhull
