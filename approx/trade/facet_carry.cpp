#include "approx/trade/facet_carry.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>

#include "approx/slabs/plane_fit.h"
#include "core/ids.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

constexpr std::size_t kNewRowsAtATime = 256, kPointsAtATime = 8, kPlanesAtATime = 4, kHostsAtATime = 64;

bool is_live(const SimplicialComplex& complex, std::uint32_t row) {
  return complex.state[row] == SimplexState::kLive;
}

class FacetCarrier {
 public:
  FacetCarrier(const SimplicialComplex& complex, const WidthSpace& space, const SimplexNames& before,
               const Covering& covering)
      : complex_(complex), space_(space), before_(before), old_(covering) {}

  Covering run() {
    carried_.planes = old_.planes;
    carried_.facet_of.assign(complex_.row_count, kNone);
    keep_those_still_there();
    list_hosts();
    put_new_rows();
    drop_empty();
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

  /// Each where it lies least deep, the first of several. Some hosts at a time: how deep all vertices lie
  /// below their planes is found once, and of a simplex the deepest of its vertices.
  void put_new_rows() {
    number_vertices();
    std::vector<float> depths(points_.size() * kHostsAtATime), least(new_rows_.size(), HUGE_VALF);
    for (std::size_t first = 0; first < hosts_.size(); first += kHostsAtATime) {
      const std::size_t count = std::min(kHostsAtATime, hosts_.size() - first);
      const auto hosts = std::span(hosts_).subspan(first, count);
      for_each_block(points_.size(), kPointsAtATime, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) find_depths(hosts, points_[i], &depths[i * kHostsAtATime]);
      });
      for_each_block(new_rows_.size(), kNewRowsAtATime, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) put(new_rows_[i], hosts, depths, least[i]);
      });
    }
  }

  /// The vertices of new simplices, as rows of the space.
  void number_vertices() {
    number_of_.assign(space_.vertex_count(), kNone);
    for (const std::uint32_t row : new_rows_) {
      for (const PointId id : complex_.vertices(SimplexId{row})) {
        const std::uint32_t point = space_.row_of(id);
        if (number_of_[point] != kNone) continue;
        number_of_[point] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(point);
      }
    }
  }

  void find_depths(std::span<const std::uint32_t> hosts, std::uint32_t point, float* depths) const {
    const double* const z = space_.row(point);
    for (std::size_t i = 0; i < hosts.size(); ++i) {
      const FittedPlane& plane = carried_.planes[hosts[i]];
      depths[i] = static_cast<float>(
          std::inner_product(plane.normal.begin(), plane.normal.end(), z, -plane.height) * -1.0);
    }
  }

  void put(std::uint32_t row, std::span<const std::uint32_t> hosts, const std::vector<float>& depths,
           float& least) {
    std::array<float, kHostsAtATime> deepest;
    deepest.fill(-HUGE_VALF);
    for (const PointId id : complex_.vertices(SimplexId{row})) {
      const float* const own = &depths[number_of_[space_.row_of(id)] * kHostsAtATime];
      for (std::size_t i = 0; i < kHostsAtATime; ++i) deepest[i] = std::max(deepest[i], own[i]);
    }
    for (std::size_t i = 0; i < hosts.size(); ++i) {
      if (deepest[i] >= least) continue;
      least = deepest[i];
      carried_.facet_of[row] = hosts[i];
    }
  }

  void drop_empty() {
    std::vector<std::uint32_t> new_id(carried_.planes.size(), kNone);
    for (const std::uint32_t facet : carried_.facet_of)
      if (facet != kNone) new_id[facet] = 0;
    std::uint32_t used = 0;
    for (std::size_t facet = 0; facet < new_id.size(); ++facet) {
      if (new_id[facet] == kNone) continue;
      if (used != facet) carried_.planes[used] = std::move(carried_.planes[facet]);
      new_id[facet] = used++;
    }
    carried_.planes.resize(used);
    for (std::uint32_t& facet : carried_.facet_of)
      if (facet != kNone) facet = new_id[facet];
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
  Covering carried_;
  std::vector<std::uint32_t> new_rows_;
  std::vector<std::uint32_t> hosts_;      // facets that new simplices may go to
  std::vector<std::uint32_t> points_;     // their vertices
  std::vector<std::uint32_t> number_of_;  // per vertex of the space: in points_
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
                      const Covering& covering) {
  return FacetCarrier(complex, space, before, covering).run();
}

}  // namespace ndhull
