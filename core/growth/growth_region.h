// What regions of a hull that grow at the same time have each for themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/growth/growth.h"
#include "core/machine/huge_array.h"

namespace ndhull {

/// A point that a region may add: the head of an outside set.
struct RegionApex {
  std::uint32_t point;
  double height;  ///< or gauge, as growth orders points
  double reach;   ///< about how far dual vertices of simplices that it sees are from that of its simplex
  double value;   ///< of its simplex, beside the border
};

/// The furthest first; of equal ones the lower point.
void sort_by_height(std::vector<RegionApex>& apexes);

/// Dual vertices a with weights[0] a[axes[0]] + weights[1] a[axes[1]] > least.
struct RegionBorder {
  std::size_t axes[2] = {0, 1};
  double weights[2] = {1.0, 0.0};
  double least = 0.0;

  RegionBorder reversed() const { return {{axes[0], axes[1]}, {-weights[0], -weights[1]}, -least}; }
};

/// A point that climbed as far as the border.
struct HaltedPoint {
  std::uint32_t point, row;
};

/// The simplices whose dual vertices are within a border.
struct GrowthRegion {
  RegionBorder border;
  double clearance = 0.0;     ///< points nearer to the border than so many times their reach are not tried
  double band_floor = 0.0;    ///< points that are lower in the order of growth are not tried
  double least_height = 0.0;  ///< nor are points whose height is no more than this
  std::uint64_t most_created = 0;

  std::vector<RegionApex> apexes;  ///< the furthest first
  HugeArray<std::uint32_t> free_rows;
  std::size_t free_count = 0;
  std::size_t row_count = 0, row_end = 0;  ///< of the rows that it may use for the first time: next, and end
  std::uint64_t points_outside = 0;        ///< how many more, modulo 2^64
  GrowthCounters counters;
  std::vector<std::uint32_t> written;  ///< points whose heights have changed
  std::vector<HaltedPoint> halted;
};

}  // namespace ndhull
