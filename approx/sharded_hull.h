// The hull of points that several processes hold in parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "approx/hull.h"
#include "approx/reduction/point_shards.h"
#include "approx/reduction/reduced_points.h"

namespace ndhull {

/// A hull whose points are rows of `points`, which are those of the whole set that were kept.
struct ShardedHull {
  Hull hull;
  ReducedPoints points;
};

/// The hull of some of the points in terms of all of them, which are so many: point i of it is ids[i].
void rename_points(Hull& hull, std::span<const std::uint32_t> ids, std::size_t point_count);

/// The hull of all parts. Called by all processes; the first one gets it, the others nothing.
///
/// Result    planes, facets and every number but times are those of convex_hull of the whole set, bit for
///           bit.
/// Method    all processes grow the same hull to drop points (approx/reduction/point_reduction.h), each proves
///           its own points inside; what is kept goes to the first one, which computes the hull of it.
/// Throws    Error as convex_hull does, in the first process. What a process throws on its way there leaves
///           the others waiting: the caller has to end them.
std::optional<ShardedHull> convex_hull_of_shards(const PointShards& shards, const HullOptions& options);

}  // namespace ndhull
