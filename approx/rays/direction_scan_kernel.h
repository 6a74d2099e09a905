// The vector loop of a direction scan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/rays/direction_scan.h"

namespace ndhull {

/// Directions that the loop takes at once: with two vectors of points eight accumulators, enough to hide the
/// latency of a multiply-add on any machine with sixteen registers.
inline constexpr std::size_t kDirectionGroup = 4;

/// The loop's own state of a query. `threshold` rises to the largest product once one is above `refute`.
struct DirectionState {
  float threshold;
  float refute;
  std::uint32_t skip;
  std::uint32_t furthest = DirectionQuery::kNoPoint;
  float furthest_product = 0.0F;
  std::uint32_t end_tile = 0;  ///< tiles from here on need no look
  bool is_refuted = false;
};

struct NearPoint {
  std::uint32_t direction;
  std::uint32_t id;
};

/// Scans tiles begin .. end. `count` is a multiple of kDirectionGroup; appends to `near` what is above a
/// threshold and refutes nothing.
void scan_tiles(const ScanTiles& tiles, std::size_t begin, std::size_t end, const float* directions,
                DirectionState* states, std::size_t count, std::vector<NearPoint>& near);

}  // namespace ndhull
