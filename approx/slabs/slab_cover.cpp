#include "approx/slabs/slab_cover.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "approx/slabs/facet_parts.h"
#include "core/ids.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Facets that one thread looks at before it asks for more.
constexpr std::size_t kFacetsAtATime = 16;

}  // namespace

SlabCover::SlabCover(const SimplicialComplex& complex, const WidthSpace& space, bool is_convex,
                     const SimplexRule* rule)
    : complex_(complex),
      space_(space),
      is_convex_(is_convex),
      grower_(complex, space, rule, is_convex),
      seeds_(complex, space, rule == nullptr && grower_.meets_all_points()),
      scratch_([this] { return SlabScratch(space_); }) {
  constexpr std::size_t kWorthSampling = 4096, kMostVertices = 4096;  // simplices
  if (rule == nullptr && space.vertex_count() <= kMostVertices && live_count() >= kWorthSampling)
    wide_.emplace(complex_, space_, grower_, seeds_, [this]() -> SlabScratch& { return scratch_.local(); });
}

Covering SlabCover::cover(double width, const CoverEffort& effort, std::size_t most, const WorkEnd& end) {
  if (wide_) {
    if (std::optional<Covering> covering = wide_->cover(width, effort)) {
      depth_of_.assign(complex_.row_count, 0.0f);
      if (wide_->has_strays())
        gather_strays(complex_, space_, width, *covering, depth_of_, scratch_.local().fit);
      wide_->find_depths(*covering, depth_of_);
      measure_facets(*covering, width, effort);
      return std::move(*covering);
    }
  }
  planes_.clear();
  slabs_.clear();
  members_.clear();
  depths_.clear();
  members_.reserve(2 * live_count());
  depths_.reserve(2 * live_count());
  seeds_.clear();
  for (unsigned round = 1; round <= effort.choices; ++round) {
    seeds_.open(round);
    for (;;) {
      const std::span<const SeedChoice> seeds = seeds_.next_batch();
      if (seeds.empty()) break;
      add_slabs(seeds, width, effort);
      if (is_given_up(effort, most, end)) return Covering{};
    }
  }
  return assign(choose_slabs(slabs_, members_, seeds_.hits()), width, effort);
}

/// More slabs are grown than chosen, in each round as many.
bool SlabCover::is_given_up(const CoverEffort& effort, std::size_t most, const WorkEnd& end) {
  constexpr std::size_t kGrown = 2;
  if (planes_.size() / (kGrown * effort.choices) < most && !end.is_here()) return false;
  const std::span<const std::uint8_t> hits = seeds_.hits();
  const auto in_none = static_cast<std::size_t>(std::count(hits.begin(), hits.end(), std::uint8_t{0}));
  const auto live = static_cast<double>(live_count());
  expected_facets_ = static_cast<double>(planes_.size()) / static_cast<double>(kGrown * effort.choices) *
                     live / std::max(1.0, live - static_cast<double>(in_none));
  return true;
}

void SlabCover::add_slabs(std::span<const SeedChoice> seeds, double width, const CoverEffort& effort) {
  if (batch_.size() < seeds.size()) batch_.resize(seeds.size());
  for_each_block(seeds.size(), 1, [&](std::size_t i, std::size_t) {
    SlabScratch& scratch = scratch_.local();
    batch_[i].seed = seeds_.best_of(seeds[i], width, scratch.fit);
    grower_.grow(batch_[i], width, effort, scratch);
  });
  for (GrownSlab& slab : std::span(batch_).first(seeds.size())) {
    seeds_.add_slab(slab.members);
    planes_.push_back(std::move(slab.plane));
    slabs_.push_back({members_.size(), members_.size() + slab.members.size()});
    members_.insert(members_.end(), slab.members.begin(), slab.members.end());
    depths_.insert(depths_.end(), slab.depths.begin(), slab.depths.end());
  }
}

// Each simplex goes to the slab in which it lies highest.
Covering SlabCover::assign(const std::vector<std::uint32_t>& chosen, double width,
                           const CoverEffort& effort) {
  Covering covering;
  covering.facet_of.assign(complex_.row_count, kNone);
  covering.planes.reserve(chosen.size());
  depth_of_.assign(complex_.row_count, HUGE_VALF);
  for (const std::uint32_t index : chosen) {
    const MemberRange& slab = slabs_[index];
    const auto facet = static_cast<std::uint32_t>(covering.planes.size());
    for (std::size_t i = slab.begin; i < slab.end; ++i) {
      const std::uint32_t simplex = members_[i];
      if (depths_[i] >= depth_of_[simplex]) continue;
      depth_of_[simplex] = depths_[i];
      covering.facet_of[simplex] = facet;
    }
    covering.planes.push_back(std::move(planes_[index]));
  }
  gather_strays(complex_, space_, width, covering, depth_of_, scratch_.local().fit);
  measure_facets(covering, width, effort);
  return covering;
}

/// Fits the planes where that is asked for, and drops the facets that were left without a simplex.
void SlabCover::measure_facets(Covering& covering, double width, const CoverEffort& effort) {
  const FacetMembers members_of(covering);
  for_each_block(covering.planes.size(), kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t facet = begin; facet != end; ++facet)
      settle(members_of.of(facet), width, effort, covering.planes[facet]);
  });
  drop_empty_facets(covering);
  for (const FittedPlane& plane : covering.planes) covering.widest = std::max(covering.widest, plane.width());
}

/// The plane for what a facet was left with.
void SlabCover::settle(Members members, double width, const CoverEffort& effort, FittedPlane& plane) {
  if (members.empty() || (members.size() == 1 && !is_measured(plane))) return;
  if (members.size() == 1 && is_convex_) {  // its own plane is best
    space_.normal_of(complex_.plane(SimplexId{members[0]}), plane.normal.data());
    plane.height = plane.low = 0.0;
    return;
  }
  const bool is_late = plane.low == HUGE_VAL;  // a stray part came to what had not been measured
  float depth = 0.0f;
  for (const std::uint32_t simplex : members) depth = std::max(depth, depth_of_[simplex]);
  plane.low = plane.height - depth;
  const bool is_good_enough = members.size() == 1 || effort.final_fit_steps == 0;
  if (is_good_enough && !is_late && plane.width() <= width) return;
  SlabScratch& scratch = scratch_.local();
  const std::span<const std::uint32_t> vertices = grower_.vertices_of(members, scratch);
  plane = measure_plane(space_, plane.normal, vertices, scratch.fit);
  if (is_good_enough && plane.width() <= width) return;
  plane = narrow_plane(space_, plane, vertices, std::max(16u, effort.final_fit_steps), scratch.fit);
}

}  // namespace ndhull
