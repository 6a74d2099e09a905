#include "approx/facets/certificate_points.h"

#include <algorithm>
#include <cmath>

namespace ndhull {

std::vector<double> certificate_reference(const Frame& frame) {
  constexpr double kFar = 4.0;  // extents: two bits of the data's digits are worth a plane at the origin
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    const double largest = std::max(std::abs(frame.column_min[k]), std::abs(frame.column_max[k]));
    const double extent = frame.column_max[k] - frame.column_min[k];
    if (extent > 0.0 && largest > kFar * extent) return frame.centre;
  }
  return std::vector<double>(frame.dimension, 0.0);
}

CertificatePoints gather_certificate_points(const PointView& points, const Frame& frame,
                                            const std::vector<bool>& wanted, bool is_known) {
  CertificatePoints result;
  const std::size_t dimension = points.dimension;
  result.dimension = dimension;
  result.reference = certificate_reference(frame);
  result.largest_input.resize(dimension);
  result.largest.assign(dimension, 0.0);
  for (std::size_t k = 0; k < dimension; ++k) {
    result.largest_input[k] = std::max(std::abs(frame.column_min[k]), std::abs(frame.column_max[k]));
    if (!is_known) continue;
    result.largest[k] = std::max(std::abs(frame.column_min[k] - result.reference[k]),
                                 std::abs(frame.column_max[k] - result.reference[k]));
  }
  result.row_of_point.assign(points.rows, 0);
  const auto count = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), true));
  result.rows.reserve(count * dimension);
  for (std::size_t row = 0; row < points.rows; ++row) {
    if (!wanted[row]) continue;
    result.row_of_point[row] = static_cast<std::uint32_t>(result.rows.size() / dimension);
    for (std::size_t k = 0; k < dimension; ++k) {
      const double x = points.at(row, k) - result.reference[k];
      result.rows.push_back(x);
      result.largest[k] = std::max(result.largest[k], std::abs(x));
    }
  }
  return result;
}

}  // namespace ndhull
