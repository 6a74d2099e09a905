#include "approx/slab_growth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/dimension_switch.h"

namespace ndhull {
namespace {

/// Simplices from which on turning a slab and growing it again is worth its time: smaller ones gain 1 to 5 %.
constexpr std::size_t kWorthTurning = 64;
/// A slab that has so many simplices meets most of the points, if these are few: then all products are
/// computed at once, and nothing is asked of each.
constexpr std::size_t kManyGrown = 64, kFewRows = 4096;

}  // namespace

SlabGrower::SlabGrower(const SimplicialComplex& complex, const WidthSpace& space, const SimplexRule* rule,
                       bool is_convex)
    : complex_(complex), space_(space), rule_(rule), is_convex_(is_convex) {}

// Is a neighbour's own vertex so near below the plane of the seed that a turned plane may hold both? Fitting
// turns a plane by about half the depth at most, so 2.5 widths are generous. Most simplices of a fine hull
// stay alone, and this is all they cost.
bool SlabGrower::may_extend(std::uint32_t seed, const double* normal, double width) const {
  const double* on_plane = space_.row(space_.row_of(complex_.vertices(SimplexId{seed})[0]));
  for (const SimplexId neighbour : complex_.neighbours(SimplexId{seed})) {
    const auto back = complex_.neighbours(neighbour);
    const auto slot =
        static_cast<std::size_t>(std::find(back.begin(), back.end(), SimplexId{seed}) - back.begin());
    const double* apex = space_.row(space_.row_of(complex_.vertices(neighbour)[slot]));
    double depth = 0.0;
    for (std::size_t k = 0; k < complex_.rank; ++k) depth += normal[k] * (on_plane[k] - apex[k]);
    if (depth < 2.5 * width) return true;
  }
  return false;
}

/// Gathers in scratch.grown and scratch.depths the simplices around the seed whose vertices are all less than
/// `width` below the plane. None when the seed is not among them.
void SlabGrower::flood(std::uint32_t seed, const FittedPlane& plane, double width,
                       SlabScratch& scratch) const {
  call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) { flood_in<d>(seed, plane, width, scratch); });
}

template <std::size_t D>
void SlabGrower::flood_in(std::uint32_t seed, const FittedPlane& plane, double width,
                          SlabScratch& scratch) const {
  const double least = plane.height - kDepthRoom * width;
  const auto vertices_of_row = [this](std::uint32_t row) {
    return complex_.topology.data() + std::size_t{row} * 2 * D;
  };
  const auto mix_of = [](const std::uint32_t* vertices) {
    std::uint32_t mix = 0;
    for (std::size_t k = 0; k < D; ++k) mix ^= vertices[k];
    return mix;
  };
  const auto take = [&](std::uint32_t simplex, const auto& height_of) {
    double low = HUGE_VAL, sum = 0.0;
    for (std::size_t k = 0; k < D; ++k) {
      const double height = height_of(vertices_of_row(simplex)[k]);
      low = std::min(low, height);
      sum += height;
    }
    if (low < least) return;
    if (rule_ != nullptr && simplex != seed &&
        !rule_->wants(SimplexId{simplex}, sum / double{D}, scratch.compared, scratch.rule_fit))
      return;
    scratch.grown.push_back(simplex);
    scratch.depths.push_back(rounded_up_depth(std::max(0.0, plane.height - low)));
    for (std::size_t k = D; k < 2 * D; ++k) {  // neighbours: they are met next, or soon
      const std::uint32_t next = vertices_of_row(simplex)[k];
      __builtin_prefetch(scratch.stamp.data() + next, 1);
      __builtin_prefetch(vertices_of_row(next));
    }
  };
  std::size_t next_grown = 0;
  const auto spread = [&](std::size_t enough, const auto& height_of) {
    for (; next_grown < scratch.grown.size() && scratch.grown.size() < enough; ++next_grown) {
      const std::uint32_t* vertices = vertices_of_row(scratch.grown[next_grown]);
      const std::uint32_t mix = mix_of(vertices);
      for (std::size_t k = 0; k < D; ++k) {
        const std::uint32_t next = vertices[D + k];
        if (scratch.stamp[next] == scratch.flood) continue;
        scratch.stamp[next] = scratch.flood;
        // All its vertices are this one's too, but for the one across the ridge.
        const std::uint32_t apex = mix ^ vertices[k] ^ mix_of(vertices_of_row(next));
        if (!(height_of(apex) < least)) take(next, height_of);
      }
    }
  };
  const std::uint32_t pass = ++scratch.vertex_pass;
  const auto height_when_asked = [&](std::uint32_t vertex) {
    const std::uint32_t row = space_.row_of(PointId{vertex});
    if (scratch.vertex_stamp[row] != pass) {
      scratch.vertex_stamp[row] = pass;
      scratch.dots[row] = dot_of(plane.normal.data(), row);
    }
    return scratch.dots[row];
  };
  scratch.grown.clear();
  scratch.depths.clear();
  if (rule_ != nullptr) rule_->set_plane(SimplexId{seed}, plane, scratch.compared);
  ++scratch.flood;
  scratch.stamp[seed] = scratch.flood;
  take(seed, height_when_asked);
  const std::size_t count = space_.table().count();
  if (count > kFewRows) return spread(SIZE_MAX, height_when_asked);
  spread(kManyGrown, height_when_asked);
  if (next_grown == scratch.grown.size()) return;
  for (std::uint32_t row = 0; row < count; ++row) scratch.dots[row] = dot_of(plane.normal.data(), row);
  spread(SIZE_MAX, [&](std::uint32_t vertex) { return scratch.dots[space_.row_of(PointId{vertex})]; });
}

