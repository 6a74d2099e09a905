#include "approx/growth/begun_hull.h"

#include <algorithm>

namespace ndhull {

std::uint64_t BegunHull::bytes() const { return grown.complex.row_count * (16 * frame.rank + 9); }

bool BegunHull::rename_points(std::span<const std::uint32_t> kept) {
  std::vector<std::uint32_t> places(rows.size(), PointId::kNone);
  for (std::size_t point = 0; point < rows.size(); ++point) {
    const auto at = std::lower_bound(kept.begin(), kept.end(), rows[point]);
    if (at != kept.end() && *at == rows[point]) places[point] = static_cast<std::uint32_t>(at - kept.begin());
  }
  bool are_kept = true;
  for (PointId& id : frame.simplex) {
    id.value = places[id.value];
    are_kept = are_kept && id.value != PointId::kNone;
  }
  SimplicialComplex& complex = grown.complex;
  for (std::size_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    std::uint32_t* vertices = complex.topology.data() + row * 2 * complex.rank;
    for (std::size_t k = 0; k < complex.rank; ++k) {
      vertices[k] = places[vertices[k]];
      are_kept = are_kept && vertices[k] != PointId::kNone;
    }
  }
  return are_kept;
}

}  // namespace ndhull
