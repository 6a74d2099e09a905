// Seeds of slabs by the numbers of their neighbours, as they are taken: largest first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "approx/slabs/simplex_marks.h"
#include "core/machine/huge_array.h"

namespace ndhull {

/// Which rows' stars are taken in which pass, kCount - 1 being made first and 1 last. The first takes stars
/// with three quarters of the neighbours and more, those after it with half, with one fewer, and so on.
template <std::size_t D>
class StarPasses {
 public:
  static constexpr unsigned kCount = (D + 1) / 2 + 2;
  /// So many neighbours at least.
  static constexpr unsigned takes(unsigned pass) { return pass == kCount - 1 ? kTakenFirst : pass; }

  /// `stars`: per row its neighbours. Cost  two passes over them.
  void list(std::span<const NeighbourBits> stars) {
    std::array<std::uint32_t, kCount> next{};
    for (const NeighbourBits star : stars) ++next[pass_of(star)];
    rows_ = HugeArray<std::uint32_t>::to_write(stars.size());
    std::exclusive_scan(next.begin(), next.end(), next.begin(), 0u);
    for (std::uint32_t row = 0; row < stars.size(); ++row) rows_[next[pass_of(stars[row])]++] = row;
    end_ = next;
  }
  /// One of which so much is left: again in a later pass.
  void put_back(std::uint32_t row, NeighbourBits star) {
    if (star != 0) again_[pass_of(star)].push_back(row);
  }

  /// As the rows stand.
  std::span<const std::uint32_t> listed(unsigned pass) const {
    return {rows_.data() + end_[pass - 1], end_[pass] - end_[pass - 1]};
  }
  std::span<const std::uint32_t> again(unsigned pass) const { return again_[pass]; }

 private:
  static constexpr unsigned kTakenFirst = (3 * D + 3) / 4;
  static constexpr auto kPassOfSize = [] {
    std::array<std::uint8_t, D + 1> passes{};  // 0: none
    for (unsigned size = 0; size <= D; ++size)
      passes[size] = static_cast<std::uint8_t>(size >= kTakenFirst ? kCount - 1 : std::min(size, kCount - 2));
    return passes;
  }();
  static unsigned pass_of(NeighbourBits star) { return kPassOfSize[count_bits(star)]; }

  HugeArray<std::uint32_t> rows_;  // pass by pass, those that are in none first
  std::array<std::uint32_t, kCount> end_{};
  std::array<std::vector<std::uint32_t>, kCount> again_;
};

}  // namespace ndhull
