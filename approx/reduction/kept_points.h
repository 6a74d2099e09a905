// A few vertices whose hull is nearly the whole hull: the approximate hull where facets make no sense any
// more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/points.h"

namespace ndhull {

/// Vertices in the order they were chosen, those given first.
struct KeptPoints {
  std::vector<PointId> points;
  /// [distance, input units] Proven, roundoff included; none rises. One for each vertex that was chosen: with
  /// the first k of these, and those given, every input point is within distances[k - 1] of their hull.
  std::vector<double> distances;
  double lower = 0.0;  ///< [distance] proven: some input point is at least so far from the final hull
  /// [distance] of each of the vertices given, proven: no further from the final hull. Those that are kept:
  /// 0.
  std::vector<double> left;
};

struct KeepOptions {
  std::size_t count = 100;  ///< vertices wanted, those given among them; one is chosen in any case
  std::size_t given = 0;    ///< so many of the vertices, the first ones, are kept from the beginning
  double enough = 0.0;  ///< [distance] vertices no further from the hull are not looked at again, nor kept
  bool measures_left = false;  ///< KeptPoints::left are those of the final hull, no larger than they must be
  std::stop_token stop = {};
  std::function<void(std::string_view)> progress = {};  ///< called from the calling thread
};

/// Chooses vertices greedily: first those given, or the one furthest from `centre`, then again and again the
/// one furthest from the hull of those chosen, until there are enough or none is outside.
///
/// vertices  of all the points (extreme_points): the distance from a hull is a convex function, so no point
///           is further from it than the furthest vertex, but for the rounding that decided what is a vertex,
///           which is added.
/// Shapes    centre: a number a column, of a point inside. Throws Error kUsage for another length, for more
///           given than there are vertices, and for `enough` that is no number.
/// Returns   fewer than wanted when fewer make the whole hull, or a stop was requested; none of no vertices.
/// Not promised  that no other vertices would be nearer: greedy choices are good, not best.
/// Source    lazy evaluation of distances that can only fall, as in Minoux. Accelerated greedy algorithms.
///           1978.
/// Cost      count x vertices x dimension for marking, and some hull_distance calls a choice, in parallel.
KeptPoints keep_points(const PointView& points, std::span<const PointId> vertices,
                       std::span<const double> centre, const KeepOptions& options);

/// Proven upper bounds of the distance of every input point from the hull of some points, one or more;
/// `centre` as above.
/// Cost  one hull_distance call a point, in parallel.
std::vector<double> distances_from_hull(const PointView& points, std::span<const PointId> hull,
                                        std::span<const double> centre);

}  // namespace ndhull
