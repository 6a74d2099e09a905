// The simplices of a hull by their vertices alone, those with the same first vertex together: 14 bytes each
// in 8-d, where a complex with planes and neighbours has 133.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/machine/huge_array.h"

namespace ndhull {

/// Shapes  vertices are numbered from 0; of each simplex the smallest is its first. Row r of all is in the
///         part of its first vertex; there the others stand in ascending order, and rows lexicographically.
class SimplexRows {
 public:
  static constexpr std::size_t kMostVertices = std::size_t{1} << 16;

  /// No simplices, and room for `capacity`: address space, which takes memory when it is used. Precondition:
  /// vertex_count is at most kMostVertices.
  SimplexRows(std::size_t rank, std::size_t vertex_count, std::size_t capacity)
      : rank_(rank), others_(capacity * (rank - 1)), parts_(vertex_count), begin_(vertex_count + 1) {}

  /// The simplices whose first vertex this is: others, any number x (rank - 1), as they stand (see Shapes).
  /// They are kept in places `at` and on, which no other part has. Several vertices may be set at the same
  /// time.
  void set_part(std::uint32_t first, std::size_t at, std::span<const std::uint16_t> others);
  /// After all parts are set: numbers the rows.
  void number();

  std::size_t rank() const { return rank_; }
  std::size_t vertex_count() const { return parts_.size(); }
  std::size_t count() const { return begin_.back(); }
  /// Writes the rank vertices of a row, ascending. Cost  a binary search.
  void vertices_of(std::uint32_t row, std::uint32_t* vertices) const;

  /// Calls take(row) for every row all of whose vertices are among these, ascending.
  ///
  /// Shapes  vertices: ascending. is_among: one a vertex, not 0 for these.
  /// Cost    a merge of `vertices` with the second vertices that each of them has, and a look at each row
  ///         of which the first two are among them.
  template <class Take>
  void for_each_within(std::span<const std::uint32_t> vertices, const std::uint8_t* is_among,
                       const Take& take) const {
    const std::size_t width = rank_ - 1;
    for (std::size_t i = 0; i + width < vertices.size(); ++i) {
      const Part& part = parts_[vertices[i]];
      std::size_t next = i + 1;
      for (std::size_t r = 0; r + 1 < part.runs.size() && next < vertices.size();) {
        const Run& run = part.runs[r];
        if (run.second != vertices[next]) {
          ++(run.second < vertices[next] ? r : next);
          continue;
        }
        for (std::uint32_t row = run.begin; row < part.runs[r + 1].begin; ++row) {
          const std::uint16_t* const others = others_.data() + (part.at + row) * width;
          std::size_t k = 1;
          while (k < width && is_among[others[k]] != 0) ++k;
          if (k == width) take(static_cast<std::uint32_t>(begin_[vertices[i]] + row));
        }
        ++r;
        ++next;
      }
    }
  }

 private:
  struct Run {
    std::uint32_t second, begin;  // row of the part where this second vertex begins; the last is the end
  };
  struct Part {
    std::size_t at = 0;
    std::vector<Run> runs;  // none: no simplices
  };

  std::size_t rank_;
  HugeArray<std::uint16_t> others_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> begin_;
};

}  // namespace ndhull
