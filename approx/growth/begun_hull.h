// A hull that was grown to drop points, as a beginning of the whole hull.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/complex/membership.h"
#include "core/frame.h"
#include "core/growth/growth.h"

namespace ndhull {

/// A hull of some rows of a set. None of them was shifted, and the frame suits the whole set.
struct BegunHull {
  Frame frame;    ///< its column ranges are those of the whole set
  HullBall ball;  ///< of the whole set
  GrownHull grown;
  std::vector<std::uint32_t> rows;  ///< which row of the set each of its points is

  /// Memory of its tables. [bytes]
  std::uint64_t bytes() const;
  /// Calls its points by their places among `kept`, ascending rows of the set. False, and of no use any more,
  /// when one of its vertices is not among them.
  bool rename_points(std::span<const std::uint32_t> kept);
};

}  // namespace ndhull
