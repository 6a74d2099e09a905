#include "core/complex/simplicial_complex.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>
#include <vector>

#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {

namespace {

constexpr std::size_t kRowsAtATime = 1 << 14;

/// `moved`: rows, as they are numbered now, of which no neighbour was told yet where they are. `new_of`: the
/// number of a row that had this one.
template <class NewOf>
void rename_neighbours(SimplicialComplex& complex, const NewOf& new_of,
                       std::span<const std::uint32_t> moved) {
  constexpr std::size_t kFew = 8;  // one of so many
  constexpr std::size_t kAhead = 8;
  const std::size_t rank = complex.rank;
  const auto rename = [&](std::size_t row) {
    std::uint32_t* neighbours = complex.topology.data() + row * 2 * rank + rank;
    for (std::size_t k = 0; k < rank; ++k) neighbours[k] = new_of(neighbours[k]);
  };
  if (moved.size() * kFew > complex.row_count) {
    for_each_block(complex.row_count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) rename(row);
    });
    return;
  }
  std::vector<bool> is_renamed(complex.row_count, false);
  const auto rename_once = [&](std::uint32_t row) {
    if (is_renamed[row]) return;
    is_renamed[row] = true;
    rename(row);
  };
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const std::uint32_t row = moved[i];
    // Rows beside a later one, which may have its old number.
    for (const SimplexId later : complex.neighbours(SimplexId{moved[std::min(i + kAhead, moved.size() - 1)]}))
      prefetch(complex.topology.data() + std::size_t{new_of(later.value)} * 2 * rank, 2 * rank);
    rename_once(row);
    for (const SimplexId neighbour : complex.neighbours(SimplexId{row})) rename_once(neighbour.value);
  }
}

}  // namespace

std::vector<bool> find_corners(const SimplicialComplex& complex, std::size_t begin, std::size_t end,
                               std::size_t point_count, std::size_t most) {
  std::vector<std::uint8_t> is_corner(point_count, 0);
  std::atomic<std::size_t> others = std::min(point_count, most);  // corners that may still be found
  // From both ends by turns: the last vertices may have rows of their own only at the end.
  const std::size_t blocks = (end - begin + kRowsAtATime - 1) / kRowsAtATime;
  for_each_block(blocks, 1, [&](std::size_t turn, std::size_t) {
    if (others.load(std::memory_order_relaxed) == 0) return;
    const std::size_t block = turn % 2 == 0 ? turn / 2 : blocks - 1 - turn / 2;
    const std::size_t first = begin + block * kRowsAtATime;
    std::size_t found = 0;
    for (std::size_t row = first; row < std::min(end, first + kRowsAtATime); ++row) {
      if (complex.state[row] != SimplexState::kLive) continue;
      for (const PointId id : complex.vertices(SimplexId{static_cast<std::uint32_t>(row)})) {
        const std::atomic_ref flag(is_corner[id.value]);  // of several threads
        // Most are set already: written once, their lines stay with all cores.
        if (flag.load(std::memory_order_relaxed) == 0)
          found += flag.exchange(1, std::memory_order_relaxed) == 0 ? 1u : 0u;
      }
    }
    if (found > 0) others.fetch_sub(found, std::memory_order_relaxed);
  });
  return {is_corner.begin(), is_corner.end()};
}

