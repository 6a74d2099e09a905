// Which points are near enough to planes, in single precision first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// Points in single precision, their rows filled up with zeros.
class FloatPoints {
 public:
  /// Shapes  coordinates: any number of rows x rank; rank 2 to kMaxRank.
  FloatPoints(std::size_t rank, std::span<const double> coordinates);

  std::size_t rank() const { return rank_; }
  const float* data() const { return values_.data(); }
  /// No point is longer.
  float reach() const { return reach_; }
  /// Numbers in a row.
  static constexpr std::size_t stride(std::size_t rank) { return rank <= 4 ? 4 : rank <= 8 ? 8 : 16; }

 private:
  std::size_t rank_;
  std::vector<float> values_;
  float reach_ = 0.0f;
};

/// Bits of what products were compared with: of the first half those that are surely at least `least`, of the
/// second those that single precision cannot tell.
struct ProductBits {
  std::uint16_t at_least, unknown;
};

/// Compares the products of each plane with its own `rank` points with a number: bit k is of point k.
///
/// Shapes  planes: count x rank; ids: count x rank rows of `points`; least, bits: count.
/// Error   what is not known is decided by the bound (rank + 8) 2^-24 (|plane| reach + |least|) on the
///         rounding of operands and sums (Higham, 2nd ed., eq. 3.5).
/// Cost    rank^2 multiply-adds a plane.
void compare_products(const FloatPoints& points, const double* planes, const std::uint32_t* ids,
                      std::span<const double> least, std::span<ProductBits> bits);

}  // namespace ndhull
