#include "approx/facets/pulled_simplices.h"

#include "core/whole_facets/pulled_complex.h"

namespace ndhull {

std::uint64_t PulledSimplices::count_of(FacetId facet) const {
  const auto simplices = [this](std::size_t part) { return faces_.faces[faces_.facets[part]].simplices; };
  if (begin_.empty()) return simplices(facet.value);
  std::uint64_t count = 0;
  for (std::size_t part = begin_[facet.value]; part < begin_[facet.value + 1]; ++part)
    count += simplices(part);
  return count;
}

GroupedComplex PulledSimplices::make() const {
  GroupedComplex made = make_complex(faces_, first_rows_);
  if (begin_.empty()) return made;
  std::vector<std::uint32_t> facet_begin;
  for (const std::uint32_t part : begin_) facet_begin.push_back(made.facet_begin[part]);
  made.facet_begin = std::move(facet_begin);
  return made;
}

void PulledSimplices::rename_points(std::span<const std::uint32_t> ids) {
  rename_vertices(faces_, ids);
  for (std::uint32_t& id : first_rows_) id = ids[id];
}

}  // namespace ndhull
