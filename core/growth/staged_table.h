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

/// How many rows tables of one hull have room for, stage by stage.
struct TableStages {
  std::size_t most;          ///< in the last one
  std::size_t foreseen = 0;  ///< about so many are needed, so that there is one stage; 0: it is not known

  /// Of tables that are to have `needed`.
  std::size_t rows_for(std::size_t needed) const {
    if (needed <= foreseen) return std::min(foreseen, most);
    for (const std::size_t rows : kRowsOfStages)
      if (needed <= rows) return std::min(rows, most);
    return most;
  }
  /// In memory that was used before?
  bool is_small(std::size_t rows) const { return rows <= std::max(foreseen, std::end(kRowsOfStages)[-1]); }
  /// Are lists no longer than tables?
  bool has_short_lists(std::size_t rows) const { return rows <= kRowsOfStages[0] || rows == foreseen; }
};

/// A table with room for `rows`, of which `at_once` will soon be written; what is in it is anything.
/// `per_row`: elements of a row.
template <class T>
HugeArray<T> staged_table(const TableStages& stages, std::size_t rows, std::size_t per_row = 1,
                          std::size_t at_once = 0) {
  return stages.is_small(rows) ? HugeArray<T>::to_write(rows * per_row)
                               : HugeArray<T>(rows * per_row, at_once * per_row);
}

/// Moves the table to a place with room for `rows`, of which `kept` are as they were and the others anything.
template <class T>
void move_to_stage(HugeArray<T>& table, const TableStages& stages, std::size_t kept, std::size_t rows,
                   std::size_t per_row = 1) {
  constexpr std::size_t kSoon = 4;  // times as large as it is
  HugeArray<T> place = staged_table<T>(stages, rows, per_row, kSoon * kept);
  std::copy_n(table.data(), kept * per_row, place.data());
  table = std::move(place);
}

/// The same for a list that is written from its begin, as far as it is needed: when tables are no longer the
/// smallest it gets addresses for as many rows as there may be, of which it touches few, and stays there.
/// `rows`: of the other tables.
template <class T>
void move_list(HugeArray<T>& list, const TableStages& stages, std::size_t kept, std::size_t rows,
               std::size_t per_row = 1) {
  const std::size_t room = stages.has_short_lists(rows) ? rows : stages.most;
  if (list.capacity() < room * per_row) move_to_stage(list, stages, kept, room, per_row);
}

/// The same as move_to_stage for an element a row; the others are zero.
template <class T>
void move_and_clear(HugeArray<T>& table, const TableStages& stages, std::size_t kept, std::size_t rows) {
  move_to_stage(table, stages, kept, rows);
  if (stages.is_small(rows)) std::fill(table.data() + kept, table.data() + rows, T{});
}

}  // namespace ndhull
