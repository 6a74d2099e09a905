#include "approx/trade/facet_corners.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

class CornerLister {
 public:
  CornerLister(const SimplicialComplex& complex, const WidthSpace& space, const Covering& covering)
      : complex_(complex), space_(space), covering_(covering), facets_(covering.planes.size()) {}

  std::vector<FacetCorners> run() {
    constexpr std::size_t kSmallTables = std::size_t{1} << 21;
    if (facets_.size() * (space_.vertex_count() + facets_.size()) <= kSmallTables) {
      list_by_tables();
    } else {
      list_by_facets();
    }
    return std::move(facets_);
  }

 private:
  static constexpr std::size_t kFacetsAtATime = 16;

  /// What a thread needs: the last facet that met a vertex, or a facet.
  struct ListWork {
    std::vector<std::uint32_t> vertex_seen, facet_seen;
  };

  /// Vertices and neighbours of few facets: a table each, filled as the rows stand in memory.
  void list_by_tables() {
    const std::size_t count = facets_.size(), vertices = space_.vertex_count();
    std::vector<std::uint8_t> has_vertex(count * vertices, 0), has_neighbour(count * count, 0);
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      const std::size_t id = covering_.facet_of[row];
      if (id == kNone) continue;
      for (const PointId point : complex_.vertices(SimplexId{row}))
        has_vertex[id * vertices + space_.row_of(point)] = 1;
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{row}))
        has_neighbour[id * count + covering_.facet_of[neighbour.value]] = 1;
    }
    const auto list = [](const std::uint8_t* flags, std::size_t size, std::vector<std::uint32_t>& entries) {
      for (std::uint32_t entry = 0; entry < size; ++entry)
        if (flags[entry] != 0) entries.push_back(entry);
    };
    for (std::size_t id = 0; id < count; ++id) {
      has_neighbour[id * count + id] = 0;
      list(has_vertex.data() + id * vertices, vertices, facets_[id].vertices);
      list(has_neighbour.data() + id * count, count, facets_[id].neighbours);
    }
  }

  void list_by_facets() {
    const std::size_t count = facets_.size();
    const FacetMembers members_of(covering_);
    tbb::enumerable_thread_specific<ListWork> list_work([&] {
      return ListWork{std::vector<std::uint32_t>(space_.table().count(), kNone),
                      std::vector<std::uint32_t>(count, kNone)};
    });
    for_each_block(count, kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
      for (std::size_t id = begin; id < end; ++id)
        list_facet(static_cast<std::uint32_t>(id), members_of.of(id), list_work.local());
    });
  }

  void list_facet(std::uint32_t id, std::span<const std::uint32_t> rows, ListWork& work) {
    const auto add = [&](std::vector<std::uint32_t>& list, std::vector<std::uint32_t>& seen,
                         std::uint32_t entry) {
      if (seen[entry] == id) return;
      seen[entry] = id;
      list.push_back(entry);
    };
    constexpr std::size_t kRowsBefore = 8, kRidgesBefore = 3;  // whose way from memory has begun
    FacetCorners& facet = facets_[id];
    work.facet_seen[id] = id;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const SimplexId later{rows[std::min(i + kRowsBefore, rows.size() - 1)]};
      prefetch(complex_.vertices(later).data());
      prefetch(&complex_.neighbours(later).back());
      const SimplexId soon{rows[std::min(i + kRidgesBefore, rows.size() - 1)]};
      for (const SimplexId neighbour : complex_.neighbours(soon))
        prefetch(&covering_.facet_of[neighbour.value]);
      for (const PointId point : complex_.vertices(SimplexId{rows[i]}))
        add(facet.vertices, work.vertex_seen, space_.row_of(point));
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{rows[i]}))
        add(facet.neighbours, work.facet_seen, covering_.facet_of[neighbour.value]);
    }
    std::sort(facet.vertices.begin(), facet.vertices.end());
    std::sort(facet.neighbours.begin(), facet.neighbours.end());
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const Covering& covering_;
  std::vector<FacetCorners> facets_;
};

}  // namespace

std::vector<FacetCorners> corners_of(const SimplicialComplex& complex, const WidthSpace& space,
                                     const Covering& covering) {
  return CornerLister(complex, space, covering).run();
}

}  // namespace ndhull
