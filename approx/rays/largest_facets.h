// The largest facets of a hull, also of one that cannot be built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "approx/rays/sample_bounds.h"
#include "core/ids.h"
#include "core/points.h"

namespace ndhull {

enum class LargestMethod {
  kAuto,  ///< the whole hull when it fits the limits, otherwise rays
  kHull,  ///< the whole hull
  kRays,  ///< rays and climbs
};
std::string_view to_string(LargestMethod method);

/// Largest number of dimensions for rays: more than that they are no longer useful for facets.
inline constexpr std::size_t kMaxRayRank = 64;

struct LargestOptions {
  std::size_t count = 100;  ///< facets wanted, the largest first
  double min_area = 0.0;    ///< [area, input units] only those at least as large
  LargestMethod method = LargestMethod::kAuto;
  std::uint64_t rays = 0;        ///< shoot exactly so many; 0: until the largest are stable
  double max_seconds = 0.0;      ///< wall clock; 0: none
  std::uint64_t max_facets = 0;  ///< simplices of the whole hull; 0: 2.5 million for kAuto, else none
  std::uint64_t machine_memory_bytes = 0;  ///< ends growth for kHull; 0: no limit
  bool bounded = false;                    ///< add further facets until the outer planes bound a region
  double confidence = 0.95;                ///< of intervals and bounds
  std::uint64_t seed = 1;                  ///< of rays
  unsigned threads = 0;                    ///< 0: all cores. The result does not depend on it.
  std::stop_token stop = {};               ///< ends the search with what was found
  /// Called from the calling thread with a few words on how far it is.
  std::function<void(std::string_view)> progress = {};
};

enum class LargestStatus {
  kComplete,   ///< the whole hull was built
  kStable,     ///< the largest facets did not change any more while further rays were shot
  kRayLimit,   ///< as many rays as wanted, or as are shot at most, were shot
  kWorkLimit,  ///< as much arithmetic as is done without a limit of the user's
  kTimeLimit,
  kFacetLimit,  ///< kHull: growth ended, the facets are those of a part of the points
  kInterrupted,
};
std::string_view to_string(LargestStatus status);

enum class FacetOrigin {
  kHull,   ///< the whole hull was built
  kRay,    ///< a uniformly random ray hit it
  kClimb,  ///< across a ridge of a larger or smaller facet
  kBound,  ///< added to bound the region
};
std::string_view to_string(FacetOrigin origin);

/// One facet, certified as those of a Hull are: distance(x) = normal . (x - reference) + centred_offset.
struct LargestFacet {
  std::vector<double> normal;  ///< unit, outward
  double offset = 0.0;         ///< [distance] at the origin: rounded
  double centred_offset = 0.0;
  double outer_offset = 0.0;  ///< [distance] >= 0: no input point is further above
  double inner_offset = 0.0;  ///< [distance] <= 0: none of its vertices is further below
  double area = 0.0;          ///< [area]
  bool area_is_whole =
      true;  ///< false: of a part of the points on its plane, which are too many for the time
  std::vector<PointId> vertices;
  FacetOrigin origin = FacetOrigin::kHull;
  std::uint64_t hits = 0;   ///< rays
  ShareInterval share;      ///< of directions; [0, 1] without rays
  std::uint64_t leads = 0;  ///< rays that led to it, by a hit or by climbs; counting ends at 3
};

/// What the rays were and what they prove. Without rays all is 0.
struct RaySample {
  std::uint64_t rays = 0;
  std::uint64_t open_rays = 0;  ///< rounding left their facet open: counted, hits of no facet
  std::uint64_t facets_hit = 0;
  std::uint64_t facets_found = 0;  ///< by rays and climbs
  std::uint64_t climbs = 0;        ///< facets whose ridges were walked over
  std::uint64_t core_points = 0;   ///< points that were above some plane on the way
  std::string_view directions;     ///< input or unit-cube: what they are uniform in
  double confidence = 0.95;
  double unseen_share = 1.0;     ///< with this confidence no facet without a hit has a larger share
  double unhit_share = 1.0;      ///< estimate of all shares without a hit together (Good, Turing)
  double facets_estimate = 0.0;  ///< lower estimate of the hull's facets, from the hits
  std::optional<double> recall;  ///< estimated part of the true largest ones among those given
  std::uint64_t led_by_one = 0, led_by_two = 0;  ///< of the facets given: what the recall is made of
};

struct LargestFacets {
  std::size_t dimension = 0, rank = 0, point_count = 0;
  LargestMethod method = LargestMethod::kHull;  ///< the one that gave the facets
  LargestStatus status = LargestStatus::kComplete;
  std::vector<double> interior_point, reference;
  std::vector<double> subspace_equations;  ///< as Hull::subspace_equations
  std::vector<LargestFacet> facets;        ///< largest first; behind `largest_count` those that bound
  std::size_t largest_count = 0;
  std::optional<bool> is_bounded;  ///< do the outer planes bound a region? Empty: no facets.
  double roundoff = 0.0;           ///< [distance] proven rounding error of a distance
  RaySample sample;
  double search_seconds = 0.0, certify_seconds = 0.0;
};

/// Finds the largest facets.
///
/// Method    See approx/rays/DESIGN.md. Every facet is proven to be one: no input point is above its outer
///           plane. What is not proven of rays is that no larger facet was missed; `sample` tells what is
///           known.
/// Returns   fewer facets than wanted when the hull has fewer, or no more were found. Rank 0: none.
/// Throws    Error as convex_hull; kDimensionTooHigh rank above kMaxRayRank, or above kMaxRank with kHull.
/// Cost      kRays: 12 rank bytes a point, 8 dimension more at the end; time see RayShooter. About 150 bytes
///           for each facet found.
LargestFacets largest_facets(const PointView& points, const LargestOptions& options = {});

}  // namespace ndhull
