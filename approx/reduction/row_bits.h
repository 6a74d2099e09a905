// A set of rows as bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ndhull {

/// Some of the rows of a table, at first all of them. Memory  a bit a row.
class RowBits {
 public:
  explicit RowBits(std::size_t rows) : bits_((rows + 63) / 64, ~std::uint64_t{0}) {
    if (rows % 64 != 0) bits_.back() >>= 64 - rows % 64;
  }
  /// Calls call(row) for those from `begin` on that are before `end`, ascending. A row may be dropped
  /// meanwhile. Shapes  begin: a multiple of 64; end: the same, or that of the table.
  template <class Call>
  void for_each(std::size_t begin, std::size_t end, const Call& call) const {
    for (std::size_t word = begin / 64; word < (end + 63) / 64; ++word)
      for (std::uint64_t left = bits_[word]; left != 0; left &= left - 1)
        call(64 * word + static_cast<std::size_t>(std::countr_zero(left)));
  }
  void put_back(std::size_t row) { bits_[row / 64] |= std::uint64_t{1} << (row % 64); }
  /// Threads may drop rows of different words at the same time.
  void drop(std::size_t row) { bits_[row / 64] &= ~(std::uint64_t{1} << (row % 64)); }

 private:
  std::vector<std::uint64_t> bits_;
};

}  // namespace ndhull
