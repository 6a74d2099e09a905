#include "approx/polytope/outer_volume.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "approx/geometry/boundedness.h"
#include "approx/geometry/subspace.h"
#include "approx/polytope/plane_polytope.h"
#include "core/machine/arena.h"
#include "core/machine/blocks.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

using Eigen::Index;

// Measured on one core in 4-d to 8-d with 20 to 160 planes: 2 to 15 us for each vertex, which is a simplex of
// the dual hull and faces of all dimensions; 0.1 us for a simplex that growth made.
constexpr double kSecondsPerSimplex = 1.5e-6;
constexpr double kSecondsPerFace = 3.5e-8;
constexpr double kSecondsPerCreated = 1e-7;
constexpr double kAffordableSeconds = 0.01;
constexpr double kAffordableShare = 0.2;

/// Has the polytope of all planes more vertices than that? Tried on an even part of them, unless they are
/// few: vertices for each plane only become more with the planes, where hardly any is redundant.
bool seems_larger(const PlanesAboutOrigin& planes, std::uint64_t vertices, HullOptions options) {
  constexpr std::size_t kLargestStep = 8, kLeastStep = 4;  // one plane of so many
  constexpr std::size_t kPlanesForRank = 5;                // fewer may bound no region
  constexpr double kScatter = 1.25;                        // of the vertices of a part
  const std::size_t count = planes.heights.size();
  const std::size_t step = std::min(kLargestStep, count / (kPlanesForRank * planes.rank));
  if (step < kLeastStep) return false;
  PlanesAboutOrigin part;
  part.rank = planes.rank;
  for (std::size_t plane = 0; plane < count; plane += step) {
    const double* normal = planes.normals.data() + plane * planes.rank;
    part.normals.insert(part.normals.end(), normal, normal + planes.rank);
    part.heights.push_back(planes.heights[plane]);
  }
  options.limits.max_facets =
      static_cast<std::uint64_t>(kScatter * static_cast<double>(vertices) / static_cast<double>(step)) + 1;
  return intersect_about_origin(part, options).status == HullStatus::kFacetLimit;
}

/// Scaled by this about its interior point the hull holds what all its outer planes enclose; infinite when
/// that cannot be said.
///
/// Proof  In the cone from the interior point over one of a facet's simplices a point is t times one of the
///        simplex. That is above the inner plane, so height + inner away at least, if height is how far the
///        interior point is below the facet's plane; below the outer plane t is (height + outer) / (height +
///        inner) at most. The cones fill the space.
double scale_of_outer_polytope(const Hull& hull) {
  constexpr std::size_t kFacetsAtATime = 4096;
  std::vector<double> scales((hull.facet_count() + kFacetsAtATime - 1) / kFacetsAtATime, 1.0);
  for_each_block(hull.facet_count(), kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    double& scale = scales[begin / kFacetsAtATime];
    for (std::size_t id = begin; id < end; ++id) {
      const FacetId facet{static_cast<std::uint32_t>(id)};
      const double unit = hull.input_per_length_unit(facet);
      double height = -hull.centred_offset(facet);
      for (std::size_t k = 0; k < hull.dimension; ++k)
        height -= hull.normal(facet)[k] * (hull.interior_point[k] - hull.reference[k]);
      const double lowest = height + hull.inner_offset(facet) * unit;
      scale = lowest > 0.0 ? std::max(scale, (height + hull.outer_offset(facet) * unit) / lowest) : HUGE_VAL;
    }
  });
  double scale = 1.0;
  for (const double of_block : scales) scale = std::max(scale, of_block);
  return scale;
}

}  // namespace

// The fewest vertices of a simple polytope with so many facets: Barnette. The minimum number of vertices of a
// simple polytope. Israel Journal of Mathematics 10, 1971.
HullStatus limit_before_outer_polytope(std::size_t rank, std::size_t planes, const Limits& limits) {
  constexpr double kSecondsPerNumber = 1e-7;
  const double d = static_cast<double>(rank), count = static_cast<double>(planes);
  const double fewest = (d - 1.0) * count - (d + 1.0) * (d - 2.0);
  if (limits.max_facets > 0 && fewest > static_cast<double>(limits.max_facets))
    return HullStatus::kFacetLimit;
  if (limits.max_seconds > 0.0 && kSecondsPerNumber * d * count > limits.max_seconds)
    return HullStatus::kTimeLimit;
  return HullStatus::kComplete;
}

std::string reason_of_end(HullStatus status, const Limits& limits) {
  switch (status) {
    case HullStatus::kInterrupted: return "interrupted";
    case HullStatus::kTimeLimit: return "it would take longer than the limit on seconds";
    case HullStatus::kMemoryLimit: return "it would take more memory than there is for it";
    case HullStatus::kFacetLimit:
      return "the outer polytope has more than about " + std::to_string(limits.max_facets) + " vertices";
    case HullStatus::kComplete: break;
  }
  return "the outer planes do not bound a region";
}

