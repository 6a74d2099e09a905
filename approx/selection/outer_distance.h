// How far the polytope below outer planes reaches from the hull: its furthest vertex.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "approx/hull.h"
#include "approx/polytope/plane_polytope.h"
#include "approx/work_end.h"
#include "core/points.h"

namespace ndhull {

/// A distance with bounds on both sides, or why there is none.
struct OuterDistance {
  std::optional<double> distance;  ///< [distance, input units] proven: no vertex is further than this
  double lower = 0.0;              ///< proven: one is at least this far
  std::string reason;              ///< without a distance: one line
};

/// Distance from the hull of the furthest vertex of the polytope below the certified outer planes of `facets`
/// (none: of all facets).
///
/// points   those that the hull was made from.
/// Method   A vertex v of gauge g is between its largest height above a facet and |v| (1 - 1/g) away; in the
///          order of the second the nearest points of the hull are computed (approx/geometry/hull_distance.h), until
///          no other vertex can be further. After 2,000 of them, with max_simplices perhaps fewer, the bound of the
///          rest is taken. Rounding of the vertices themselves is not part of the bounds.
/// Returns  no distance where outer_volume has no volume or would not in max_seconds (0: no limit), and with
/// max_simplices when facets times vertices
///          times rank are above 4e9.
/// Cost     as outer_volume, and facets x vertices x rank multiplications.
OuterDistance outer_distance(const Hull& hull, const PointView& points, std::span<const FacetId> facets,
                             std::uint64_t max_simplices, unsigned threads = 0,
                             const std::stop_token& stop = {}, double max_seconds = 0.0);

/// Chooses `count` facets such that no vertex of the polytope below their outer planes is far above the
/// hull's facets; it is bounded.
///
/// Method   Planes are added to rank + 1 or more that bound a region: the plane that the furthest vertex is
///          furthest above, several at once while many are missing. Up to 100 planes are exchanged one by one
///          afterwards while that brings the furthest vertex nearer. The `count` largest facets are taken
///          when they do better. Heights stand for distances: they are equal where the nearest point is
///          inside a facet, and below them elsewhere.
/// Result   ascending. More than `count` where so few bound nothing. Polytopes of more than 200,000 simplices
///          are not looked at: the largest facets make up the number then, and when `end` has come.
/// Throws   Error kUsage when count <= rank: so few planes bound nothing.
/// Cost     a hull of the chosen dual points for each round, and for each exchange two; candidates (the
///          20,000 of largest area) x vertices x rank multiplications.
std::vector<FacetId> choose_for_distance(const Hull& hull, std::size_t count, const WorkEnd& end = {});

}  // namespace ndhull
