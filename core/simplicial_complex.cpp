#include "core/simplicial_complex.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/blocks.h"

namespace ndhull {

namespace {

constexpr std::size_t kRowsAtATime = 1 << 14;

void rename_neighbours(SimplicialComplex& complex, std::span<const std::uint32_t> new_of_old) {
  const std::size_t rank = complex.rank;
  for_each_block(complex.row_count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      std::uint32_t* neighbours = complex.topology.data() + row * 2 * rank + rank;
      for (std::size_t k = 0; k < rank; ++k) neighbours[k] = new_of_old[neighbours[k]];
    }
  });
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

void permute_topology(SimplicialComplex& complex, std::span<const std::uint32_t> old_of_new) {
  constexpr std::size_t kAhead = 8;  // rows whose way from memory has begun
  const std::size_t width = 2 * complex.rank, count = old_of_new.size();
  std::vector<std::uint32_t> rows, new_of_old(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    new_of_old[old_of_new[row]] = row;
    if (old_of_new[row] != row) rows.push_back(row);
  }
  if (rows.empty()) return;
  // Where most rows move it is faster to take all of them into a new table.
  const bool takes_all = 2 * rows.size() > count;
  if (takes_all) {
    rows.resize(count);
    std::iota(rows.begin(), rows.end(), 0u);
  }
  HugeArray<std::uint32_t> taken(rows.size() * width);
  for_each_block(rows.size(), kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      __builtin_prefetch(complex.topology.data() + old_of_new[rows[std::min(i + kAhead, end - 1)]] * width);
      std::copy_n(complex.topology.data() + old_of_new[rows[i]] * width, width, taken.data() + i * width);
    }
  });
  if (takes_all) {
    complex.topology = std::move(taken);
  } else {
    for_each_block(rows.size(), kRowsAtATime, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        std::copy_n(taken.data() + i * width, width, complex.topology.data() + rows[i] * width);
    });
  }
  rename_neighbours(complex, new_of_old);
}

}  // namespace ndhull
