#include "core/search/byte_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Rounding to the next byte, and what double precision adds to it.
constexpr double kByteRounding = 0.5 / BytePoints::kBytesOfHalf * (1.0 + 1e-9);

}  // namespace

BytePoints::BytePoints(std::size_t dimension, StridedRows points, std::span<const double> low,
                       std::span<const double> high)
    : dimension_(dimension),
      rows_(points),
      middle_(dimension),
      half_(dimension),
      rounding_(dimension, kByteRounding) {
  NDHULL_CHECK(dimension <= kMaxDimension && points.count > 0);
  constexpr std::size_t kChunk = kTile * kTilesInChunk;
  chunk_count_ = (points.count + kChunk - 1) / kChunk;
  bytes_ = HugeArray<std::uint16_t>(chunk_count_ * kChunk * pairs());
  std::array<double, kMaxDimension> per_byte;
  for (std::size_t k = 0; k < dimension; ++k) {
    middle_[k] = 0.5 * low[k] + 0.5 * high[k];
    half_[k] = 0.5 * high[k] - 0.5 * low[k];
    per_byte[k] = kBytesOfHalf / half_[k];
    if (std::isfinite(per_byte[k])) continue;
    per_byte[k] = 0.0;  // all the same, or so near each other that the factor overflows: bytes in the middle
    rounding_[k] = 1.1;
  }
  constexpr std::size_t kChunksInBlock = 16;
  std::vector<double> reach_sq((chunk_count_ + kChunksInBlock - 1) / kChunksInBlock, 0.0);
  for_each_block(chunk_count_, kChunksInBlock, [&](std::size_t begin, std::size_t end) {
    double largest = 0.0;
    for (std::size_t place = begin * kChunk; place < end * kChunk; ++place) {
      const double* row = rows_.row(std::min(place, rows_.count - 1));
      std::uint16_t* const to = bytes_.data() + place / kTile * pairs() * kTile + place % kTile;
      double length_sq = 0.0;
      const auto byte_of = [&](std::size_t k) {
        const double scaled = (row[k] - middle_[k]) * per_byte[k];
        length_sq += scaled * scaled;
        return static_cast<std::int32_t>(scaled + (kBytesOfHalf + 0.5));
      };
      for (std::size_t k = 0; k < dimension; k += 2) {
        const std::int32_t first = byte_of(k), second = k + 1 < dimension ? byte_of(k + 1) : 0;
        to[k / 2 * kTile] = static_cast<std::uint16_t>(first | second << 8);
      }
      largest = std::max(largest, length_sq);
    }
    reach_sq[begin / kChunksInBlock] = largest;
  });
  const double largest = *std::max_element(reach_sq.begin(), reach_sq.end());
  // Columns without a factor are at most 1.
  reach_ = (std::sqrt(largest) / kBytesOfHalf) * (1.0 + 1e-9);
  for (const double rounding : rounding_)
    if (rounding > kByteRounding) reach_ += 1.0;
}

}  // namespace ndhull
