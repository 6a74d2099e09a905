// How far points are from what planes enclose: membership in an outer polytope, many queries at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/points.h"

namespace ndhull {

/// The plane that a query is furthest above, or least below.
struct PlaneDistance {
  double distance = 0.0;    ///< [distance] signed, positive above: then the query is outside
  std::uint32_t plane = 0;  ///< row of the planes
};

/// Of each query the largest signed distance from any of the planes a.x + b <= 0.
///
/// Shapes   planes: rows of queries.dimension + 1: a of any length but zero, b. Result: one a query.
/// Sign     exact: a query on a plane has distance 0, one the last bit of a coordinate outside a positive
///          one.
/// Error    of a distance: (d / 2 + 4) 2^-53 of itself, nearly all from the normal's length. Of two planes
///          whose distances differ by less either may be named.
/// Threads  0: all cores. The result does not depend on it.
/// Throws   Error as HalfspaceSet does; kEmptyInput without planes; kUsage for rows of another length;
///          kNotFinite for a query with NaN or infinity.
/// Cost     queries x planes x (dimension + 1) multiplications, close to the machine's peak. A query that
///          rounding leaves two planes for is compared with all planes once more.
std::vector<PlaneDistance> distances_to_planes(const PointView& queries, std::span<const double> planes,
                                               unsigned threads = 0);

/// What the distance says of a hull whose outer planes these are, when no facet is wider than `width`.
enum class Membership {
  kOutside,      ///< above an outer plane, so not in the hull
  kWithinWidth,  ///< below all outer planes, but less than the width: in the hull or not
  kInside,       ///< so far below all of them that it is in the hull
};

/// The width is outer minus inner offset of the widest facet (Hull::max_facet_width). A ray from an interior
/// point leaves the hull through a facet, above its inner plane: what is below all inner planes is inside.
inline Membership membership_of(double distance, double width) {
  if (distance > 0.0) return Membership::kOutside;
  return distance > -width ? Membership::kWithinWidth : Membership::kInside;
}

}  // namespace ndhull
