#include "tools/qhull/qhull_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"

namespace ndhull {
namespace {

/// What one column is scaled to; nothing: it stays.
struct ColumnBounds {
  std::optional<double> lower, upper;
  bool is_dropped() const { return lower && upper && *lower == 0.0 && *upper == 0.0; }
};

std::vector<ColumnBounds> bounds_of(const PointView& points, const QhullCommand& command) {
  std::vector<ColumnBounds> bounds(points.dimension);
  if (command.unit_cube) std::fill(bounds.begin(), bounds.end(), ColumnBounds{-0.5, 0.5});
  for (const ColumnBound& bound : command.column_bounds) {
    if (bound.column >= points.dimension) {
      throw Error(
          ErrorCode::kUsage,
          fmt::format("qhull options: found Q{}{} for points in dimension {}, expected a coordinate "
                      "from 0 to {}",
                      bound.is_upper ? 'B' : 'b', bound.column, points.dimension, points.dimension - 1));
    }
    (bound.is_upper ? bounds[bound.column].upper : bounds[bound.column].lower) = bound.value;
  }
  return bounds;
}

void check_left(const std::vector<std::size_t>& columns) {
  if (!columns.empty()) return;
  throw Error(ErrorCode::kUsage,
              "qhull options: found Qbk:0Bk:0 for all coordinates, expected one to be left; remove one");
}

class ColumnScaling {
 public:
  ColumnScaling(PointSet& points, std::size_t column) : points_(points), column_(column) {
    for (std::size_t row = 0; row < points.rows(); ++row) {
      low_ = std::min(low_, at(row));
      high_ = std::max(high_, at(row));
    }
  }

  double largest() const { return std::max(std::abs(low_), std::abs(high_)); }

  void move_to(double lower, double upper, std::size_t input_column) {
    if (lower > upper) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("qhull options: found bounds {} to {} for coordinate {}, expected the lower "
                              "one first; exchange them",
                              lower, upper, input_column));
    }
    if (!(low_ < high_)) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("qhull options: found coordinate {} to scale with the same value {} in all "
                              "points, expected two values; leave it out with Qb{}:0B{}:0",
                              input_column, low_, input_column, input_column));
    }
    const double scale = (upper - lower) / (high_ - low_);
    for (std::size_t row = 0; row < points_.rows(); ++row) {
      // The ends are met exactly: rounding must not make points that lie on one face part.
      const double from_low = lower + (at(row) - low_) * scale;
      at(row) = at(row) == high_ ? upper : std::clamp(from_low, lower, upper);
    }
  }

  void move_to(const ColumnBounds& bounds, std::size_t input_column) {
    if (!bounds.lower && !bounds.upper) return;
    move_to(bounds.lower.value_or(low_), bounds.upper.value_or(high_), input_column);
  }

 private:
  double& at(std::size_t row) { return points_.coordinates[row * points_.dimension + column_]; }

  PointSet& points_;
  std::size_t column_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

bool scales_points(const QhullCommand& command) {
  return command.unit_cube || command.scale_last || !command.column_bounds.empty();
}

PointSet scaled_points(const PointView& points, const QhullCommand& command) {
  const std::vector<ColumnBounds> bounds = bounds_of(points, command);
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < points.dimension; ++column) {
    if (!bounds[column].is_dropped()) columns.push_back(column);
  }
  check_left(columns);
  PointSet scaled;
  scaled.dimension = columns.size();
  scaled.coordinates.reserve(points.rows * columns.size());
  for (std::size_t row = 0; row < points.rows; ++row) {
    for (const std::size_t column : columns) scaled.coordinates.push_back(points.at(row, column));
  }
  for (std::size_t column = 0; column < columns.size(); ++column) {
    ColumnScaling(scaled, column).move_to(bounds[columns[column]], columns[column]);
  }
  if (command.scale_last && columns.size() > 1) {
    double largest = 0.0;
    for (std::size_t column = 0; column + 1 < columns.size(); ++column) {
      largest = std::max(largest, ColumnScaling(scaled, column).largest());
    }
    ColumnScaling(scaled, columns.size() - 1).move_to(0.0, largest, columns.back());
  }
  return scaled;
}

}  // namespace ndhull
