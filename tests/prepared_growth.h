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

}  // namespace ndhull
