#include "approx/trade/facet_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "approx/slabs/dual_facets.h"
#include "approx/slabs/facet_parts.h"
#include "approx/slabs/slab_growth.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

constexpr unsigned kExchanges = 4;  // rings of simplices that a facet can win in a turn
constexpr unsigned kTurnSteps = 64;
constexpr std::size_t kRowsInBlock = 1024, kFitsAtATime = 4;
/// Rows whose neighbours' facets are on their way from memory.
constexpr std::size_t kNeighboursAhead = 8;

}  // namespace

FacetBalance::FacetBalance(const SimplicialComplex& complex, const WidthSpace& space, bool is_convex,
                           Covering covering)
    : complex_(complex),
      space_(space),
      is_convex_(is_convex),
      covering_(std::move(covering)),
      is_turned_(covering_.planes.size(), 1),
      is_changed_(covering_.planes.size(), 1),
      depth_of_(complex.row_count, HUGE_VALF),
      is_near_(complex.row_count, 0) {}

void FacetBalance::set_joined(Covering joined) {
  constexpr std::uint32_t kSeveral = kNone - 1;
  std::vector<std::uint32_t> was(joined.planes.size(), kNone);  // per facet: which it was before
  for (std::size_t row = 0; row < joined.facet_of.size(); ++row) {
    if (joined.facet_of[row] == kNone) continue;
    std::uint32_t& facet = was[joined.facet_of[row]];
    facet = facet == kNone || facet == covering_.facet_of[row] ? covering_.facet_of[row] : kSeveral;
  }
  const auto carry = [&](std::vector<std::uint8_t>& flags) {
    std::vector<std::uint8_t> carried(was.size(), 1);
    for (std::size_t facet = 0; facet < was.size(); ++facet)
      if (was[facet] != kSeveral) carried[facet] = flags[was[facet]];
    flags = std::move(carried);
  };
  carry(is_turned_);
  carry(is_changed_);
  covering_ = std::move(joined);
}

template <std::size_t D>
double FacetBalance::dot(std::uint32_t facet, PointId vertex) const {
  return dot_in_frame<D>(normals_.data() + std::size_t{facet} * D, space_.row(space_.row_of(vertex)));
}

template <std::size_t D>
float FacetBalance::depth_in(std::uint32_t row, std::uint32_t facet) const {
  double low = HUGE_VAL;
  for (const PointId id : complex_.vertices(SimplexId{row})) low = std::min(low, dot<D>(facet, id));
  return rounded_up_depth(std::max(0.0, heights_[facet] - low));
}

/// Of the simplices whose planes have turned.
void FacetBalance::find_depths() {
  normals_.resize(covering_.planes.size() * complex_.rank);
  heights_.resize(covering_.planes.size());
  for_each_block(covering_.planes.size(), kFitsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t facet = begin; facet != end; ++facet) {
      FittedPlane& plane = covering_.planes[facet];
      if (!is_measured(plane)) plane = measure_plane(space_, plane.normal, {}, scratch_.local().fit);
      std::copy(plane.normal.begin(), plane.normal.end(), normals_.data() + facet * complex_.rank);
      heights_[facet] = plane.height;
    }
  });
  call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) {
    for_each_block(complex_.row_count, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      for (auto row = static_cast<std::uint32_t>(begin); row != end; ++row) {
        const std::uint32_t facet = covering_.facet_of[row];
        if (facet != kNone && is_turned_[facet] != 0) depth_of_[row] = depth_in<d>(row, facet);
      }
    });
  });
}

/// At first beside the facets whose planes have turned, or its own has. Which neighbours are of other facets
/// is not to be foreseen: they are listed without a branch for each.
template <std::size_t D>
void FacetBalance::move_to_highest(std::uint32_t row, bool is_first) {
  const std::uint32_t own = covering_.facet_of[row];
  const std::span<const PointId> vertices = complex_.vertices(SimplexId{row});
  const std::span<const SimplexId> neighbours = complex_.neighbours(SimplexId{row});
  const bool takes_all = !is_first || is_turned_[own] != 0;
  std::array<std::uint32_t, D> facets, across;
  std::size_t count = 0;
  for (std::size_t k = 0; k < D; ++k) {
    const std::uint32_t facet = covering_.facet_of[neighbours[k].value];
    facets[count] = facet;
    across[count] = vertices[k].value;
    count += static_cast<std::size_t>(facet != own) &
             static_cast<std::size_t>(takes_all || is_turned_[facet] != 0);
  }
  for (std::size_t i = 0, seen = 0; i < count; ++i) {
    // Of the vertices this one alone is not the neighbour's: most facets are refused by it.
    const std::uint32_t facet = facets[i];
    if (dot<D>(facet, PointId{across[i]}) <= heights_[facet] - double{depth_of_[row]}) continue;
    if (std::find(facets.begin(), facets.begin() + seen, facet) != facets.begin() + seen) continue;
    facets[seen++] = facet;
    const float depth = depth_in<D>(row, facet);
    if (depth >= depth_of_[row]) continue;
    depth_of_[row] = depth;
    next_[row] = facet;
  }
}

