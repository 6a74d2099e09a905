// Which simplices a complex has, however its rows stand.
#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// The vertices of each live simplex, ascending.
inline std::set<std::vector<std::uint32_t>> simplices_of(const SimplicialComplex& complex) {
  std::set<std::vector<std::uint32_t>> found;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    std::vector<std::uint32_t> ids;
    for (const PointId id : complex.vertices(SimplexId{row})) ids.push_back(id.value);
    std::sort(ids.begin(), ids.end());
    found.insert(ids);
  }
  return found;
}

}  // namespace ndhull
