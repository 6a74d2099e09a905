// Large inputs: the points that the hull can depend on, found in a few passes over blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "approx/growth/begun_hull.h"
#include "approx/reduction/point_shards.h"

namespace ndhull {

/// Points from which on passes over all of them are cheaper than tables of all of them.
inline constexpr std::size_t kPointsToReduce = 100'000;

struct PointsToKeep {
  std::vector<std::uint32_t> rows;  ///< ascending, of those that this process holds
  /// The hull that the others were found to be inside of, if the whole hull can go on from it. The same in
  /// all processes.
  std::optional<BegunHull> begun;
};

/// Finds the points that are not proven to be well inside the hull of others that are kept.
///
/// Method   A hull is grown, furthest point first, from a sample and from the points that are furthest along
///          many directions. What lies inside a ball that it contains is dropped, then what is more than 1e-9
///          inside it by barycentric coordinates in one of its simplices (core/complex/membership.h). Then the points
///          that were furthest outside are added, the hull grows twice as large, and the points that are
///          left pass again.
/// Returns  All rows where the points span less than all dimensions or are not finite: then fit_frame says
///          what is to be said.
/// Proof    A dropped point lies in the hull of kept ones, more than 1e-9 of the way to the interior point
///          below its boundary: planes that bound those bound it.
/// Shards   a point's fate depends on the whole set alone: what all processes keep is the same for any parts
///          and any number of processes. All of them grow the same hull.
/// Memory   a bit a point; of mapped files blocks are given back to the system once they are read.
/// Cost     three passes at the speed of memory, and some microseconds for each point outside the ellipsoid.
/// Threads  the result does not depend on them.
PointsToKeep find_points_to_keep(const PointShards& shards, std::uint64_t seed,
                                 const std::function<bool()>& is_late);

}  // namespace ndhull
