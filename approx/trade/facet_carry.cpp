#include "approx/trade/facet_carry.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "approx/slabs/dual_facets.h"
#include "approx/slabs/plane_fit.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

constexpr std::size_t kNewRowsAtATime = 1024, kDeepOnesAtATime = 64, kPlanesAtATime = 4;
/// Passes after which what is in some facet stays there.
constexpr int kPasses = 64;

bool is_live(const SimplicialComplex& complex, std::uint32_t row) {
  return complex.state[row] == SimplexState::kLive;
}

class FacetCarrier {
 public:
  FacetCarrier(const SimplicialComplex& complex, const WidthSpace& space, const SimplexNames& before,
               const Covering& covering, double width)
      : complex_(complex),
        space_(space),
        before_(before),
        old_(covering),
        width_(static_cast<float>(width)) {}

  Covering run() {
    carried_.planes = old_.planes;
    carried_.facet_of.assign(complex_.row_count, kNone);
    keep_those_still_there();
    list_hosts();
    put_new_rows();
    drop_empty_facets(carried_);
    measure();
    return std::move(carried_);
  }

 private:
  void keep_those_still_there() {
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      if (!is_live(complex_, row)) continue;
      if (before_.is_same(complex_, row)) {
        carried_.facet_of[row] = old_.facet_of[row];
      } else {
        new_rows_.push_back(row);
      }
    }
  }

  void list_hosts() {
    std::vector<std::uint8_t> is_host(old_.planes.size(), 0);
    for (std::uint32_t row = 0; row < old_.facet_of.size(); ++row)
      if (old_.facet_of[row] != kNone && carried_.facet_of[row] == kNone) is_host[old_.facet_of[row]] = 1;
    for (const std::uint32_t row : new_rows_) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{row})) {
        const std::uint32_t facet = carried_.facet_of[neighbour.value];
        if (facet != kNone) is_host[facet] = 1;
      }
    }
    PlaneFitWork work;
    for (std::uint32_t facet = 0; facet < is_host.size(); ++facet) {
      if (is_host[facet] == 0) continue;
      FittedPlane& plane = carried_.planes[facet];
      plane = measure_plane(space_, plane.normal, {}, work);
      hosts_.push_back(facet);
    }
  }

  /// Passes over new simplices, each of which looks at the facets that its neighbours were in after the pass
  /// before: from the rim inwards, and again where a neighbour has changed.
  void put_new_rows() {
    depth_of_.assign(new_rows_.size(), HUGE_VALF);
    next_.assign(new_rows_.size(), kNone);
    place_of_.assign(complex_.row_count, kNone);
    for (std::uint32_t i = 0; i < new_rows_.size(); ++i) place_of_[new_rows_[i]] = i;
    is_near_.assign(new_rows_.size(), 1);
    settle();
    if (put_deep_ones()) settle();
  }

  void settle() {
    for (int pass = 0;; ++pass) {
      call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) {
        for_each_block(new_rows_.size(), kNewRowsAtATime, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i)
            if (is_near_[i] != 0) find_highest<d>(i);
        });
      });
      const bool has_moved = move();
      const auto open = std::ranges::find(next_, kNone);
      if (open == next_.end() && (!has_moved || pass >= kPasses)) return;
      // Nothing that is still there is beside it.
      if (!has_moved) next_[static_cast<std::size_t>(open - next_.begin())] = hosts_.front();
    }
  }

  /// Those deeper than the widest facet was look at all facets around. True: some have moved.
  bool put_deep_ones() {
    call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) {
      for_each_block(new_rows_.size(), kDeepOnesAtATime, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          if (depth_of_[i] <= width_) continue;
          for (const std::uint32_t host : hosts_) try_facet<d>(i, host);
        }
      });
    });
    return move();
  }

  /// Of its neighbours' facets that below whose plane a new simplex lies highest, the first of several.
  template <std::size_t D>
  void find_highest(std::size_t place) {
    const SimplexId row{new_rows_[place]};
    const std::span<const PointId> vertices = complex_.vertices(row);
    const std::span<const SimplexId> neighbours = complex_.neighbours(row);
    for (std::size_t k = 0; k < D; ++k) {
      const std::uint32_t facet = carried_.facet_of[neighbours[k].value];
      // Of the vertices this one alone is not the neighbour's: most facets are refused by it.
      if (facet != kNone && facet != next_[place] && depth_below<D>(facet, vertices[k]) < depth_of_[place])
        try_facet<D>(place, facet);
    }
  }

  template <std::size_t D>
  void try_facet(std::size_t place, std::uint32_t facet) {
    float deepest = 0.0F;
    for (const PointId id : complex_.vertices(SimplexId{new_rows_[place]})) {
      deepest = std::max(deepest, depth_below<D>(facet, id));
      if (deepest >= depth_of_[place]) return;
    }
    depth_of_[place] = deepest;
    next_[place] = facet;
  }

  template <std::size_t D>
  float depth_below(std::uint32_t facet, PointId vertex) const {
    const FittedPlane& plane = carried_.planes[facet];
    return static_cast<float>(plane.height -
                              dot_in_frame<D>(plane.normal.data(), space_.row(space_.row_of(vertex))));
  }

  /// True: some have moved, and those beside them are to look again.
  bool move() {
    std::ranges::fill(is_near_, std::uint8_t{0});
    bool has_moved = false;
    for (std::size_t i = 0; i < new_rows_.size(); ++i) {
      if (carried_.facet_of[new_rows_[i]] == next_[i]) continue;
      carried_.facet_of[new_rows_[i]] = next_[i];
      has_moved = true;
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{new_rows_[i]}))
        if (place_of_[neighbour.value] != kNone) is_near_[place_of_[neighbour.value]] = 1;
    }
    return has_moved;
  }

  void measure() {
    struct CarryScratch {
      PlaneFitWork fit;
      FacetVertices vertices;
    };
    const FacetMembers members_of(carried_);
    tbb::enumerable_thread_specific<CarryScratch> scratch_of_thread;
    for_each_block(carried_.planes.size(), kPlanesAtATime, [&](std::size_t begin, std::size_t end) {
      CarryScratch& scratch = scratch_of_thread.local();
      for (std::size_t facet = begin; facet < end; ++facet) {
        const auto vertices = scratch.vertices.list(complex_, space_, members_of.of(facet));
        FittedPlane& plane = carried_.planes[facet];
        plane = measure_plane(space_, plane.normal, vertices, scratch.fit);
      }
    });
    carried_.widest = 0.0;
    for (const FittedPlane& plane : carried_.planes)
      carried_.widest = std::max(carried_.widest, plane.width());
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const SimplexNames& before_;
  const Covering& old_;
  float width_;
  Covering carried_;
  std::vector<std::uint32_t> new_rows_;
  std::vector<std::uint32_t> hosts_;     // facets that new simplices may go to
  std::vector<std::uint32_t> place_of_;  // per row: in new_rows_
  // Of each new row the facet that it goes to, how deep it lies there, and whether a neighbour has moved.
  std::vector<std::uint32_t> next_;
  std::vector<float> depth_of_;
  std::vector<std::uint8_t> is_near_;
};

}  // namespace

SimplexNames::SimplexNames(const SimplicialComplex& complex) : names_(complex.row_count, kFree) {
  for (std::uint32_t row = 0; row < complex.row_count; ++row)
    if (is_live(complex, row)) names_[row] = name_of(complex, row);
}

/// The vertices in any order (the mixing steps are those of MurmurHash3's finalizer).
std::uint32_t SimplexNames::name_of(const SimplicialComplex& complex, std::uint32_t row) {
  std::uint32_t name = 0;
  for (const PointId id : complex.vertices(SimplexId{row})) {
    std::uint32_t mixed = id.value + 1;
    mixed = (mixed ^ (mixed >> 16)) * 0x85ebca6bu;
    mixed = (mixed ^ (mixed >> 13)) * 0xc2b2ae35u;
    name += mixed ^ (mixed >> 16);
  }
  return name == kFree ? 1 : name;
}

Covering carry_facets(const SimplicialComplex& complex, const WidthSpace& space, const SimplexNames& before,
                      const Covering& covering, double width) {
  return FacetCarrier(complex, space, before, covering, width).run();
}

}  // namespace ndhull
