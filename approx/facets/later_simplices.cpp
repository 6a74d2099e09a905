#include "approx/facets/later_simplices.h"

#include <algorithm>

#include "core/machine/arena.h"

namespace ndhull {

const GroupedComplex& LaterSimplices::made() const {
  call_once_isolated(is_made_, [this] {
    made_ = make();
    own_ids_.resize(made_.complex.row_count);
    for (std::uint32_t row = 0; row < own_ids_.size(); ++row) own_ids_[row] = SimplexId{row};
  });
  return made_;
}

FacetId LaterSimplices::facet_of(SimplexId simplex) const {
  const std::vector<std::uint32_t>& begin = made().facet_begin;
  const auto after = std::upper_bound(begin.begin(), begin.end(), simplex.value);
  return FacetId{static_cast<std::uint32_t>(after - begin.begin() - 1)};
}

std::span<const SimplexId> LaterSimplices::of(FacetId facet) const {
  const std::vector<std::uint32_t>& begin = made().facet_begin;
  return {own_ids_.data() + begin[facet.value], begin[facet.value + 1] - begin[facet.value]};
}

FacetLayout LaterSimplices::layout(std::size_t simplicial) const {
  const std::vector<std::uint32_t>& begin = made().facet_begin;
  FacetLayout layout;
  layout.in_place = layout.simplicial = simplicial;
  layout.facets = begin.size() - 1;
  layout.merged_begin.assign(begin.begin() + static_cast<std::ptrdiff_t>(simplicial), begin.end());
  layout.simplices = own_ids_;
  for (std::size_t facet = simplicial; facet < layout.facets; ++facet)
    layout.facet_of_others.insert(layout.facet_of_others.end(), begin[facet + 1] - begin[facet],
                                  FacetId{static_cast<std::uint32_t>(facet)});
  return layout;
}

}  // namespace ndhull