/// All at once, by where the neighbours were before: in any order the same. True: some have moved.
bool FacetBalance::exchange(bool is_first) {
  next_ = covering_.facet_of;
  call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) {
    for_each_block(complex_.row_count, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      for (auto row = static_cast<std::uint32_t>(begin); row != end; ++row) {
        const auto later =
            static_cast<std::uint32_t>(std::min<std::size_t>(row + kNeighboursAhead, complex_.row_count - 1));
        if (is_first || is_near_[later] != 0)
          for (const SimplexId neighbour : complex_.neighbours(SimplexId{later}))
            prefetch(covering_.facet_of.data() + neighbour.value);  // of a free row: anything
        if (covering_.facet_of[row] != kNone && (is_first || is_near_[row] != 0))
          move_to_highest<d>(row, is_first);
      }
    });
  });
  std::fill(is_near_.begin(), is_near_.end(), std::uint8_t{0});
  bool has_moved = false;
  for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
    if (next_[row] == covering_.facet_of[row]) continue;
    has_moved = true;
    for (const SimplexId neighbour : complex_.neighbours(SimplexId{row})) is_near_[neighbour.value] = 1;
  }
  covering_.facet_of.swap(next_);
  return has_moved;
}

void FacetBalance::mark_changed(const std::vector<std::uint32_t>& before) {
  for (std::size_t row = 0; row < before.size(); ++row) {
    if (before[row] == covering_.facet_of[row]) continue;
    is_changed_[before[row]] = is_changed_[covering_.facet_of[row]] = 1;
  }
}

void FacetBalance::fit(std::uint32_t facet, std::span<const std::uint32_t> members, BalanceScratch& scratch) {
  FittedPlane& plane = covering_.planes[facet];
  const std::span<const std::uint32_t> vertices = scratch.vertices.list(complex_, space_, members);
  const FittedPlane start = measure_plane(space_, plane.normal, vertices, scratch.fit);
  plane = narrow_plane(space_, start, vertices, kTurnSteps, scratch.fit);
  is_turned_[facet] = plane.normal != start.normal ? 1 : 0;
}

void FacetBalance::drop_empty() {
  const std::vector<std::uint32_t> new_id = drop_empty_facets(covering_);
  for (std::size_t facet = 0; facet < new_id.size(); ++facet)
    if (new_id[facet] != kNone) is_turned_[new_id[facet]] = is_turned_[facet];
  is_turned_.resize(covering_.planes.size());
  is_changed_.assign(covering_.planes.size(), 0);
  covering_.widest = 0.0;
  for (const FittedPlane& plane : covering_.planes)
    covering_.widest = std::max(covering_.widest, plane.width());
}

bool FacetBalance::turn() {
  const std::vector<std::uint32_t> before = covering_.facet_of;
  find_depths();
  for (unsigned pass = 0; pass < kExchanges; ++pass)
    if (!exchange(pass == 0)) break;
  mark_changed(before);
  gather_strays(complex_, space_, covering_.widest, covering_, depth_of_, scratch_.local().fit, is_changed_);
  mark_changed(before);
  std::fill(is_turned_.begin(), is_turned_.end(), std::uint8_t{0});
  const FacetMembers members_of(covering_);
  const bool has_changed = std::find(is_changed_.begin(), is_changed_.end(), 1) != is_changed_.end();
  for_each_block(covering_.planes.size(), kFitsAtATime, [&](std::size_t begin, std::size_t end) {
    for (auto facet = static_cast<std::uint32_t>(begin); facet != end; ++facet) {
      const std::span<const std::uint32_t> members = members_of.of(facet);
      FittedPlane& plane = covering_.planes[facet];
      if (members.size() == 1 && is_convex_) {  // its own plane is best
        space_.normal_of(complex_.plane(SimplexId{members[0]}), plane.normal.data());
        plane.height = plane.low = 0.0;
        is_turned_[facet] = is_changed_[facet];
      } else if (!members.empty() && (is_changed_[facet] != 0 || plane.low == HUGE_VAL)) {
        fit(facet, members, scratch_.local());
      }
    }
  });
  drop_empty();
  return has_changed;
}

/// The simplex with the lowest vertex, the first of several.
std::uint32_t FacetBalance::deepest_of(std::span<const std::uint32_t> members,
                                       const FittedPlane& plane) const {
  double lowest = HUGE_VAL;
  std::uint32_t deepest = members.front();
  for (const std::uint32_t row : members) {
    for (const PointId id : complex_.vertices(SimplexId{row})) {
      const double* z = space_.row(space_.row_of(id));
      const double height = std::inner_product(z, z + complex_.rank, plane.normal.begin(), 0.0);
      if (height >= lowest) continue;
      lowest = height;
      deepest = row;
    }
  }
  return deepest;
}

void FacetBalance::split_widest(std::size_t count) {
  std::vector<std::uint32_t> facets(covering_.planes.size());
  std::iota(facets.begin(), facets.end(), 0u);
  std::stable_sort(facets.begin(), facets.end(), [&](std::uint32_t a, std::uint32_t b) {
    return covering_.planes[a].width() > covering_.planes[b].width();
  });
  const FacetMembers members_of(covering_);
  for (const std::uint32_t facet : facets) {
    const std::span<const std::uint32_t> members = members_of.of(facet);
    if (count == 0 || !is_measured(covering_.planes[facet])) break;
    if (members.size() < 2) continue;
    const std::uint32_t deepest = deepest_of(members, covering_.planes[facet]);
    covering_.facet_of[deepest] = static_cast<std::uint32_t>(covering_.planes.size());
    covering_.planes.push_back(own_plane(complex_, space_, deepest));
    is_changed_[facet] = 1;
    --count;
  }
  is_changed_.resize(covering_.planes.size(), 1);
  is_turned_.resize(covering_.planes.size(), 1);
}

}  // namespace ndhull
