#include "approx/slabs/slab_growth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/dimension_switch.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

/// Simplices from which on turning a slab and growing it again is worth its time: smaller ones gain 1 to 5 %.
constexpr std::size_t kWorthTurning = 64;
/// So few points that each slab that is turned may compute its products with all of them.
constexpr std::size_t kFewRows = 4096;

}  // namespace

SlabScratch::SlabScratch(const WidthSpace& space)
    : vertex_stamp(space.table().count(), 0), dots(space.table().count()) {}

void SlabScratch::prepare(const SimplicialComplex& complex, const WidthSpace& space) {
  if (!met.empty()) return;
  met.resize(complex.row_count);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    for (const PointId id : complex.vertices(SimplexId{row})) met[row].mix ^= space.row_of(id);
  }
}

void SlabScratch::make_room(std::size_t count) {
  if (count <= grown.size()) return;
  grown.resize(std::max(count, 2 * grown.size()));
  depths.resize(grown.size());
}

void SlabScratch::copy_grown(GrownSlab& slab) const {
  slab.members.assign(grown.data(), grown.data() + grown_count);
  slab.depths.assign(depths.data(), depths.data() + grown_count);
}

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

/// Gathers in scratch.grown and scratch.depths the scratch.grown_count simplices around the seed whose
/// vertices are all less than `width` below the plane: all of them, or the first `enough`. None when the seed
/// is not among them. Products that have scratch.vertex_pass already are taken as they are.
void SlabGrower::flood(std::uint32_t seed, const FittedPlane& plane, double width, std::size_t enough,
                       SlabScratch& scratch) const {
  scratch.prepare(complex_, space_);
  call_with_dimension<2, kMaxRank>(complex_.rank,
                                   [&](auto d) { flood_in<d>(seed, plane, width, enough, scratch); });
}

