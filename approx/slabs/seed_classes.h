// Seeds of slabs in the order of their planes' distances, about: a counting sort of a byte a row.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/machine/blocks.h"

namespace ndhull {

/// Classes of planes by the logarithms of the squares of their gradients' lengths, about: the longer, the
/// nearer to the centre.
class SeedClasses {
 public:
  /// `length_sq_of`: of a row's plane. Some rows tell about how long gradients are.
  template <class LengthSq>
  SeedClasses(const SimplicialComplex& complex, const LengthSq& length_sq_of)
      : complex_(complex), class_of_(complex.row_count) {
    constexpr std::size_t kTold = 1024;
    const std::size_t step = complex.row_count / kTold + 1;
    float shortest = HUGE_VALF;
    for (std::size_t row = 0; row < complex.row_count; row += step) {
      if (!is_live(row)) continue;
      const float logarithm = logarithm_of(length_sq_of(row));
      longest_ = std::max(longest_, logarithm);
      shortest = std::min(shortest, logarithm);
    }
    scale_ = longest_ > shortest ? kClasses / (longest_ - shortest) : 0.0f;
  }

  /// To be called for all rows, by any thread.
  void put(std::size_t row, double length_sq) {
    class_of_[row] = static_cast<std::uint8_t>(
        std::clamp(scale_ * (longest_ - logarithm_of(length_sq)), 0.0f, kClasses - 1.0f));
  }

  /// The live rows class by class, the nearest first, those of a class ascending. Cost  a pass over the bytes
  /// of all rows by all threads, and another that writes.
  std::vector<std::uint32_t> sorted(std::size_t live_count) const {
    using Places = std::array<std::uint32_t, kClasses>;  // where the rows of a block go
    std::vector<Places> blocks((complex_.row_count + kRowsInBlock - 1) / kRowsInBlock);
    const auto for_live_rows = [&](const auto& visit) {
      for_each_block(complex_.row_count, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
        Places& places = blocks[begin / kRowsInBlock];
        for (std::size_t row = begin; row < end; ++row)
          if (is_live(row)) visit(static_cast<std::uint32_t>(row), places[class_of_[row]]);
      });
    };
    for_live_rows([](std::uint32_t, std::uint32_t& place) { ++place; });
    std::uint32_t next = 0;
    for (std::size_t c = 0; c < kClasses; ++c)
      for (Places& places : blocks) next += std::exchange(places[c], next);
    std::vector<std::uint32_t> rows(live_count);
    for_live_rows([&](std::uint32_t row, std::uint32_t& place) { rows[place++] = row; });
    return rows;
  }

 private:
  static constexpr std::size_t kClasses = 64, kRowsInBlock = 1 << 13;

  /// Rises with the number, much like its logarithm: exponent and first bits of a float.
  static float logarithm_of(double number) {
    return static_cast<float>(std::bit_cast<std::int32_t>(static_cast<float>(number)));
  }
  bool is_live(std::size_t row) const { return complex_.state[row] == SimplexState::kLive; }

  const SimplicialComplex& complex_;
  float longest_ = 0.0f, scale_ = 0.0f;
  std::vector<std::uint8_t> class_of_;  // per row
};

}  // namespace ndhull
