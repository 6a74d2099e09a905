// The driver.
//   1 look      a few hundred rays: is the hull one that can be built?
//   2 hull      kAuto: tried within limits; kHull: built
//   3 search    approx/rays/facet_search      rounds of rays and climbs until the largest facets are stable
//   4 bound     approx/geometry/boundedness       rays along open directions until the planes bound a region
//   5 certify   approx/rays/plane_certificate every point below every plane
//   6 sample    approx/rays/sample_bounds     what the rays prove
#include "approx/rays/largest_facets.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "approx/geometry/boundedness.h"
#include "approx/geometry/frame_planes.h"
#include "approx/hull.h"
#include "approx/rays/facet_search.h"
#include "approx/rays/largest_search.h"
#include "approx/rays/plane_certificate.h"
#include "core/error.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

/// What kAuto spends on the whole hull: at most some seconds and a gigabyte.
constexpr std::uint64_t kAutoFacets = 2'500'000;
constexpr std::uint64_t kAutoMemory = std::uint64_t{1} << 30;
/// Share of a time limit that a hull which may not be finished gets.
constexpr double kHullShareOfTime = 0.5;

LargestStatus status_of(HullStatus status) {
  switch (status) {
    case HullStatus::kComplete: return LargestStatus::kComplete;
    case HullStatus::kFacetLimit:
    case HullStatus::kMemoryLimit: return LargestStatus::kFacetLimit;
    case HullStatus::kTimeLimit: return LargestStatus::kTimeLimit;
    case HullStatus::kInterrupted: return LargestStatus::kInterrupted;
  }
  return LargestStatus::kComplete;
}

LargestFacet facet_of(const Hull& hull, FacetId id, FacetOrigin origin) {
  LargestFacet facet;
  const auto normal = hull.normal(id);
  facet.normal.assign(normal.begin(), normal.end());
  facet.offset = hull.offset(id);
  facet.centred_offset = hull.centred_offset(id);
  facet.outer_offset = hull.outer_offset(id);
  facet.inner_offset = hull.inner_offset(id);
  facet.area = hull.area_of(id);
  const auto vertices = hull.vertices_of(id);
  facet.vertices.assign(vertices.begin(), vertices.end());
  std::sort(facet.vertices.begin(), facet.vertices.end());
  facet.origin = origin;
  return facet;
}

/// The answer from a hull that is there.
void take_from_hull(const Hull& hull, const LargestOptions& options, LargestFacets& result) {
  result.method = LargestMethod::kHull;
  result.status = status_of(hull.status);
  result.dimension = hull.dimension;
  result.rank = hull.rank;
  result.interior_point = hull.interior_point;
  result.reference = hull.reference;
  result.subspace_equations = hull.subspace_equations;
  result.roundoff = hull.roundoff;
  std::vector<std::uint32_t> order(hull.facet_count());
  std::iota(order.begin(), order.end(), 0);
  const auto kept = order.begin() + static_cast<std::ptrdiff_t>(std::min(options.count, order.size()));
  std::partial_sort(order.begin(), kept, order.end(), [&hull](std::uint32_t a, std::uint32_t b) {
    const double area_a = hull.area_of(FacetId{a}), area_b = hull.area_of(FacetId{b});
    return area_a != area_b ? area_a > area_b : a < b;
  });
  order.erase(kept, order.end());
  std::erase_if(order, [&](std::uint32_t id) { return hull.area_of(FacetId{id}) < options.min_area; });
  for (const std::uint32_t id : order) {
    result.facets.push_back(facet_of(hull, FacetId{id}, FacetOrigin::kHull));
  }
  result.largest_count = order.size();
  if (!options.bounded || hull.facet_count() == 0) return;
  std::vector<double> normals;
  normals.reserve(hull.facet_count() * hull.dimension);
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
    const auto normal = hull.normal(FacetId{id});
    normals.insert(normals.end(), normal.begin(), normal.end());
  }
  for (const std::uint32_t id :
       complete_to_bounded(normals, hull.dimension, order, hull.subspace_equations)) {
    result.facets.push_back(facet_of(hull, FacetId{id}, FacetOrigin::kBound));
  }
}

