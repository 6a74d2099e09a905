// Tables of growth, which begin small and move to larger places, the last of which is reserved for all rows
// that the machine can hold.
#pragma once

#include <algorithm>
#include <cstddef>

#include "core/machine/huge_array.h"

namespace ndhull {

/// Rows of the stages before the last. A hull of a hundred simplices needs a few kilobytes, from the
/// allocator; one of some thousand some hundred that lie close together and were used before
/// (core/machine/block_store.h). Where each of a dozen tables begins in small pages of its own, the system's work for
/// these was up to a third of growth.
inline constexpr std::size_t kRowsOfStages[] = {512, 8192};

/// How many rows tables have room for that are to have `needed`; at most `most`.
inline std::size_t stage_rows(std::size_t needed, std::size_t most) {
  for (const std::size_t rows : kRowsOfStages)
    if (needed <= rows) return std::min(rows, most);
  return most;
}

inline bool is_small_stage(std::size_t rows) { return rows <= std::end(kRowsOfStages)[-1]; }

/// A table with room for `rows`, of which `at_once` will soon be written; what is in it is anything.
/// `per_row`: elements of a row.
template <class T>
HugeArray<T> staged_table(std::size_t rows, std::size_t per_row = 1, std::size_t at_once = 0) {
  return is_small_stage(rows) ? HugeArray<T>::to_write(rows * per_row)
                              : HugeArray<T>(rows * per_row, at_once * per_row);
}

/// Moves the table to a place with room for `rows`, of which `kept` are as they were and the others anything.
template <class T>
void move_to_stage(HugeArray<T>& table, std::size_t kept, std::size_t rows, std::size_t per_row = 1) {
  constexpr std::size_t kSoon = 4;  // times as large as it is
  HugeArray<T> place = staged_table<T>(rows, per_row, kSoon * kept);
  std::copy_n(table.data(), kept * per_row, place.data());
  table = std::move(place);
}

/// The same for a list that is written from its begin, as far as it is needed: when tables are no longer the
/// smallest it gets addresses for `most` rows, of which it touches few, and stays there. `rows`: of the other
/// tables.
template <class T>
void move_list(HugeArray<T>& list, std::size_t kept, std::size_t rows, std::size_t most,
               std::size_t per_row = 1) {
  const std::size_t room = rows <= kRowsOfStages[0] ? rows : most;
  if (list.capacity() < room * per_row) move_to_stage(list, kept, room, per_row);
}

/// The same as move_to_stage for an element a row; the others are zero.
template <class T>
void move_and_clear(HugeArray<T>& table, std::size_t kept, std::size_t rows) {
  move_to_stage(table, kept, rows);
  if (is_small_stage(rows)) std::fill(table.data() + kept, table.data() + rows, T{});
}

}  // namespace ndhull
