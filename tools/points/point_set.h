// Points that own their memory: what generators return and readers fill.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/points.h"

namespace ndhull {

/// Rows of `dimension` coordinates, one after the other, and the text that says what they are.
struct PointSet {
  std::size_t dimension = 0;
  std::vector<double> coordinates;  ///< rows x dimension, row-major, no spare elements
  std::string header;               ///< a comment for the first line of a text file; may be empty

  std::size_t rows() const { return dimension == 0 ? 0 : coordinates.size() / dimension; }
  std::span<const double> row(std::size_t index) const {
    return {coordinates.data() + index * dimension, dimension};
  }
  std::span<double> row(std::size_t index) { return {coordinates.data() + index * dimension, dimension}; }
  /// Valid as long as the set lives and `coordinates` is not resized.
  PointView view() const { return PointView::row_major(coordinates.data(), rows(), dimension); }
};

}  // namespace ndhull
