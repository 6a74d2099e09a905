// The points outside a hull that the next one is grown from.
#pragma once

#include <cstdint>
#include <vector>

#include "core/ids.h"

namespace ndhull {

/// A point that is outside the hull, by at most this gauge, over this simplex.
struct OutsidePoint {
  double gauge;
  std::uint32_t id;
  SimplexId simplex;
  bool operator<(const OutsidePoint& other) const {  // the furthest first
    return gauge != other.gauge ? gauge > other.gauge : id < other.id;
  }
};

/// The furthest point over each simplex, at most 4,096 of them, the furthest first. What is not among the
/// first so many of a part of the points is not among those of all: the result of parts is that of the whole.
void keep_furthest(std::vector<OutsidePoint>& points);

}  // namespace ndhull
