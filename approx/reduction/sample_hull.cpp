#include "approx/reduction/sample_hull.h"

#include <algorithm>
#include <vector>

#include "core/complex/membership.h"
#include "core/frame.h"
#include "core/growth/growth.h"

namespace ndhull {

bool holds_some_of(const PointView& sample, std::uint64_t seed) {
  constexpr std::size_t kLookedAt = 512, kRows = 128;  // points; simplices for each dimension
  constexpr std::size_t kPadding = 8;                  // vector loads may read behind the last point
  const Frame frame = fit_frame(sample);
  if (frame.rank < sample.dimension) return true;
  std::vector<double> coordinates(sample.rows * sample.dimension + kPadding);
  map_points(sample, frame, coordinates.data());
  GrowthWork work;
  work.rank = sample.dimension;
  work.point_count = sample.rows;
  work.points = coordinates.data();
  work.options.seed = seed;
  work.options.pause_rows = kRows * sample.dimension;
  start_growth(work, frame.simplex, FirstPoints());
  grow(work);
  std::vector<PointId> ids;
  for (std::size_t row = 0; row < sample.rows; row += 1 + sample.rows / kLookedAt)
    ids.push_back(PointId{static_cast<std::uint32_t>(row)});
  const HullBall ball = find_ball(sample.dimension, coordinates.data(), sample.rows, frame.simplex);
  const std::vector<LocatedPoint> located = try_inside(work.complex, coordinates.data(), ball, ids);
  return std::any_of(located.begin(), located.end(),
                     [](const LocatedPoint& point) { return point.gauge < -kWellInside; });
}

}  // namespace ndhull
