#include "approx/facets/regrown_simplices.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/complex/simplex_rows.h"
#include "core/dimension_switch.h"
#include "core/error.h"
#include "core/frame.h"
#include "core/growth/growth.h"

namespace ndhull {
namespace {

/// Rows of vertices, and the row of the complex that each one was.
struct NumberedRows {
  SimplexRows rows;
  std::vector<std::uint32_t> row_of;
};

template <std::size_t D>
NumberedRows sort_rows(const SimplicialComplex& complex, std::size_t vertex_count) {
  struct Entry {
    std::array<std::uint16_t, D> vertices;
    std::uint32_t row;
  };
  std::vector<Entry> entries(complex.row_count);
  for (std::uint32_t row = 0; row < entries.size(); ++row) {
    const auto vertices = complex.vertices(SimplexId{row});
    std::transform(vertices.begin(), vertices.end(), entries[row].vertices.begin(),
                   [](PointId id) { return static_cast<std::uint16_t>(id.value); });
    std::sort(entries[row].vertices.begin(), entries[row].vertices.end());
    entries[row].row = row;
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.vertices < b.vertices; });
  NumberedRows sorted{SimplexRows(D, vertex_count, entries.size()), {}};
  sorted.row_of.reserve(entries.size());
  auto entry = entries.begin();
  for (std::uint32_t first = 0; first < vertex_count; ++first) {
    std::vector<std::uint16_t> others;
    const std::size_t at = sorted.row_of.size();
    for (; entry != entries.end() && entry->vertices[0] == first; ++entry) {
      others.insert(others.end(), entry->vertices.begin() + 1, entry->vertices.end());
      sorted.row_of.push_back(entry->row);
    }
    sorted.rows.set_part(first, at, others);
  }
  sorted.rows.number();
  return sorted;
}

}  // namespace

/// Each facet, in its turn, takes what its vertices span and no facet has: that is how it got its simplices.
std::vector<std::uint32_t> RegrownSimplices::facets_of_rows(const SimplicialComplex& complex) const {
  const std::size_t vertex_count = ids_.size();
  const NumberedRows sorted =
      call_with_dimension<3, kMaxRank>(rank_, [&](auto d) { return sort_rows<d>(complex, vertex_count); });
  std::vector<std::uint32_t> facet_of(complex.row_count, kNone), facet_at(turns_.size());
  for (std::uint32_t facet = 0; facet < turns_.size(); ++facet) facet_at[turns_[facet]] = facet;
  std::vector<std::uint8_t> is_among(vertex_count);
  std::size_t taken = 0;
  for (const std::uint32_t facet : facet_at) {
    const auto vertices = facet_vertices_.row(facet);
    std::size_t count = 0;
    for (const std::uint32_t vertex : vertices) is_among[vertex] = 1;
    sorted.rows.for_each_within(vertices, is_among.data(), [&](std::uint32_t row) {
      std::uint32_t& facet_of_row = facet_of[sorted.row_of[row]];
      if (facet_of_row != kNone) return;
      facet_of_row = facet;
      ++count;
    });
    for (const std::uint32_t vertex : vertices) is_among[vertex] = 0;
    if (count == sizes_[facet]) taken += count;
  }
  if (taken != complex.row_count)
    throw Error(ErrorCode::kTooManySimplices,
                "simplices: found others than the facets were made of, which rounding decided; facets and "
                "planes hold without them");
  return facet_of;
}

GroupedComplex RegrownSimplices::make() const {
  const PointView view = PointView::row_major(coordinates_.data(), ids_.size(), rank_);
  const Frame frame = fit_frame(view);
  std::vector<double> points(coordinates_.size());
  map_points(view, frame, points.data());
  GrowthWork work;
  work.rank = rank_;
  work.point_count = ids_.size();
  work.points = points.data();
  start_growth(work, frame.simplex, {});
  grow(work);
  compact(work.complex);
  GroupedComplex made;
  made.complex = std::move(work.complex);
  const std::vector<std::uint32_t> facet_of = facets_of_rows(made.complex);
  made.facet_begin.assign(sizes_.size() + 1, 0);
  std::inclusive_scan(sizes_.begin(), sizes_.end(), made.facet_begin.begin() + 1);
  std::vector<std::uint32_t> next(made.facet_begin.begin(), made.facet_begin.end() - 1);
  std::vector<std::uint32_t> old_of_new(facet_of.size());
  for (std::uint32_t row = 0; row < facet_of.size(); ++row) old_of_new[next[facet_of[row]]++] = row;
  permute_topology(made.complex, old_of_new, 0);
  made.complex.planes = HugeArray<double>();
  for (std::size_t row = 0; row < made.complex.row_count; ++row) {
    std::uint32_t* vertices = made.complex.topology.data() + row * 2 * rank_;
    for (std::size_t k = 0; k < rank_; ++k) vertices[k] = ids_[vertices[k]];
  }
  return made;
}

}  // namespace ndhull
