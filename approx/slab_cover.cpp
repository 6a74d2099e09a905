#include "approx/slab_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "core/blocks.h"
#include "core/dimension_switch.h"
#include "core/ids.h"

namespace ndhull {
namespace {

bool is_measured(const FittedPlane& plane) { return plane.height > 0.0; }

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

Covering SlabCover::cover(double width, const CoverEffort& effort) {
  if (wide_) {
    if (std::optional<Covering> covering = wide_->cover(width, effort)) {
      depth_of_.assign(complex_.row_count, 0.0f);
      if (wide_->has_strays()) gather_strays(*covering, width);
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
    }
  }
  return assign(choose_slabs(slabs_, members_, seeds_.hits()), width, effort);
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
  gather_strays(covering, width);
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
  std::uint32_t used = 0;
  for (std::size_t facet = 0; facet < covering.planes.size(); ++facet) {
    const Members members = members_of.of(facet);
    if (members.empty()) continue;
    for (const std::uint32_t row : members) covering.facet_of[row] = used;
    if (used != facet) covering.planes[used] = std::move(covering.planes[facet]);
    covering.widest = std::max(covering.widest, covering.planes[used++].width());
  }
  covering.planes.resize(used);
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

/// How far the simplices reach below the height of the plane, which is measured if it was not yet.
double SlabCover::depth_below(FittedPlane& plane, Members simplices) {
  if (!is_measured(plane)) plane = measure_plane(space_, plane.normal, {}, scratch_.local().fit);
  double low = HUGE_VAL;
  const double* normal = plane.normal.data();
  for (const std::uint32_t simplex : simplices) {
    for (const PointId id : complex_.vertices(SimplexId{simplex})) {
      const double* z = space_.row(space_.row_of(id));
      double dot = 0.0;
      for (std::size_t k = 0; k < complex_.rank; ++k) dot += normal[k] * z[k];
      low = std::min(low, dot);
    }
  }
  return plane.height - low;
}

/// Connected parts of facets: each row's part is known by its first row.
class FacetParts {
 public:
  /// Id: as small as holds all facets, since looking these up is what takes the time; its largest: none.
  template <class Id>
  FacetParts(const SimplicialComplex& complex, const std::vector<Id>& facet_of) : first_(complex.row_count) {
    // Rows as they stand in memory; each ridge from the later of its two. Which neighbours are of the same
    // facet is not to be foreseen: they are listed without a branch for each.
    std::array<std::uint32_t, kMaxRank> same;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      first_[row] = row;
      const Id facet = facet_of[row];
      if (facet == std::numeric_limits<Id>::max()) continue;
      std::size_t count = 0;
      for (const SimplexId neighbour : complex.neighbours(SimplexId{row})) {
        same[count] = neighbour.value;
        count += static_cast<std::size_t>(neighbour.value < row) &
                 static_cast<std::size_t>(facet_of[neighbour.value] == facet);
      }
      std::uint32_t root = row;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t other = find(same[i]);
        if (other == root) continue;
        first_[std::max(other, root)] = std::min(other, root);
        root = std::min(other, root);
      }
    }
  }
  /// Valid for ascending rows, once each.
  std::uint32_t part_of(std::uint32_t row) { return first_[row] = first_[first_[row]]; }

 private:
  std::uint32_t find(std::uint32_t row) {
    while (first_[row] != row) row = first_[row] = first_[first_[row]];
    return row;
  }
  std::vector<std::uint32_t> first_;
};

/// All connected parts of the facets but the largest of each, in the order of their first simplex.
std::vector<SlabCover::Stray> SlabCover::find_strays(const Covering& covering) const {
  const bool are_few = covering.planes.size() < std::numeric_limits<std::uint16_t>::max();
  FacetParts parts = are_few ? FacetParts(complex_, std::vector<std::uint16_t>(covering.facet_of.begin(),
                                                                               covering.facet_of.end()))
                             : FacetParts(complex_, covering.facet_of);
  std::vector<std::uint32_t> size_of(complex_.row_count, 0), largest_of(covering.planes.size(), kNone);
  std::vector<std::uint32_t> others;  // first rows of the parts that are not a facet's first
  for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
    const std::uint32_t facet = covering.facet_of[row];
    if (facet == kNone) continue;
    const std::uint32_t part = parts.part_of(row);
    ++size_of[part];
    if (part != row) continue;
    if (largest_of[facet] == kNone) {
      largest_of[facet] = part;
    } else {
      others.push_back(part);
    }
  }
  if (others.empty()) return {};
  for (const std::uint32_t part : others) {
    std::uint32_t& largest = largest_of[covering.facet_of[part]];
    if (size_of[part] > size_of[largest]) largest = part;
  }
  std::vector<Stray> strays;
  std::vector<std::uint32_t> place_of(complex_.row_count, kNone);
  for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
    const std::uint32_t facet = covering.facet_of[row];
    if (facet == kNone) continue;
    const std::uint32_t part = parts.part_of(row);
    if (largest_of[facet] == part) continue;
    if (part == row) {
      place_of[part] = static_cast<std::uint32_t>(strays.size());
      strays.push_back({facet, {}});
    }
    strays[place_of[part]].simplices.push_back(row);
  }
  return strays;
}

// A facet is connected: of several parts the largest stays, the others go to a neighbour that can hold them
// within the width. Those that none can hold stay where they are.
void SlabCover::gather_strays(Covering& covering, double width) {
  std::vector<std::uint32_t> hosts;
  for (const Stray& stray : find_strays(covering)) {
    hosts.clear();
    for (const std::uint32_t simplex : stray.simplices) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex}))
        if (covering.facet_of[neighbour.value] != stray.facet)
          hosts.push_back(covering.facet_of[neighbour.value]);
    }
    std::sort(hosts.begin(), hosts.end());
    hosts.erase(std::unique(hosts.begin(), hosts.end()), hosts.end());
    double best_depth = kDepthRoom * width;
    std::uint32_t best = kNone;
    for (const std::uint32_t host : hosts) {
      const double depth = depth_below(covering.planes[host], stray.simplices);
      if (depth >= best_depth) continue;
      best_depth = depth;
      best = host;
    }
    if (best == kNone) continue;
    for (const std::uint32_t simplex : stray.simplices) {
      covering.facet_of[simplex] = best;
      depth_of_[simplex] = rounded_up_depth(best_depth);
    }
  }
}

}  // namespace ndhull
