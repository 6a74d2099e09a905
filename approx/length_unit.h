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
  const std::vector<double>& extents() const { return extents_; }

 private:
  std::vector<double> extents_;  // per column; empty: input units
  std::vector<double>
      directions_;  // flat input: orthonormal directions of the subspace in the cube, rank rows
};

}  // namespace ndhull
