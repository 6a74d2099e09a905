#include "core/simplicial_complex.h"

#include <algorithm>
#include <vector>

namespace ndhull {

void compact(SimplicialComplex& complex) {
  const std::size_t rank = complex.rank;
  std::vector<std::uint32_t> new_of_old(complex.row_count, SimplexId::kNone);
  std::size_t live = 0;
  for (std::size_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] == SimplexState::kFree) continue;
    new_of_old[row] = static_cast<std::uint32_t>(live);
    if (live != row) {
      std::copy_n(complex.planes.data() + row * rank, rank, complex.planes.data() + live * rank);
      std::copy_n(complex.topology.data() + row * 2 * rank, 2 * rank, complex.topology.data() + live * 2 * rank);
      complex.outside_head[live] = complex.outside_head[row];
      complex.state[live] = complex.state[row];
    }
    ++live;
  }
  for (std::size_t row = 0; row < live; ++row) {
    std::uint32_t* neighbours = complex.topology.data() + row * 2 * rank + rank;
    for (std::size_t k = 0; k < rank; ++k) neighbours[k] = new_of_old[neighbours[k]];
  }
  for (std::size_t row = live; row < complex.row_count; ++row) complex.state[row] = SimplexState::kFree;
  complex.row_count = live;
  complex.planes.discard_from(live * rank);
  complex.topology.discard_from(live * 2 * rank);
  complex.outside_head.discard_from(live);
}

}  // namespace ndhull
