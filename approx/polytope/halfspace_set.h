// Halfspaces as given, their unit normals, and distances from their planes without cancellation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/points.h"

namespace ndhull {

/// Halfspaces a.x + b <= 0, copied.
class HalfspaceSet {
 public:
  /// rows: count x (dimension + 1), each a_1 .. a_d, b; normals of any length but zero.
  /// Throws  Error kDimensionTooLow fewer than two columns; kNotFinite row and column of a NaN or infinity;
  ///         kBadHalfspace a zero normal, with its row; kTooManyPoints 2^31 rows or more.
  explicit HalfspaceSet(const PointView& rows);
  /// Throws what the constructor does of numbers of rows and columns.
  static void check_shape(const PointView& rows);

  std::size_t dimension() const { return dimension_; }
  std::size_t count() const { return lengths_.size(); }
  std::span<const double> normal(std::size_t id) const {
    return {rows_.data() + id * (dimension_ + 1), dimension_};
  }
  double offset(std::size_t id) const { return rows_[id * (dimension_ + 1) + dimension_]; }
  double length(std::size_t id) const { return lengths_[id]; }  ///< of the normal

  /// (a.x + b) / |a|, positive outside; the numerator is summed in pairs of doubles.
  double distance(std::size_t id, std::span<const double> point) const;
  /// [distance] What half a unit in the last place of a and b moves the plane by at `point`.
  double roundoff(std::size_t id, std::span<const double> point) const;

 private:
  std::size_t dimension_;
  std::vector<double> rows_, lengths_;
};

}  // namespace ndhull