/// The whole hull, or nothing when kAuto's limits end it.
bool try_hull(const PointView& points, const LargestOptions& options, Clock::time_point start,
              LargestFacets& result) {
  const bool must = options.method == LargestMethod::kHull;
  HullOptions hull_options;
  hull_options.threads = options.threads;
  hull_options.stop = options.stop;
  hull_options.limits.max_facets = options.max_facets;
  if (!must && options.max_facets == 0) hull_options.limits.max_facets = kAutoFacets;
  hull_options.limits.max_memory_bytes = must ? options.machine_memory_bytes : kAutoMemory;
  if (options.max_seconds > 0.0) {
    const double left = std::max(options.max_seconds - seconds_since(start), 1e-3);
    hull_options.limits.max_seconds = must ? left : kHullShareOfTime * left;
  }
  if (options.progress) {
    hull_options.progress = [&options](const Progress& now) {
      options.progress("hull: " + std::to_string(now.simplices) + " facets, " +
                       std::to_string(now.points_left) + " points left");
    };
  }
  const double before = seconds_since(start);
  const Hull hull = convex_hull(points, hull_options);
  if (!must && hull.status != HullStatus::kComplete) return false;
  result.search_seconds = before + hull.statistics.seconds[static_cast<std::size_t>(Phase::kGrowth)];
  take_from_hull(hull, options, result);
  return true;
}

void decide_boundedness(LargestFacets& result) {
  if (result.facets.empty()) return;
  std::vector<double> normals;
  for (const LargestFacet& facet : result.facets) {
    normals.insert(normals.end(), facet.normal.begin(), facet.normal.end());
  }
  result.is_bounded = find_open_direction(normals, result.dimension, result.subspace_equations).bounded;
}

}  // namespace

std::string_view to_string(LargestMethod method) {
  switch (method) {
    case LargestMethod::kAuto: return "auto";
    case LargestMethod::kHull: return "hull";
    case LargestMethod::kRays: return "rays";
  }
  return "unknown";
}

std::string_view to_string(LargestStatus status) {
  switch (status) {
    case LargestStatus::kComplete: return "complete";
    case LargestStatus::kStable: return "stable";
    case LargestStatus::kRayLimit: return "ray_limit";
    case LargestStatus::kWorkLimit: return "work_limit";
    case LargestStatus::kTimeLimit: return "time_limit";
    case LargestStatus::kFacetLimit: return "facet_limit";
    case LargestStatus::kInterrupted: return "interrupted";
  }
  return "unknown";
}

std::string_view to_string(FacetOrigin origin) {
  switch (origin) {
    case FacetOrigin::kHull: return "hull";
    case FacetOrigin::kRay: return "ray";
    case FacetOrigin::kClimb: return "climb";
    case FacetOrigin::kBound: return "bound";
  }
  return "unknown";
}

LargestFacets largest_facets(const PointView& points, const LargestOptions& options) {
  const Clock::time_point start = Clock::now();
  LargestFacets result;
  check_shape(points);
  result.point_count = points.rows;
  tbb::task_arena arena = arena_of(options.threads);
  arena.execute([&] {
    bool is_done = options.method == LargestMethod::kHull && try_hull(points, options, start, result);
    if (!is_done) {
      RayShooter shooter(points);
      check_extents(shooter.frame());
      const std::size_t rank = shooter.frame().rank;
      if (rank < 2) {
        LargestOptions whole = options;
        whole.method = LargestMethod::kHull;
        is_done = try_hull(points, whole, start, result);
      } else {
        LargestSearch search(shooter, options, start);
        search.look();
        is_done = options.method == LargestMethod::kAuto && search.may_be_built(kAutoFacets) &&
                  try_hull(points, options, start, result);
        if (!is_done) search.run(result);
        if (!is_done) result.search_seconds = seconds_since(start);
        if (!is_done) search.certify(points, result);
      }
    }
    decide_boundedness(result);
  });
  result.certify_seconds = seconds_since(start) - result.search_seconds;
  return result;
}

}  // namespace ndhull