std::span<const std::uint32_t> SlabGrower::vertices_of(std::span<const std::uint32_t> members,
                                                       SlabScratch& scratch) const {
  scratch.vertices.clear();
  ++scratch.vertex_pass;
  for (const std::uint32_t simplex : members) {
    for (const PointId id : complex_.vertices(SimplexId{simplex})) {
      const std::uint32_t row = space_.row_of(id);
      if (scratch.vertex_stamp[row] == scratch.vertex_pass) continue;
      scratch.vertex_stamp[row] = scratch.vertex_pass;
      scratch.vertices.push_back(row);
    }
  }
  return scratch.vertices;
}

double SlabGrower::dot_of(const double* normal, std::uint32_t row) const {
  const double* z = space_.row(row);
  double sum = 0.0;
  for (std::size_t k = 0; k < complex_.rank; ++k) sum += normal[k] * z[k];
  return sum;
}

/// Where the hull is convex the seed's own plane supports it, and a flood needs the products of few vertices.
void SlabGrower::flood_from_own_plane(GrownSlab& slab, double width, SlabScratch& scratch) const {
  slab.plane.height = -HUGE_VAL;
  for (const PointId id : complex_.vertices(SimplexId{slab.seed})) {
    const std::uint32_t row = space_.row_of(id);
    const double dot = dot_of(slab.plane.normal.data(), row);
    if (dot <= slab.plane.height) continue;
    slab.plane.height = dot;
    slab.plane.highest = row;
  }
  flood(slab.seed, slab.plane, width, scratch);
}

void SlabGrower::measure(FittedPlane& plane, SlabScratch& scratch) const {
  plane = measure_plane(space_, plane.normal, {}, scratch.fit);
  plane.low = 0.0;
}

/// The plane that makes the seed narrowest where points are above it, and what lies below that.
void SlabGrower::flood_from_fitted_plane(GrownSlab& slab, double width, const CoverEffort& effort,
                                         SlabScratch& scratch) const {
  const std::uint32_t alone[] = {slab.seed};
  const std::span<const std::uint32_t> vertices = vertices_of(alone, scratch);
  slab.plane = measure_plane(space_, slab.plane.normal, vertices, scratch.fit);
  if (rule_ != nullptr) rule_->learn_height(SimplexId{slab.seed}, slab.plane.height);
  if (slab.plane.width() > width)
    slab.plane = narrow_plane(space_, slab.plane, vertices, 4 * effort.fit_steps, scratch.fit);
  slab.depths.assign(1, rounded_up_depth(std::max(0.0, slab.plane.width())));
  flood(slab.seed, slab.plane, width, scratch);
}

void SlabGrower::grow(GrownSlab& slab, double width, const CoverEffort& effort, SlabScratch& scratch) const {
  slab.plane.normal.resize(complex_.rank);
  space_.normal_of(complex_.plane(SimplexId{slab.seed}), slab.plane.normal.data());
  slab.plane.height = slab.plane.low = 0.0;
  slab.members.assign(1, slab.seed);
  slab.depths.assign(1, 0.0f);
  bool is_measured = false;
  if (is_convex_) {
    flood_from_own_plane(slab, width, scratch);
  } else {
    if (!may_extend(slab.seed, slab.plane.normal.data(), width)) return;
    flood_from_fitted_plane(slab, width, effort, scratch);
    is_measured = true;
  }
  if (scratch.grown.size() > 1) {
    slab.members.swap(scratch.grown);
    slab.depths.swap(scratch.depths);
  } else if (is_convex_) {
    slab.plane.height = 0.0;
  }
  if (slab.members.size() < (effort.refits <= 1 ? kWorthTurning : 2)) return;
  if (!is_measured) measure(slab.plane, scratch);
  for (unsigned refit = 0; refit < effort.refits; ++refit) {
    const std::span<const std::uint32_t> vertices = vertices_of(slab.members, scratch);
    FittedPlane turned = slab.plane;
    turned.low = lowest_dot(space_, turned.normal, vertices);
    turned = narrow_plane(space_, turned, vertices, effort.fit_steps, scratch.fit);
    flood(slab.seed, turned, width, scratch);
    if (scratch.grown.size() <= slab.members.size()) break;
    slab.plane = std::move(turned);
    slab.members.swap(scratch.grown);
    slab.depths.swap(scratch.depths);
  }
}

}  // namespace ndhull