std::vector<RowMove> compact(SimplicialComplex& complex) {
  const std::size_t rank = complex.rank;
  const auto live = static_cast<std::size_t>(
      std::count(complex.state.data(), complex.state.data() + complex.row_count, SimplexState::kLive));
  std::vector<std::uint32_t> new_of_last(complex.row_count - live), moved;  // of rows from `live` on
  std::vector<RowMove> moves;
  std::size_t end = complex.row_count;
  for (std::size_t row = 0; row < live; ++row) {
    if (complex.state[row] != SimplexState::kFree) continue;
    while (complex.state[end - 1] == SimplexState::kFree) --end;
    const std::size_t last = --end;
    new_of_last[last - live] = static_cast<std::uint32_t>(row);
    moved.push_back(static_cast<std::uint32_t>(row));
    moves.push_back({static_cast<std::uint32_t>(last), static_cast<std::uint32_t>(row)});
    std::copy_n(complex.planes.data() + last * rank, rank, complex.planes.data() + row * rank);
    std::copy_n(complex.topology.data() + last * 2 * rank, 2 * rank,
                complex.topology.data() + row * 2 * rank);
    std::swap(complex.state[row], complex.state[last]);
  }
  complex.row_count = live;
  rename_neighbours(
      complex, [&](std::uint32_t row) { return row < live ? row : new_of_last[row - live]; }, moved);
  complex.planes.discard_from(live * rank);
  complex.topology.discard_from(live * 2 * rank);
  complex.outside_head = HugeArray<std::uint32_t>();
  return moves;
}

void permute_topology(SimplicialComplex& complex, std::span<const std::uint32_t> old_of_new,
                      std::size_t planes_kept) {
  constexpr std::size_t kAhead = 8;  // rows whose way from memory has begun
  const std::size_t rank = complex.rank, width = 2 * rank, count = old_of_new.size();
  std::vector<std::uint32_t> rows, new_of_old(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    new_of_old[old_of_new[row]] = row;
    if (old_of_new[row] != row) rows.push_back(row);
  }
  if (rows.empty()) return complex.planes.discard_from(planes_kept * rank);
  // Where most rows move it is faster to take all of them, and to rename on the way.
  const bool takes_all = 2 * rows.size() > count;
  if (takes_all) {
    rows.resize(count);
    std::iota(rows.begin(), rows.end(), 0u);
  }
  // A plane has as many bytes as the vertices and neighbours of its row: memory that is there already.
  static_assert(sizeof(double) == 2 * sizeof(std::uint32_t));
  HugeArray<std::uint32_t> fresh;
  std::uint32_t* taken = reinterpret_cast<std::uint32_t*>(complex.planes.data() + planes_kept * rank);
  const bool has_room =
      4 * planes_kept <= count && planes_kept + rows.size() <= complex.planes.capacity() / rank;
  if (!has_room) {
    complex.planes.discard_from(planes_kept * rank);
    fresh = HugeArray<std::uint32_t>::to_write(rows.size() * width);
    taken = fresh.data();
  }
  for_each_block(rows.size(), kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      prefetch(complex.topology.data() + old_of_new[rows[std::min(i + kAhead, end - 1)]] * width);
      std::uint32_t* row = taken + i * width;
      std::copy_n(complex.topology.data() + old_of_new[rows[i]] * width, width, row);
      if (!takes_all) continue;
      for (std::size_t k = rank; k < width; ++k) row[k] = new_of_old[row[k]];
    }
  });
  if (takes_all && !has_room) {
    complex.topology = std::move(fresh);
    return;
  }
  for_each_block(rows.size(), kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      std::copy_n(taken + i * width, width, complex.topology.data() + rows[i] * width);
  });
  complex.planes.discard_from(planes_kept * rank);
  if (!takes_all)
    rename_neighbours(
        complex, [&](std::uint32_t row) { return new_of_old[row]; }, rows);
}

SimplicialComplex make_segment(const double* coordinates, std::size_t count) {
  SimplicialComplex segment(1, 2);
  segment.row_count = 2;
  const double* const ends[2] = {std::min_element(coordinates, coordinates + count),
                                 std::max_element(coordinates, coordinates + count)};
  for (std::uint32_t row = 0; row < 2; ++row) {
    segment.topology[2 * row] = static_cast<std::uint32_t>(ends[row] - coordinates);
    segment.topology[2 * row + 1] = 1 - row;
    segment.planes[row] = 1.0 / *ends[row];
    segment.state[row] = SimplexState::kLive;
  }
  return segment;
}

}  // namespace ndhull
