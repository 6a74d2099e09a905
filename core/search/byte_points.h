// The furthest of many points along each of many directions, by products of bytes: where points are more than
// a few thousand, and a tree of them (core/search/point_tree.h) spares little because they are on all sides
// of a hull in many dimensions, or has no time to pay for itself.
//
// Idea. Coordinates rounded to bytes, in tiles that hold pairs of columns side by side. A direction is
// rounded so that the sum of its entries' sizes is at most 127: then the sum of its products with any point
// fits 16 bits, and no step can overflow. One instruction makes two products for each of 32 points. The sums
// say which few points may be the furthest, by a bound on all that rounding has done; those are multiplied in
// double precision. So the result is the same, digit for digit, as that of all products.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/machine/huge_array.h"
#include "core/search/point_tree.h"

namespace ndhull {

/// Rows of doubles that somebody else owns, one every `stride` numbers.
struct StridedRows {
  const double* data = nullptr;
  std::size_t count = 0, stride = 0;
  const double* row(std::size_t at) const { return data + at * stride; }
};

/// Points as bytes, and the rows that they were made of.
class BytePoints {
 public:
  static constexpr std::size_t kMaxDimension = 16;
  /// Points of a tile, one a 16-bit lane where vectors are longest; tiles of a chunk, whose largest sum is
  /// looked at as one.
  static constexpr std::size_t kTile = 32, kTilesInChunk = 8;
  /// A byte for each of so many parts of half a column's extent.
  static constexpr double kBytesOfHalf = 127.5;

  /// Shapes  points: at least one row, of 1 to kMaxDimension numbers, which must outlive this; low, high: no
  ///         coordinate of a column is outside of them.
  /// Cost    one pass over the points; a byte a coordinate.
  BytePoints(std::size_t dimension, StridedRows points, std::span<const double> low,
             std::span<const double> high);

  std::size_t dimension() const { return dimension_; }
  std::size_t pairs() const { return (dimension_ + 1) / 2; }
  const StridedRows& rows() const { return rows_; }
  std::size_t chunk_count() const { return chunk_count_; }
  /// Pairs of columns one after the other, each with both bytes of kTile points, the first column's below the
  /// other's. The last point fills the last chunk.
  const std::uint16_t* tile(std::size_t at) const { return bytes_.data() + at * pairs() * kTile; }

  /// Coordinate x is middle + half (byte / 127.5 - 1), off by at most half times `rounding`.
  std::span<const double> middle() const { return middle_; }
  std::span<const double> half() const { return half_; }
  std::span<const double> rounding() const { return rounding_; }
  /// No row of (x - middle) / half is longer.
  double reach() const { return reach_; }

 private:
  std::size_t dimension_;
  StridedRows rows_;
  std::size_t chunk_count_;
  std::vector<double> middle_, half_, rounding_;
  double reach_ = 0.0;
  HugeArray<std::uint16_t> bytes_;
};

/// Finds the largest product of each normal with any of the points, as find_furthest for trees does; of equal
/// ones the first row. Error as there.
///
/// Returns  how many products in double precision that took.
/// Cost  pairs of columns x points / 32 multiplications of vectors: on 10^5 points in 8-d some 5 us a
///       direction, on a sphere; where thousands of points are within a hundredth of the furthest, a product
///       in double precision for each of them.
std::size_t find_furthest(const BytePoints& points, std::span<const double> normals,
                          std::span<FurthestPoint> furthest);

}  // namespace ndhull