// Branches on what a neighbour is are not to be foreseen, so there is one for each simplex: those that were
// not met yet are listed first, then each is written behind what was taken, and stays there or not.
template <std::size_t D>
void SlabGrower::flood_in(std::uint32_t seed, const FittedPlane& plane, double width, std::size_t enough,
                          SlabScratch& scratch) const {
  constexpr std::size_t kAhead = 2, kFarAhead = 6;  // simplices whose neighbours', whose rows are asked for
  const double least = plane.height - kDepthRoom * width;
  const std::uint32_t pass = scratch.vertex_pass, flood = ++scratch.flood;
  MetSimplex* const met = scratch.met.data();
  std::uint32_t* const stamps = scratch.vertex_stamp.data();
  double* const dots = scratch.dots.data();
  const auto height_of = [&](std::uint32_t row) {
    if (stamps[row] != pass) {
      stamps[row] = pass;
      dots[row] = dot_of(plane.normal.data(), row);
    }
    return dots[row];
  };
  const auto depth_of = [&](double low) { return rounded_up_depth(std::max(0.0, plane.height - low)); };
  const auto row_of = [this](std::uint32_t vertex) { return space_.row_of(PointId{vertex}); };
  const std::uint32_t* const topology = complex_.topology.data();
  const auto is_wanted = [&](std::uint32_t simplex) {
    double sum = 0.0;
    for (std::size_t k = 0; k < D; ++k) sum += height_of(row_of(topology[std::size_t{simplex} * 2 * D + k]));
    return rule_->wants(SimplexId{simplex}, sum / double{D}, scratch.compared, scratch.rule_fit);
  };
  const auto ask_for_row = [&](std::uint32_t simplex) {
    prefetch(topology + std::size_t{simplex} * 2 * D, 2 * D);
  };
  scratch.grown_count = 0;
  if (rule_ != nullptr) rule_->set_plane(SimplexId{seed}, plane, scratch.compared);
  met[seed].flood = flood;
  double low_of_seed = HUGE_VAL;
  for (std::size_t k = 0; k < D; ++k)
    low_of_seed = std::min(low_of_seed, height_of(row_of(topology[std::size_t{seed} * 2 * D + k])));
  if (low_of_seed < least) return;
  scratch.make_room(D + 1);
  scratch.grown[0] = seed;
  scratch.depths[0] = depth_of(low_of_seed);
  std::size_t count = 1;
  for (std::size_t i = 0; i < count && count < enough; ++i) {
    scratch.make_room(count + D);
    std::uint32_t* const grown = scratch.grown.data();
    float* const depths = scratch.depths.data();
    const std::uint32_t* const vertices = topology + std::size_t{grown[i]} * 2 * D;
    if (i + kAhead < count) {
      const std::uint32_t* later = topology + std::size_t{grown[i + kAhead]} * 2 * D;
      for (std::size_t k = 0; k < D; ++k) prefetch(met + later[D + k]);
    }
    if (i + kFarAhead < count) ask_for_row(grown[i + kFarAhead]);
    const std::size_t known = count;
    std::uint32_t rows[D], mix = 0;
    double heights[D], low = HUGE_VAL, second = HUGE_VAL;
    for (std::size_t k = 0; k < D; ++k) {
      rows[k] = row_of(vertices[k]);
      mix ^= rows[k];
      heights[k] = height_of(rows[k]);
      second = std::min(second, std::max(low, heights[k]));
      low = std::min(low, heights[k]);
    }
    std::uint32_t fresh[D], opposite[D];
    std::size_t fresh_count = 0;
    for (std::size_t k = 0; k < D; ++k) {
      const MetSimplex neighbour = met[vertices[D + k]];
      fresh[fresh_count] = static_cast<std::uint32_t>(k);
      // All its vertices are this one's too, but for the one across the ridge.
      opposite[fresh_count] = mix ^ rows[k] ^ neighbour.mix;
      fresh_count += neighbour.flood != flood ? 1u : 0u;
    }
    for (std::size_t f = 0; f < fresh_count; ++f) {
      const std::size_t k = fresh[f];
      const std::uint32_t next = vertices[D + k];
      met[next].flood = flood;
      const double height = height_of(opposite[f]);
      bool is_taken = height >= least;
      if (rule_ != nullptr && is_taken) is_taken = is_wanted(next);
      grown[count] = next;
      depths[count] = depth_of(std::min(height, heights[k] == low ? second : low));
      count += is_taken ? 1u : 0u;
    }
    if (known <= i + kFarAhead)
      for (std::size_t taken = known; taken < count; ++taken) ask_for_row(grown[taken]);
  }
  scratch.grown_count = count;
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

bool SlabGrower::meets_all_points() const { return space_.table().count() <= kFewRows; }

/// Where the hull is convex the seed's own plane supports it, and a flood needs the products of few vertices.
void SlabGrower::set_own_plane(GrownSlab& slab) const {
  slab.plane.height = -HUGE_VAL;
  for (const PointId id : complex_.vertices(SimplexId{slab.seed})) {
    const std::uint32_t row = space_.row_of(id);
    const double dot = dot_of(slab.plane.normal.data(), row);
    if (dot <= slab.plane.height) continue;
    slab.plane.height = dot;
    slab.plane.highest = row;
  }
}

void SlabGrower::measure(FittedPlane& plane, SlabScratch& scratch) const {
  plane = measure_plane(space_, plane.normal, {}, scratch.fit);
  plane.low = 0.0;
}

/// The plane that makes the seed narrowest where points are above it.
void SlabGrower::fit_plane_to_seed(std::uint32_t seed, double width, const CoverEffort& effort,
                                   FittedPlane& plane, SlabScratch& scratch) const {
  const std::uint32_t alone[] = {seed};
  const std::span<const std::uint32_t> vertices = vertices_of(alone, scratch);
  plane = measure_plane(space_, plane.normal, vertices, scratch.fit);
  if (rule_ != nullptr) rule_->learn_height(SimplexId{seed}, plane.height);
  if (plane.width() > width) plane = narrow_plane(space_, plane, vertices, 4 * effort.fit_steps, scratch.fit);
}

bool SlabGrower::holds(const FittedPlane& plane, double width, std::uint32_t simplex) const {
  const auto vertices = complex_.vertices(SimplexId{simplex});
  return std::all_of(vertices.begin(), vertices.end(), [&](PointId id) {
    return dot_of(plane.normal.data(), space_.row_of(id)) >= plane.height - kDepthRoom * width;
  });
}

void SlabGrower::find_vertices_of(VertexSlab& slab, double width, const CoverEffort& effort,
                                  SlabScratch& scratch) const {
  FittedPlane& plane = slab.plane;
  plane.normal.resize(complex_.rank);
  space_.normal_of(complex_.plane(SimplexId{slab.seed}), plane.normal.data());
  measure(plane, scratch);
  const bool is_first = holds(plane, width, slab.seed);
  if (!is_first) fit_plane_to_seed(slab.seed, width, effort, plane, scratch);
  if (is_first || holds(plane, width, slab.seed)) {
    if (!is_first) measure(plane, scratch);
    FittedPlane turned = plane;
    turn_to_vertices_below(turned, width, effort, scratch);
    if (holds(turned, width, slab.seed)) {
      plane = std::move(turned);
    } else {  // lost by rounding
      measure(plane, scratch);
      find_vertices_below(plane, width, scratch);
    }
    slab.vertices = scratch.vertices;
  } else {
    slab.vertices.clear();
    for (const PointId id : complex_.vertices(SimplexId{slab.seed}))
      slab.vertices.push_back(space_.row_of(id));
  }
  slab.depths.clear();
  for (const std::uint32_t row : slab.vertices)
    slab.depths.push_back(std::max(0.0, plane.height - dot_of(plane.normal.data(), row)));
}

/// scratch.vertices: those less than `width` below the plane, with products for the flood to come. The last
/// measured plane must be this one.
void SlabGrower::find_vertices_below(const FittedPlane& plane, double width, SlabScratch& scratch) const {
  const double least = plane.height - kDepthRoom * width;
  ++scratch.vertex_pass;
  list_vertices_from(space_, least, scratch.fit, scratch.vertices);
  std::erase_if(scratch.vertices, [&](std::uint32_t row) {
    scratch.dots[row] = dot_of(plane.normal.data(), row);
    scratch.vertex_stamp[row] = scratch.vertex_pass;
    return scratch.dots[row] < least;
  });
}

/// Turns the plane, which the last measured one must be, to all vertices less than `width` below it. That
/// makes room for more, and loses none: the slab is grown once, when the plane is what it will be.
void SlabGrower::turn_to_vertices_below(FittedPlane& plane, double width, const CoverEffort& effort,
                                        SlabScratch& scratch) const {
  find_vertices_below(plane, width, scratch);
  for (unsigned turn = 0; turn < effort.refits; ++turn) {
    const std::size_t count = scratch.vertices.size();
    plane.low = plane.height;
    for (const std::uint32_t row : scratch.vertices) plane.low = std::min(plane.low, scratch.dots[row]);
    FittedPlane turned = narrow_plane(space_, plane, scratch.vertices, effort.fit_steps, scratch.fit);
    if (turned.normal == plane.normal) return;  // no way of turning it makes it narrower
    plane = std::move(turned);
    find_vertices_below(plane, width, scratch);
    if (scratch.vertices.size() <= count) return;
  }
}

/// The same by what the slab holds, which is grown again each time.
void SlabGrower::turn_to_members(GrownSlab& slab, double width, const CoverEffort& effort,
                                 SlabScratch& scratch) const {
  for (unsigned refit = 0; refit < effort.refits; ++refit) {
    const std::span<const std::uint32_t> vertices = vertices_of(slab.members, scratch);
    FittedPlane turned = slab.plane;
    turned.low = lowest_dot(space_, turned.normal, vertices);
    turned = narrow_plane(space_, turned, vertices, effort.fit_steps, scratch.fit);
    ++scratch.vertex_pass;
    flood(slab.seed, turned, width, SIZE_MAX, scratch);
    if (scratch.grown_count <= slab.members.size()) break;
    slab.plane = std::move(turned);
    scratch.copy_grown(slab);
  }
}

void SlabGrower::grow(GrownSlab& slab, double width, const CoverEffort& effort, SlabScratch& scratch) const {
  slab.plane.normal.resize(complex_.rank);
  space_.normal_of(complex_.plane(SimplexId{slab.seed}), slab.plane.normal.data());
  slab.plane.height = slab.plane.low = 0.0;
  slab.members.assign(1, slab.seed);
  slab.depths.assign(1, 0.0f);
  if (is_convex_) {
    set_own_plane(slab);
  } else {
    if (!may_extend(slab.seed, slab.plane.normal.data(), width)) return;
    fit_plane_to_seed(slab.seed, width, effort, slab.plane, scratch);
    slab.depths.assign(1, rounded_up_depth(std::max(0.0, slab.plane.width())));
  }
  const bool turns_before = rule_ == nullptr && meets_all_points();
  ++scratch.vertex_pass;
  flood(slab.seed, slab.plane, width, turns_before ? kWorthTurning : SIZE_MAX, scratch);
  if (scratch.grown_count > 1) {
    scratch.copy_grown(slab);
  } else if (is_convex_) {
    slab.plane.height = 0.0;
  }
  if (slab.members.size() < (effort.refits <= 1 ? kWorthTurning : 2)) return;
  if (is_convex_) measure(slab.plane, scratch);
  if (!turns_before || slab.members.size() < kWorthTurning)
    return turn_to_members(slab, width, effort, scratch);
  FittedPlane turned = slab.plane;
  turn_to_vertices_below(turned, width, effort, scratch);
  flood(slab.seed, turned, width, SIZE_MAX, scratch);
  if (scratch.grown_count < slab.members.size()) return;  // a vertex of the seed lost by rounding
  slab.plane = std::move(turned);
  scratch.copy_grown(slab);
}

}  // namespace ndhull
