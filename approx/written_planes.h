// Planes of a hull as rows of doubles that keep their promise after they were rounded.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "approx/hull.h"
#include "core/points.h"

namespace ndhull {

/// Which of a facet's three parallel planes.
enum class PlaneKind {
  kOuter,  ///< every input point is below or on it
  kMean,   ///< the facet's own plane, rounded
  kInner,  ///< every vertex of the facet is above or on it
};
std::string_view to_string(PlaneKind kind);

/// Gives the planes of a hull one by one, in input units, for files and other programs.
///
/// Promise   kOuter: normal.x + offset <= 0 for every input point x, in exact arithmetic for the doubles that
///           are given, and also when it is evaluated in doubles, in any order of summation, fused or not.
///           kInner: the same with >= 0 for every vertex of the facet. kMean: hull.offset(facet), no promise.
/// Cost      the plane is moved by the error of evaluating it, a few units in the last place of the largest
///           product: what data far from the origin lose by being written as planes through it.
/// Flat data the rows are those of the facets; the equations of the subspace are not among them.
/// Lifetime  the hull must outlive this object. Construction reads all points once.
class WrittenPlanes {
 public:
  WrittenPlanes(const Hull& hull, const PointView& points, PlaneKind kind);

  /// Fills `row` with dimension + 1 numbers: unit outward normal, offset.
  /// Throws Error kNotFinite where the offset overflows: coordinates near the largest double.
  void fill(FacetId facet, std::span<double> row) const;

 private:
  double certified_offset(FacetId facet, double claimed, double direction) const;

  const Hull& hull_;
  PlaneKind kind_;
  std::vector<double> largest_;  // per column: largest |coordinate| of the input
};

}  // namespace ndhull
