// Points in their frame, for growth to begin with.
#pragma once

#include <vector>

#include "core/frame.h"
#include "core/growth/growth.h"
#include "core/points.h"

namespace ndhull {

/// Maps the points to their frame, and makes `work` that of all of them. `coordinates` has to stay where it
/// is.
inline Frame prepare_growth(const PointView& points, std::vector<double>& coordinates, GrowthWork& work) {
  const Frame frame = fit_frame(points);
  coordinates.resize(points.rows * frame.rank + 8);  // vector loads may read behind the last point
  map_points(points, frame, coordinates.data());
  work.rank = frame.rank;
  work.point_count = points.rows;
  work.points = coordinates.data();
  return frame;
}

/// Distances are as if each axis of the frame were so many times as long as the one before.
inline std::vector<double> unequal_axes(std::size_t rank) {
  constexpr double kLonger = 1.6;
  std::vector<double> factor(rank * rank, 0.0);
  double length = 1.0;
  for (std::size_t k = 0; k < rank; ++k, length *= kLonger) factor[k * rank + k] = 1.0 / length;
  return factor;
}

}  // namespace ndhull
