#include "approx/pulled_simplices.h"

#include <algorithm>

namespace ndhull {

const PulledComplex& PulledSimplices::made() const {
  std::call_once(is_made_, [this] {
    made_ = make_complex(faces_, first_rows_);
    own_ids_.resize(made_.complex.row_count);
    for (std::uint32_t row = 0; row < own_ids_.size(); ++row) own_ids_[row] = SimplexId{row};
  });
  return made_;
}

FacetId PulledSimplices::facet_of(SimplexId simplex) const {
  const std::vector<std::uint32_t>& begin = made().facet_begin;
  const auto after = std::upper_bound(begin.begin(), begin.end(), simplex.value);
  return FacetId{static_cast<std::uint32_t>(after - begin.begin() - 1)};
}

std::span<const SimplexId> PulledSimplices::of(FacetId facet) const {
  const std::vector<std::uint32_t>& begin = made().facet_begin;
  return {own_ids_.data() + begin[facet.value], begin[facet.value + 1] - begin[facet.value]};
}

void PulledSimplices::rename_points(std::span<const std::uint32_t> ids) {
  rename_vertices(faces_, ids);
  for (std::uint32_t& id : first_rows_) id = ids[id];
}

}  // namespace ndhull
