// Is every point inside the hull? A proof for each point that does not rest on how the hull was grown.
//
// Proof. If y = sum lambda_i v_i with lambda_i >= 0 over the vertices v_i of one simplex and s = sum
// lambda_i, then y lies in the hull of the input scaled by s about the interior point (which is 0). Whatever
// the simplex is and however it was found, that is true; a wrong one only gives a useless s. Small negative
// lambda_i and the residual of the sum are covered with a ball inside the hull.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// A point and the simplex in whose cone it lies, or was last looked for.
struct LocatedPoint {
  PointId point;
  SimplexId simplex;
  /// Proven upper bound on (scale at which the hull holds the point) - 1; +inf: no proof.
  double gauge = 0.0;
  double slack = 0.0;  ///< the part of it that covers negative coordinates and rounding
};

/// The numbers a proof needs besides the complex.
struct HullBall {
  double inner_radius = 0.0;  ///< of a ball around 0 that the first simplex contains, proven
  double reach = 0.0;         ///< longest point
};

/// Points further inside than this, by their gauge, need no look at their distance from each plane and may be
/// dropped. [ratio]
inline constexpr double kWellInside = 1e-9;

/// Products that looking for better simplices everywhere may cost.
inline constexpr double kSearchProducts = 1e10;

/// Radius of a ball around 0 inside the simplex with these rank + 1 vertices, and the reach of all points.
HullBall find_ball(std::size_t rank, const double* points, std::size_t point_count,
                   std::span<const PointId> simplex);

/// Finds for each of `queries` the simplex whose cone it lies in (hill climbing, then walking along negative
/// coordinates, then all simplices) and proves its gauge.
///
/// Shapes  points: any number of rows x rank.  Result: one entry a query, in their order.
/// useful  slack in a proof that is worth looking for a better simplex. [ratio]
/// Cost    a few steps of rank plane evaluations and one linear system of size rank for each query. Where
///         walking ends in a proof with slack all simplices are tried (counted in `searched_all`), unless
///         that would be more than `most_products`, one for each coordinate: then the proofs stay as they
///         are.
std::vector<LocatedPoint> prove_inside(const SimplicialComplex& complex, const double* points,
                                       const HullBall& ball, std::span<const PointId> queries, double useful,
                                       std::uint64_t& searched_all, double most_products = kSearchProducts);

/// The same with hill climbing alone: what is not proven at once is +inf or far too large. Points above the
/// simplex found are not proven at all: their slack is +inf, their gauge how far they are above it.
std::vector<LocatedPoint> try_inside(const SimplicialComplex& complex, const double* points,
                                     const HullBall& ball, std::span<const PointId> queries);
/// The same for queries that are no points of the hull: located.size() x rank coordinates. Entry i is for row
/// i.
void try_inside(const SimplicialComplex& complex, const double* points, const HullBall& ball,
                const double* query_points, std::span<LocatedPoint> located);

}  // namespace ndhull
