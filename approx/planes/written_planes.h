// Planes of a hull as rows of doubles that keep their promise after they were rounded.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "approx/hull.h"
#include "core/plane_value.h"
#include "core/points.h"

namespace ndhull {

/// Which of a facet's three parallel planes.
enum class PlaneKind {
  kOuter,  ///< every input point is below or on it
  kMean,   ///< the facet's own plane, rounded
  kInner,  ///< every vertex of the facet is above or on it
};
std::string_view to_string(PlaneKind kind);

/// The offset b of a row that stands for a claim: n . x + b <= 0 for every x that is not above the parallel
/// plane at `plane.claimed` and has |x_k| <= largest[k], in exact arithmetic and as doubles evaluate it in
/// any order; with direction -1, n . x + b >= 0 for every such x that is not below that plane.
double written_offset(const CentredPlane& plane, std::span<const double> largest, double direction);

/// Per column the largest |coordinate|. Cost: reads all points once.
std::vector<double> largest_coordinates(const PointView& points);

/// Gives the planes of a hull one by one, in input units, for files and other programs.
///
/// Promise   kOuter: normal.x + offset <= 0 for every input point x, in exact arithmetic for the doubles that
///           are given, and also when it is evaluated in doubles, in any order of summation, fused or not.
///           kInner: the same with >= 0 for every vertex of the facet. kMean: hull.offset(facet), no promise.
/// Cost      the plane is moved by the error of evaluating it, a few units in the last place of the largest
///           product: what data far from the origin lose by being written as planes through it.
/// Flat data the rows are those of the facets; subspace_planes gives those of the equations.
/// Lifetime  the hull must outlive this object. Construction reads all points once.
class WrittenPlanes {
 public:
  WrittenPlanes(const Hull& hull, const PointView& points, PlaneKind kind);

  /// Fills `row`, which has dimension + 1 numbers: unit outward normal, offset.
  /// Throws Error kNotFinite where the offset overflows: coordinates near the largest double.
  void fill(FacetId facet, std::span<double> row) const;

 private:
  const Hull& hull_;
  PlaneKind kind_;
  std::vector<double> largest_;  // per column: largest |coordinate| of the input
};

/// The planes that bound flat data off the subspace that they lie in: of each equation of it two opposite
/// ones, as rows of dimension + 1 numbers. None where there are no equations.
///
/// Shapes    equations: Hull::subspace_equations.
/// Promise   that of WrittenPlanes, with all points in the place of a facet's vertices: between the outer
///           planes of an equation there is the rounding by which points are off their subspace, and no more.
/// Cost      reads all points once, when there are equations.
std::vector<double> subspace_planes(std::span<const double> equations, const PointView& points,
                                    PlaneKind kind);

}  // namespace ndhull
