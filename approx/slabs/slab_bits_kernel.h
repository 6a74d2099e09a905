// Slabs as bits at the vertices that are in them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ndhull {

/// Words of a row of bits: as many as `bits` take, rounded up so that vectors of any instruction set fill it.
constexpr std::size_t words_for(std::size_t bits) {
  const std::size_t words = (bits + 63) / 64;
  return words <= 4 ? 4 : (words + 7) / 8 * 8;
}

/// The bits that all rows of a group have: which slabs hold a simplex, of the rows of its vertices.
///
/// Shapes  bits: rows x words, words from words_for; ids: count x size rows, size at least 1; out: count x
///         words.
void intersect_rows(const std::uint64_t* bits, std::size_t words, const std::uint16_t* ids, std::size_t size,
                    std::size_t count, std::uint64_t* out);

}  // namespace ndhull