PlanesAboutOrigin outer_planes_about_interior(const Hull& hull, std::span<const FacetId> facets) {
  constexpr std::size_t kFacetsAtATime = 1024;
  const Eigen::MatrixXd to_subspace =
      subspace_directions(hull.dimension, hull.subspace_equations).transpose();
  const std::size_t count = facets.empty() ? hull.facet_count() : facets.size();
  PlanesAboutOrigin planes;
  planes.rank = hull.rank;
  planes.normals.resize(count * hull.rank);
  planes.heights.resize(count);
  for_each_block(count, kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    Eigen::VectorXd inside(static_cast<Index>(hull.rank));
    for (std::size_t place = begin; place < end; ++place) {
      const FacetId facet = facets.empty() ? FacetId{static_cast<std::uint32_t>(place)} : facets[place];
      const Eigen::Map<const Eigen::VectorXd> normal(hull.normal(facet).data(),
                                                     static_cast<Index>(hull.dimension));
      inside.noalias() = to_subspace * normal;
      double height =
          hull.outer_offset(facet) * hull.input_per_length_unit(facet) - hull.centred_offset(facet);
      for (std::size_t k = 0; k < hull.dimension; ++k)
        height -= hull.normal(facet)[k] * (hull.interior_point[k] - hull.reference[k]);
      const double length = inside.norm();
      for (std::size_t k = 0; k < hull.rank; ++k)
        planes.normals[place * hull.rank + k] = inside[static_cast<Index>(k)] / length;
      planes.heights[place] = height / length;
    }
  });
  return planes;
}

OuterVolume outer_volume(const Hull& hull, std::span<const FacetId> facets, const Limits& limits,
                         unsigned threads, const std::stop_token& stop) {
  if (hull.rank == 0) return {0.0, ""};
  const Clock::time_point start = Clock::now();
  constexpr double kNarrow = 1.0 + 1e-10;
  tbb::task_arena arena = arena_of(threads);
  const double scale =
      facets.empty() ? arena.execute([&] { return scale_of_outer_polytope(hull); }) : HUGE_VAL;
  const double most = hull.volume * std::pow(scale, static_cast<double>(hull.rank));
  const OuterVolume beyond{std::nullopt, "it is beyond the range of doubles"};
  if (scale <= kNarrow) return is_in_range(most) ? OuterVolume{most, ""} : beyond;
  const auto none = [&limits](HullStatus status) {
    return OuterVolume{std::nullopt, reason_of_end(status, limits)};
  };
  const std::size_t count = facets.empty() ? hull.facet_count() : facets.size();
  const HullStatus before = limit_before_outer_polytope(hull.rank, count, limits);
  if (before != HullStatus::kComplete) return none(before);
  const PlanesAboutOrigin planes = outer_planes_about_interior(hull, facets);
  for (const double height : planes.heights) {
    if (!(height > 0.0)) return {std::nullopt, "the interior point is not below every outer plane"};
  }
  if (!facets.empty() && !find_open_direction(planes.normals, planes.rank).bounded)
    return none(HullStatus::kComplete);
  HullOptions options;
  options.wants_partial = false;
  options.limits = limits;
  options.threads = threads;
  options.stop = stop;
  const auto spend_time = [&] {
    if (limits.max_seconds > 0.0)
      options.limits.max_seconds = std::max(limits.max_seconds - seconds_since(start), 1e-9);
  };
  spend_time();
  if (limits.max_facets > 0 && seems_larger(planes, limits.max_facets, options))
    return none(HullStatus::kFacetLimit);
  spend_time();
  const PlanePolytope polytope = intersect_about_origin(planes, options);
  if (polytope.status != HullStatus::kComplete || !polytope.bounded) return none(polytope.status);
  spend_time();
  const PolytopeMeasure measure = measure_polytope(planes, polytope, options, false);
  if (measure.status != HullStatus::kComplete) return none(measure.status);
  // Of a hull hardly thicker than rounding the planes' polytope is measured badly: bounds hold all the same.
  const double volume = std::max(hull.volume, std::min(most, measure.volume));
  return is_in_range(volume) ? OuterVolume{volume, ""} : beyond;
}

std::uint64_t affordable_simplices(const Hull& hull, const Limits& limits) {
  const double growth = kSecondsPerCreated * static_cast<double>(hull.statistics.created_simplices);
  const double faces = std::ldexp(1.0, static_cast<int>(hull.rank));  // of all dimensions, at a vertex
  double simplices = std::max(kAffordableSeconds, kAffordableShare * growth) /
                     (kSecondsPerSimplex + kSecondsPerFace * faces);
  if (limits.max_memory_bytes > 0) {
    // As with growth, the tables of the dual hull as well.
    const double bytes = bytes_of_measure(hull.rank, 1) + 32.0 * static_cast<double>(hull.rank);
    simplices = std::min(simplices, static_cast<double>(limits.max_memory_bytes) / bytes);
  }
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(simplices));
}

}  // namespace ndhull
