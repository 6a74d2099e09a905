#include "approx/facets/pulled_simplices.h"

#include "core/whole_facets/pulled_complex.h"

namespace ndhull {

GroupedComplex PulledSimplices::make() const { return make_complex(faces_, first_rows_); }

void PulledSimplices::rename_points(std::span<const std::uint32_t> ids) {
  rename_vertices(faces_, ids);
  for (std::uint32_t& id : first_rows_) id = ids[id];
}

}  // namespace ndhull
