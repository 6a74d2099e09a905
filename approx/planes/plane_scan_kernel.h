// The vector loop of a plane scan: values of one plane at a block of points, compared with a threshold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ndhull {

/// Points in one block: a multiple of eight vectors of any instruction set.
inline constexpr std::size_t kScanBlock = 64;

/// A value above its plane's threshold.
struct ScanHit {
  std::uint32_t plane;  ///< row of the planes given
  std::uint32_t point;  ///< column of the block
  double value;
};

/// The planes of one call, row by row.
struct ScanPlanes {
  std::size_t dimension = 0;
  std::vector<double> normals;     ///< count x dimension
  std::vector<double> offsets;     ///< count
  std::vector<double> thresholds;  ///< count
};

/// Appends to `hits` every value normals[i] . x + offsets[i] that is not at most thresholds[i] (NaN is a
/// hit).
///
/// Shapes  block: dimension x kScanBlock, one coordinate of all points after the other.
/// Error   at most (dimension + 2) 2^-53 (sum |normal_k x_k| + |offset|) to first order, fused or not.
void find_above(const ScanPlanes& planes, const double* block, std::vector<ScanHit>& hits);

}  // namespace ndhull
