// The unit that thresholds, offsets and widths are stated in.
#pragma once

#include <span>
#include <vector>

#include "core/frame.h"

namespace ndhull {

/// How lengths are measured: input units, or after scaling the input to the unit cube.
class LengthUnit {
 public:
  LengthUnit() = default;
  /// unit cube: distances along a normal n are divided by the length that n has there.
  LengthUnit(const Frame& frame, bool unit_cube);

  /// Input units for one length unit along `normal` (dimension numbers).
  double input_per_unit(std::span<const double> normal) const;
  /// The direction and size that a gradient in input units has in length units: input_per_unit is its length.
  /// Linear.
  std::vector<double> gradient(std::span<const double> normal) const;
  const std::vector<double>& extents() const { return extents_; }

 private:
  std::vector<double> extents_;  // per column; empty: input units
  std::vector<double>
      directions_;  // flat input: orthonormal directions of the subspace in the cube, rank rows
};

/// R, rank x rank, row-major upper triangular, such that |R a| is the length of the gradient of the gauge
/// above the dual plane a, per length unit: a distance is a gauge / |R a|.
std::vector<double> gradient_factor(const Frame& frame, const LengthUnit& unit);

}  // namespace ndhull
