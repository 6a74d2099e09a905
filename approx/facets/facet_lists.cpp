#include "approx/facets/facet_lists.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Which facet met a vertex or facet last.
struct LastMet {
  std::vector<std::uint32_t> vertex, facet;
};

void append(const IdRows& rows, IdRows& all) {
  const auto size = static_cast<std::uint32_t>(all.values.size());
  for (std::size_t row = 1; row < rows.begin.size(); ++row) all.begin.push_back(size + rows.begin[row]);
  all.values.insert(all.values.end(), rows.values.begin(), rows.values.end());
}

class FacetLister {
 public:
  FacetLister(const SimplicialComplex& complex, const FacetLayout& layout, std::span<const PointId> vertices,
              std::size_t point_count)
      : complex_(complex), layout_(layout), is_vertex_(point_count, 0) {
    for (const PointId vertex : vertices) is_vertex_[vertex.value] = 1;
  }

  void append_facet(std::uint32_t facet, LastMet& last, FacetLists& lists) const {
    const bool is_simplicial = facet < layout_.simplicial;
    std::vector<std::uint32_t>&vertices = lists.vertices.values, &neighbours = lists.neighbours.values;
    last.facet[facet] = facet;
    for (const SimplexId simplex : layout_.simplices_of(FacetId{facet})) {
      for (const PointId id : complex_.vertices(simplex)) {
        if (last.vertex[id.value] == facet || !is_vertex_[id.value]) continue;
        last.vertex[id.value] = facet;
        vertices.push_back(id.value);
      }
      for (const SimplexId neighbour : complex_.neighbours(simplex)) {
        const std::uint32_t other = layout_.facet_of(neighbour).value;
        if (!is_simplicial && last.facet[other] == facet) continue;
        last.facet[other] = facet;
        neighbours.push_back(other);
      }
    }
    if (!is_simplicial) {
      std::sort(vertices.begin() + lists.vertices.begin.back(), vertices.end());
      std::sort(neighbours.begin() + lists.neighbours.begin.back(), neighbours.end());
    }
    lists.vertices.begin.push_back(static_cast<std::uint32_t>(vertices.size()));
    lists.neighbours.begin.push_back(static_cast<std::uint32_t>(neighbours.size()));
  }

 private:
  const SimplicialComplex& complex_;
  const FacetLayout& layout_;
  std::vector<std::uint8_t> is_vertex_;  // per point
};

}  // namespace

FacetLists list_irregular_facets(const SimplicialComplex& complex, const FacetLayout& layout,
                                 std::span<const PointId> vertices, std::size_t point_count) {
  constexpr std::size_t kFacetsAtATime = 512;
  const FacetLister lister(complex, layout, vertices, point_count);
  tbb::enumerable_thread_specific<LastMet> last_of_thread([&] {
    return LastMet{std::vector<std::uint32_t>(point_count, FacetId::kNone),
                   std::vector<std::uint32_t>(layout.facets, FacetId::kNone)};
  });
  const std::size_t count = layout.facets - layout.regular;
  std::vector<FacetLists> blocks((count + kFacetsAtATime - 1) / kFacetsAtATime);
  for_each_block(count, kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    LastMet& last = last_of_thread.local();
    for (std::size_t i = begin; i < end; ++i)
      lister.append_facet(static_cast<std::uint32_t>(layout.regular + i), last,
                          blocks[begin / kFacetsAtATime]);
  });
  FacetLists lists;
  for (FacetLists& block : blocks) {
    append(block.vertices, lists.vertices);
    append(block.neighbours, lists.neighbours);
    block = FacetLists();
  }
  return lists;
}

}  // namespace ndhull
