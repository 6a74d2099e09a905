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
/// Method   A vertex v is at most |v| away, and of gauge g at most |v| (1 - 1/g). In that order the nearest points of
///          the hull are looked for (approx/geometry/hull_distance.h), of each until it is no further than
///          the furthest so far, until no other vertex can be further. Gauges are products with all facets:
///          found where these are fewer than eight times the hull's vertices. When time is up, or what
///          limits.max_facets allows, the bound of the rest is taken. Rounding of the vertices themselves is not
///          part of the bounds.
/// Returns  no distance where outer_volume has no volume, and with limits.max_facets when that would take more
///          than 5e8 multiplications.
/// Cost     as outer_volume, and for each of its vertices rank x the hull's facets or eight times its
///          vertices, whichever is less, multiplications.
OuterDistance outer_distance(const Hull& hull, const PointView& points, std::span<const FacetId> facets,
                             const Limits& limits = {}, unsigned threads = 0,
                             const std::stop_token& stop = {});

/// Chooses `count` facets such that no vertex of the polytope below their outer planes is far above the
/// hull's facets; it is bounded.
///
/// points   those that the hull was made from; null: not at hand.
/// Method   Planes are added to rank + 1 or more that bound a region: the plane that the furthest vertex is
///          furthest above, several at once while many are missing. Up to 100 planes are exchanged one by one
///          afterwards while that brings the furthest vertex nearer. So are those that enclose little
///          (approx/selection/volume_rays.h). These, those, or the `count` largest facets: whose furthest
///          vertex is nearest. Heights stand for distances, in the last comparison only without `points`:
///          they are equal where the nearest point is inside a facet, and below them elsewhere.
/// Result   ascending. More than `count` where so few bound nothing. Polytopes of more than 200,000 simplices
///          are not looked at: the largest facets make up the number then, and when `end` has come.
/// Throws   Error kUsage when count <= rank: so few planes bound nothing.
/// Cost     a hull of the chosen dual points for each round, and for each exchange two; candidates (the
///          20,000 of largest area) x vertices x rank multiplications, in exchanges of the furthest vertices
///          alone.
std::vector<FacetId> choose_for_distance(const Hull& hull, std::size_t count, const WorkEnd& end = {},
                                         const PointView* points = nullptr);

}  // namespace ndhull
