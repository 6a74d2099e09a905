#include "approx/rays/frame_centre.h"

#include <algorithm>
#include <cmath>

#include "approx/rays/direction_scan.h"
#include "core/linear/simplex_planes.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

constexpr std::size_t kDirections = 128;
constexpr std::uint64_t kSeed = 1;

}  // namespace

double inner_radius(const FramePoints& points, std::span<const PointId> simplex) {
  double longest = 0.0;  // dual vertex of the simplex: one over the distance of the nearest facet from 0
  for (const Eigen::VectorXd& plane : simplex_planes(points.coordinates, points.rank, simplex))
    longest = std::max(longest, plane.norm());
  return 1.0 / longest;
}

std::vector<std::uint32_t> furthest_along_directions(const FramePoints& points, std::size_t count) {
  ScanTiles tiles(points.rank);
  tiles.reserve(count);
  for (std::uint32_t id = 0; id < count; ++id) tiles.append(points.row(id), id);
  PortableRandom random(kSeed);
  std::vector<float> directions;
  std::vector<double> direction(points.rank);
  for (std::size_t one = 0; one < kDirections; ++one) {
    double length_sq = 0.0;
    for (double& x : direction) {
      x = random.normal();
      length_sq += x * x;
    }
    for (const double sign : {1.0, -1.0})
      for (const double x : direction)
        directions.push_back(static_cast<float>(sign * x / std::sqrt(length_sq)));
  }
  std::vector<DirectionQuery> queries(2 * kDirections);
  scan_directions_in_parallel(tiles, directions, queries);
  std::vector<std::uint32_t> furthest;
  for (const DirectionQuery& query : queries) furthest.push_back(query.furthest);
  return furthest;
}

}  // namespace ndhull
