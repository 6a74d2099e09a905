// Lists of ids of different lengths, one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ndhull {

/// Rows of ids of different lengths in one array: row r is values[begin[r] .. begin[r + 1]).
struct IdRows {
  std::vector<std::uint32_t> begin{0};
  std::vector<std::uint32_t> values;
  std::span<const std::uint32_t> row(std::size_t r) const {
    return {values.data() + begin[r], values.data() + begin[r + 1]};
  }
  /// `ids`: numbers, or ids of one kind.
  template <class Ids>
  void append(const Ids& ids) {
    for (const auto id : ids) {
      if constexpr (requires { id.value; }) {
        values.push_back(id.value);
      } else {
        values.push_back(id);
      }
    }
    end_row();
  }
  /// Values that were added behind the last row become one.
  void end_row() { begin.push_back(narrow_id(values.size())); }
};

/// Values as ids of a kind, which are one such value each.
template <class To>
std::span<const To> as_ids(std::span<const std::uint32_t> values) {
  static_assert(sizeof(To) == sizeof(std::uint32_t));
  return {reinterpret_cast<const To*>(values.data()), values.size()};
}

}  // namespace ndhull
