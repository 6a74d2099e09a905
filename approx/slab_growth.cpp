#include "approx/slab_growth.h"

#include <algorithm>
#include <cmath>

namespace ndhull {
namespace {

/// Simplices from which on turning a slab and growing it again is worth its time: smaller ones gain 1 to 5 %.
constexpr std::size_t kWorthTurning = 64;
/// Numbers that are multiplied with a direction faster than the few that a small slab needs are picked out.
constexpr std::size_t kFewProducts = 4096;
constexpr float kOutside = -1.0f;

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
template <typename DotOf>
void SlabGrower::flood(std::uint32_t seed, const FittedPlane& plane, double width, SlabScratch& scratch,
                       const DotOf& dot_of) const {
  const double least = plane.height - kDepthRoom * width;
  const auto depth_of = [&](std::uint32_t simplex) {
    double low = HUGE_VAL;
    for (const PointId id : complex_.vertices(SimplexId{simplex})) {
      const double dot = dot_of(space_.row_of(id));
      if (dot < least) return kOutside;
      low = std::min(low, dot);
    }
    return rounded_up_depth(std::max(0.0, plane.height - low));
  };
  const auto meet = [&](std::uint32_t simplex) {
    scratch.stamp[simplex] = scratch.flood;
    const float depth = depth_of(simplex);
    if (depth == kOutside) return;
    if (rule_ != nullptr && simplex != seed && !rule_->wants(SimplexId{simplex}, plane, scratch.seed_centre))
      return;
    scratch.grown.push_back(simplex);
    scratch.depths.push_back(depth);
    for (const SimplexId next : complex_.neighbours(SimplexId{simplex})) {  // they are met next, or soon
      __builtin_prefetch(scratch.stamp.data() + next.value, 1);
      __builtin_prefetch(complex_.topology.data() + std::size_t{next.value} * 2 * complex_.rank);
    }
  };
  scratch.grown.clear();
  scratch.depths.clear();
  if (rule_ != nullptr) scratch.seed_centre = rule_->centrum_on(SimplexId{seed}, plane);
  ++scratch.flood;
  meet(seed);
  for (std::size_t i = 0; i < scratch.grown.size(); ++i) {
    for (const SimplexId neighbour : complex_.neighbours(SimplexId{scratch.grown[i]}))
      if (scratch.stamp[neighbour.value] != scratch.flood) meet(neighbour.value);
  }
}

/// The same for a plane that was measured last.
void SlabGrower::flood_measured(std::uint32_t seed, const FittedPlane& plane, double width,
                                SlabScratch& scratch) const {
  if (space_.is_large()) return flood_unmeasured(seed, plane, width, scratch);
  const double* dots = scratch.fit.dots.data();
  flood(seed, plane, width, scratch, [dots](std::uint32_t row) { return dots[row]; });
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

void SlabGrower::flood_unmeasured(std::uint32_t seed, const FittedPlane& plane, double width,
                                  SlabScratch& scratch) const {
  const double* normal = plane.normal.data();
  flood(seed, plane, width, scratch, [&](std::uint32_t row) { return dot_of(normal, row); });
}

/// Where the hull is convex the seed's own plane supports it, and a flood needs the products of few vertices.
void SlabGrower::flood_from_own_plane(GrownSlab& slab, double width, SlabScratch& scratch) const {
  slab.plane.height = -HUGE_VAL;
  for (const PointId id : complex_.vertices(SimplexId{slab.seed}))
    slab.plane.height = std::max(slab.plane.height, dot_of(slab.plane.normal.data(), space_.row_of(id)));
  flood_unmeasured(slab.seed, slab.plane, width, scratch);
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
  if (slab.plane.width() > width)
    slab.plane = narrow_plane(space_, slab.plane, vertices, 4 * effort.fit_steps, scratch.fit);
  slab.depths.assign(1, rounded_up_depth(std::max(0.0, slab.plane.width())));
  flood_measured(slab.seed, slab.plane, width, scratch);
}

void SlabGrower::grow(GrownSlab& slab, double width, const CoverEffort& effort, SlabScratch& scratch) const {
  slab.plane.normal.resize(complex_.rank);
  space_.normal_of(complex_.plane(SimplexId{slab.seed}), slab.plane.normal.data());
  slab.plane.height = slab.plane.low = 0.0;
  slab.members.assign(1, slab.seed);
  slab.depths.assign(1, 0.0f);
  bool is_measured = false;
  if (is_convex_ && space_.table().padded_count() * complex_.rank > kFewProducts) {
    flood_from_own_plane(slab, width, scratch);
  } else if (is_convex_) {
    measure(slab.plane, scratch);
    flood_measured(slab.seed, slab.plane, width, scratch);
    is_measured = true;
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
    turned.low = HUGE_VAL;
    for (const std::uint32_t row : vertices) {
      const double dot = space_.is_large() ? dot_of(turned.normal.data(), row) : scratch.fit.dots[row];
      turned.low = std::min(turned.low, dot);
    }
    turned = narrow_plane(space_, turned, vertices, effort.fit_steps, scratch.fit);
    flood_measured(slab.seed, turned, width, scratch);
    if (scratch.grown.size() <= slab.members.size()) break;
    slab.plane = std::move(turned);
    slab.members.swap(scratch.grown);
    slab.depths.swap(scratch.depths);
  }
}

}  // namespace ndhull
