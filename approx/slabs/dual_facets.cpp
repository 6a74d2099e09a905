#include "approx/slabs/dual_facets.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {

PlaneTops::PlaneTops(const WidthSpace& space, PointsAbove above)
    : space_(space), above_(above), normal_(space.rank()) {
  constexpr std::size_t kFew = 4;  // a part of all: the product with all of them is quicker for each
  const std::size_t left_out = space.table().count() - space.vertex_count();
  if (!above.are_left_out || kFew * left_out > space.table().count()) return;
  if (left_out == 0) {
    above_.are_left_out = false;
  } else {
    left_out_ = SupportTable(
        space.rank(), {space.row(static_cast<std::uint32_t>(space.vertex_count())), left_out * space.rank()});
  }
}

double PlaneTops::of_simplex(const double* plane, double length) {
  const double top = 1.0 + above_.vertices;
  if (!above_.are_left_out) return top;
  space_.normal_of({plane, space_.rank()}, normal_.data());
  double height = top / length, furthest = 0.0;  // n.z = a.y / |R a|
  if (left_out_.count() > 0) {
    left_out_.find(normal_.data(), work_.products, furthest);
  } else if (space_.is_large()) {
    furthest = space_.furthest(normal_, height).dot;
  } else {
    space_.table().find(normal_.data(), work_.products, furthest);
  }
  return std::max(height, furthest) * length;
}

std::vector<std::uint32_t> DualFacets::facet_of_rows() const {
  constexpr std::size_t kFacetsInBlock = 1 << 12, kAskedBefore = 16;
  std::vector<std::uint32_t> facet_of(complex->row_count, kNone);
  for_each_block(count(), kFacetsInBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t facet = first; facet < last; ++facet) {
      for (std::size_t i = begin[facet]; i < begin[facet + 1]; ++i) {
        const std::size_t later = std::min<std::size_t>(i + kAskedBefore, begin.back() - 1);
        prefetch(&facet_of[members[later].value]);
        facet_of[members[i].value] = static_cast<std::uint32_t>(facet);
      }
    }
  });
  return facet_of;
}

void list_facets(DualFacets& facets, std::size_t member_count, std::span<const std::uint32_t> with_planes) {
  const auto members = std::span(facets.members).first(member_count);
  const auto count = static_cast<std::size_t>(
      std::ranges::count_if(members, [](SimplexId simplex) { return (simplex.value & kSeedBit) != 0; }));
  facets.seeds.resize(count);
  facets.own_plane.resize(count, kNone);
  facets.begin.resize(count + 1, static_cast<std::uint32_t>(member_count));
  std::size_t facet = 0, planes = 0;
  for (std::uint32_t i = 0; i < member_count; ++i) {
    if ((members[i].value & kSeedBit) == 0) continue;
    members[i].value &= ~kSeedBit;
    facets.seeds[facet] = members[i].value;
    facets.begin[facet] = i;
    if (planes < with_planes.size() && with_planes[planes] == members[i].value)
      facets.own_plane[facet] = static_cast<std::uint32_t>(planes++);
    ++facet;
  }
}

Covering covering_of(const DualFacets& facets, const WidthSpace& space) {
  constexpr std::size_t kFacetsAtATime = 64;
  const SimplicialComplex& complex = *facets.complex;
  Covering covering;
  covering.facet_of = facets.facet_of_rows();
  covering.planes.resize(facets.count());
  const FacetMembers members(covering);
  struct MeasureScratch {
    PlaneFitWork work;
    FacetVertices vertices;
  };
  tbb::enumerable_thread_specific<MeasureScratch> scratch_of_thread;
  for_each_block(facets.count(), kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    MeasureScratch& scratch = scratch_of_thread.local();
    for (auto facet = static_cast<std::uint32_t>(begin); facet < end; ++facet) {
      std::vector<double> normal(complex.rank);
      space.normal_of(facets.plane(facet), normal.data());
      FittedPlane& plane = covering.planes[facet];
      if (members.of(facet).size() == 1 && facets.own_plane[facet] == kNone) {
        plane.normal = std::move(normal);
        continue;
      }
      plane = measure_plane(space, normal, scratch.vertices.list(complex, space, members.of(facet)),
                            scratch.work);
    }
  });
  for (const FittedPlane& plane : covering.planes) covering.widest = std::max(covering.widest, plane.width());
  return covering;
}

// In the memory that the lists have: from the end on, simplices of clusters move to the back, which leaves
// the front to those that are facets alone.
FacetClusters clusters_of(DualFacets facets) {
  FacetClusters clusters;
  std::vector<SimplexId> alone;
  const auto is_alone = [&](std::size_t facet) {
    return facets.size(facet) == 1 && facets.own_plane[facet] == kNone;
  };
  const std::size_t count = facets.count();
  for (std::size_t facet = 0; facet < count; ++facet)
    if (is_alone(facet)) alone.push_back(SimplexId{facets.seeds[facet]});
  clusters.simplices = std::move(facets.members);
  clusters.simplices.resize(facets.begin.back());
  const auto simplices = clusters.simplices.begin();
  auto to = clusters.simplices.end();
  for (std::size_t facet = count; facet-- > 0;) {
    if (is_alone(facet)) continue;
    to = std::copy_backward(simplices + facets.begin[facet], simplices + facets.begin[facet + 1], to);
  }
  std::copy(alone.begin(), alone.end(), simplices);
  auto next = static_cast<std::uint32_t>(alone.size());
  for (std::size_t facet = 0; facet < count; ++facet) {
    if (is_alone(facet)) continue;
    // No cluster has a larger number than its facet.
    const auto size = static_cast<std::uint32_t>(facets.size(facet));
    facets.seeds[clusters.count] = facets.seeds[facet];
    facets.own_plane[clusters.count] = facets.own_plane[facet];
    facets.begin[clusters.count++] = next;
    next += size;
  }
  facets.begin[clusters.count] = next;
  facets.begin.resize(clusters.count + 1);
  facets.seeds.resize(clusters.count);
  facets.own_plane.resize(clusters.count);
  clusters.begin = std::move(facets.begin);
  clusters.seeds = std::move(facets.seeds);
  clusters.own_plane = std::move(facets.own_plane);
  clusters.planes = std::move(facets.own_planes);
  return clusters;
}

}  // namespace ndhull
