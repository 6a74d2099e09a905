#include "tools/view/point_extent.h"

#include <algorithm>
#include <cmath>

namespace ndhull {

double largest_extent(const PointView& points) {
  double largest = 0.0;
  for (std::size_t column = 0; column < points.dimension; ++column) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t row = 0; row < points.rows; ++row) {
      low = std::min(low, points.at(row, column));
      high = std::max(high, points.at(row, column));
    }
    largest = std::max(largest, high - low);
  }
  return largest;
}

}  // namespace ndhull
