// Products of many points with many directions in single precision: which point is furthest along each
// direction, and which points come near a threshold. What single precision leaves open is listed, and the
// caller decides it in double precision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// Points in one tile: a multiple of two vectors of any instruction set.
inline constexpr std::size_t kScanTile = 64;

/// Points as rounded to single precision, tile by tile, in a tile one coordinate of all points after the
/// other. Slots behind the last point are 0, which is above no threshold that is at least 0.
class ScanTiles {
 public:
  explicit ScanTiles(std::size_t dimension) : dimension_(dimension) {}

  void reserve(std::size_t points);
  /// Appends a point (dimension numbers). `id` is what scans return.
  void append(const double* point, std::uint32_t id);
  /// From now on tiles are known to be in descending order of length, so scans may stop early.
  void mark_sorted();

  std::size_t dimension() const { return dimension_; }
  std::size_t size() const { return ids_.size(); }
  std::size_t tile_count() const { return (ids_.size() + kScanTile - 1) / kScanTile; }
  const float* tile(std::size_t index) const { return values_.data() + index * dimension_ * kScanTile; }
  std::uint32_t id(std::size_t slot) const { return ids_[slot]; }
  double largest_length() const { return largest_length_; }
  /// Tiles in front of this one may hold a point whose product with a unit direction is above `threshold`.
  std::size_t tiles_above(double threshold) const;

  /// Bound on |computed - true| for a product with a unit direction: both factors are rounded to single
  /// precision and `dimension` terms are summed, gamma_{dimension + 2} of |direction| |point|, and the same
  /// again for rounding the bound and lengths (Higham. Accuracy and Stability of Numerical Algorithms, 2nd
  /// ed., eq. 3.5). Underflow of a coordinate is below it: lengths are 1 or so in the frame.
  double product_error() const;

 private:
  std::size_t dimension_;
  std::vector<float> values_;
  std::vector<std::uint32_t> ids_;
  std::vector<double> tile_lengths_;  // sorted tiles: the largest length in each
  bool is_sorted_ = false;
  double largest_length_ = 0.0;
};

/// What is asked about one direction, and the answer.
struct DirectionQuery {
  static constexpr std::uint32_t kNoPoint = 0xFFFF'FFFFu;

  float threshold = 0.0F;         ///< >= 0: points above it are near
  float refute = 0.0F;            ///< >= threshold: a point above this is all that is wanted
  std::uint32_t skip = kNoPoint;  ///< id of a point to pass over

  bool is_refuted = false;            ///< some product is above `refute`; then `furthest` is the largest one
  std::uint32_t furthest = kNoPoint;  ///< of equal ones the first in the order of the tiles
  float furthest_product = 0.0F;
  std::vector<std::uint32_t> near;  ///< not refuted: ids of all points above `threshold`, in order
};

/// Answers queries about directions of length 1.
///
/// Shapes  directions: queries.size() x dimension, row-major.
/// Error   computed products are within tiles.product_error() of the true ones; thresholds are compared with
///         the computed ones.
/// Cost    points x directions x dimension multiply-adds in single precision, near the machine's peak for
///         some dozen directions. One thread.
void scan_directions(const ScanTiles& tiles, std::span<const float> directions,
                     std::span<DirectionQuery> queries);

/// The same on all cores of the caller's arena; the answers are the same. For many points.
void scan_directions_in_parallel(const ScanTiles& tiles, std::span<const float> directions,
                                 std::span<DirectionQuery> queries);

}  // namespace ndhull
