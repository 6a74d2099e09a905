#include "core/simplicial_complex.h"

#include <algorithm>
#include <vector>

namespace ndhull {

namespace {

void rename_neighbours(SimplicialComplex& complex, const std::vector<std::uint32_t>& new_of_old) {
  const std::size_t rank = complex.rank;
  for (std::size_t row = 0; row < complex.row_count; ++row) {
    std::uint32_t* neighbours = complex.topology.data() + row * 2 * rank + rank;
    for (std::size_t k = 0; k < rank; ++k) neighbours[k] = new_of_old[neighbours[k]];
  }
}

}  // namespace

void compact(SimplicialComplex& complex) {
  const std::size_t rank = complex.rank;
  std::vector<std::uint32_t> new_of_old(complex.row_count, SimplexId::kNone);
  std::size_t live = 0;
  for (std::size_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] == SimplexState::kFree) continue;
    new_of_old[row] = static_cast<std::uint32_t>(live);
    if (live != row) {
      std::copy_n(complex.planes.data() + row * rank, rank, complex.planes.data() + live * rank);
      std::copy_n(complex.topology.data() + row * 2 * rank, 2 * rank,
                  complex.topology.data() + live * 2 * rank);
      complex.outside_head[live] = complex.outside_head[row];
      complex.state[live] = complex.state[row];
    }
    ++live;
  }
  for (std::size_t row = live; row < complex.row_count; ++row) complex.state[row] = SimplexState::kFree;
  complex.row_count = live;
  rename_neighbours(complex, new_of_old);
  complex.planes.discard_from(live * rank);
  complex.topology.discard_from(live * 2 * rank);
  complex.outside_head.discard_from(live);
}

void permute_rows(SimplicialComplex& complex, std::span<const std::uint32_t> old_of_new) {
  constexpr std::size_t kAhead = 8;  // rows whose way from memory has begun
  const std::size_t rank = complex.rank, count = old_of_new.size();
  std::vector<std::uint32_t> moved, new_of_old(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    new_of_old[old_of_new[row]] = row;
    if (old_of_new[row] != row) moved.push_back(row);
  }
  if (moved.empty()) return;
  HugeArray<double> planes(moved.size() * rank);
  HugeArray<std::uint32_t> topology(moved.size() * 2 * rank);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const std::size_t next = old_of_new[moved[std::min(i + kAhead, moved.size() - 1)]];
    __builtin_prefetch(complex.planes.data() + next * rank);
    __builtin_prefetch(complex.topology.data() + next * 2 * rank);
    const std::size_t old = old_of_new[moved[i]];
    std::copy_n(complex.planes.data() + old * rank, rank, planes.data() + i * rank);
    std::copy_n(complex.topology.data() + old * 2 * rank, 2 * rank, topology.data() + i * 2 * rank);
  }
  if (moved.size() == count) {
    complex.planes = std::move(planes);
    complex.topology = std::move(topology);
  } else {
    for (std::size_t i = 0; i < moved.size(); ++i) {
      std::copy_n(planes.data() + i * rank, rank, complex.planes.data() + moved[i] * rank);
      std::copy_n(topology.data() + i * 2 * rank, 2 * rank, complex.topology.data() + moved[i] * 2 * rank);
    }
  }
  rename_neighbours(complex, new_of_old);
}

}  // namespace ndhull
