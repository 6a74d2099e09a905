// Every point against every plane: how many pairs are above, and which comes closest. Decisions are exact.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/plane_value.h"
#include "core/points.h"

namespace ndhull {

/// Planes wherever they stand. `plane` may be called from several threads; its spans stay valid.
class PlaneSource {
 public:
  virtual ~PlaneSource() = default;
  virtual std::size_t count() const = 0;
  virtual CentredPlane plane(std::size_t row) const = 0;
};

/// A point and a plane. Ordered by distance, then by the lower ids.
struct PlanePair {
  double distance;    ///< value of the plane at the point over the length of its normal, input units
  std::size_t point;  ///< row of the view
  std::size_t plane;
};

struct PlaneScan {
  std::uint64_t pairs = 0;
  std::uint64_t above = 0;     ///< pairs whose value is positive: exactly, without tolerance
  std::uint64_t refined = 0;   ///< pairs that double arithmetic left open
  PlanePair worst{0.0, 0, 0};  ///< largest distance; distance > 0 exactly when above > 0. None without pairs.
};

/// Tests value(x) > 0 for all points x and planes (see CentredPlane).
///
/// Not promised  `refined` is the same on machines with other vector instructions; all else is, for any
///               number of threads.
/// Cost  points x planes x dimension multiplications, in vectors; points are read block by block, once for
///       each 4096 planes. Memory: some megabytes a thread.
PlaneScan scan_planes(const PointView& points, const PlaneSource& planes, DoubtfulSign doubtful);

}  // namespace ndhull
