// Planes that part vertices from all other points, as they are written.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "approx/geometry/frame_planes.h"
#include "core/frame.h"
#include "core/points.h"

namespace ndhull {

/// A vertex, and a plane below which all other points are.
struct PartingPlane {
  std::uint32_t vertex = 0;
  std::vector<double> normal;  ///< of length 1, input units
  double offset = 0.0;         ///< normal . x + offset is above 0 at the vertex
  /// The others are below the plane by this, proven but for the rounding of `normal` and `offset`; 0: nothing
  /// is proven. [distance]
  double gap = 0.0;
  /// How large the rounding of the numbers may be. [distance]
  double rounding = 0.0;
  bool is_settled = false;
  /// When settled: other points above the plane, as good as equal to the vertex.
  std::vector<std::uint32_t> above;
};

/// Planes of a frame in input units, for points that it was fitted to.
class PartingPlaneMap {
 public:
  /// origin   dimension numbers: what was taken off the input's coordinates to get `points`.
  /// Cost     of flat data a pass over the points, for how far they are from the subspace.
  PartingPlaneMap(const PointView& points, const Frame& frame, std::span<const double> origin);

  /// The plane a.y = level. `gap`: as PartingPlane, in the gauge's unit.
  PartingPlane map(std::uint32_t vertex, std::span<const double> plane, double level, double gap) const;

 private:
  const Frame& frame_;
  std::span<const double> origin_;
  NormalMap to_input_;
  double off_the_subspace_;    // at most, of any point [distance]
  std::vector<double> reach_;  // one a column: of points, from the centre
};

/// Looks at planes whose gap does not exceed their rounding, or that their vertex is not above: the offset is
/// chosen again, half way from the vertex to the highest other point along the normal, in twice the
/// precision, and the signs are decided exactly. Points that are as good as equal to the vertex may be on
/// either side; those above are listed.
///
/// Shapes   in_frame: points.rows x rank, row-major.
/// `near`   points no further than this from the vertex are as good as equal to it. [distance in the frame]
/// Planes that cannot be made to part their vertex, or that time does not suffice for, are removed.
/// Returns  false when time did not suffice.
/// Cost     a plane in doubt takes some 10 dimension operations a point.
bool settle_planes(const PointView& points, std::span<const double> in_frame, double near,
                   const std::function<bool()>& is_late, std::vector<PartingPlane>& planes);

/// Exactly.
bool is_above(const PartingPlane& plane, std::span<const double> point);

}  // namespace ndhull
