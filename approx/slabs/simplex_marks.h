// What walks over neighbours read of the simplices that they meet.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/dimension_switch.h"
#include "core/machine/huge_array.h"
#include "core/machine/prefetch.h"

namespace ndhull {

/// One bit a neighbour.
using NeighbourBits = std::uint16_t;
static_assert(8 * sizeof(NeighbourBits) >= kMaxRank);

/// As std::popcount, which is a call where the instruction cannot be taken for granted.
constexpr unsigned count_bits(NeighbourBits bits) {
  unsigned sum = bits - ((bits >> 1) & 0x5555u);
  sum = (sum & 0x3333u) + ((sum >> 2) & 0x3333u);
  sum = (sum + (sum >> 4)) & 0x0f0fu;
  return (sum + (sum >> 8)) & 0x1fu;
}

/// Of each row of a complex the XOR of its vertices, which gives the vertex across a ridge, and whether it is
/// taken. Neighbours are anywhere in memory: two bytes each stay in the second cache where eight do not, so
/// that is what they take where points are few enough.
class SimplexMarks {
 public:
  /// A mark as it is read: negative when the simplex is taken.
  using Mark = std::int32_t;
  /// PointIds are less than the number of points, which is at most this.
  static constexpr std::size_t kMostPoints = std::size_t{1} << 31;

  SimplexMarks() = default;
  /// None is taken.
  SimplexMarks(std::size_t rows, std::size_t point_count) {
    if (point_count <= kFewPoints) {
      short_ = HugeArray<std::int16_t>::to_write(rows);
      std::fill_n(short_.data(), rows, std::int16_t{0});
      vertex_bits_ = kFewPoints - 1;
    } else {
      long_ = HugeArray<std::int32_t>::to_write(rows);
      std::fill_n(long_.data(), rows, 0);
      vertex_bits_ = kMostPoints - 1;
    }
  }

  Mark operator[](std::uint32_t row) const {
    return short_.data() != nullptr ? Mark{short_[row]} : long_[row];
  }
  static bool is_taken(Mark mark) { return mark < 0; }
  bool is_taken(std::uint32_t row) const { return is_taken((*this)[row]); }
  /// The vertex of `other` that a neighbour does not have, which has `mark` and this vertex opposite the
  /// ridge.
  std::uint32_t vertex_across(Mark mark, std::uint32_t vertex, Mark other) const {
    return (static_cast<std::uint32_t>(mark ^ other) ^ vertex) & vertex_bits_;
  }

  /// `mix`: the XOR of the vertices; or what was read.
  void put(std::uint32_t row, std::uint32_t mix, bool is_taken) {
    const std::uint32_t word = (mix & vertex_bits_) | (is_taken ? ~vertex_bits_ : 0u);
    if (short_.data() != nullptr) {
      short_[row] = static_cast<std::int16_t>(word);
    } else {
      long_[row] = static_cast<std::int32_t>(word);
    }
  }
  void set_taken(std::uint32_t row, bool is_taken) {
    put(row, static_cast<std::uint32_t>((*this)[row]), is_taken);
  }
  void ask_for(std::uint32_t row) const {
    if (short_.data() != nullptr) {
      prefetch(short_.data() + row);
    } else {
      prefetch(long_.data() + row);
    }
  }

 private:
  static constexpr std::uint32_t kFewPoints = 1u << 15;

  HugeArray<std::int16_t> short_;  // or
  HugeArray<std::int32_t> long_;
  std::uint32_t vertex_bits_ = 0;
};

}  // namespace ndhull
