// The shadow of a hull on two or three axes: everything that projects to them, not only what lies in a flat.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "approx/drawing/drawing_axes.h"
#include "approx/drawing/section.h"
#include "approx/work_end.h"
#include "core/ids.h"
#include "core/points.h"

namespace ndhull {

/// The projections of the inner hull and of the polytope that the outer planes bound.
struct Shadow {
  Shell inner;                 ///< hull of the projected vertices
  std::optional<Shell> outer;  ///< contains the projection of the outer polytope, so of all input points
  /// [ratio] of each face of `inner`: how much further from the centre the outer shell's plane is, minus 1.
  std::vector<double> margins;
};

/// Projects the hull along the axes.
///
/// inner     is exact up to rounding.
/// outer     one plane parallel to each face of `inner`, where a linear program says that the outer polytope
///           reaches, up to rounding; at most `outer_ratio` times the face's own distance. None when neither
///           is finite. When `end` has come that multiple is taken for the other faces.
/// Cost      O(facets dimension) for each facet that reaches furthest in one program for each face of `inner`,
///           and once a face; no program when outer_ratio tells that nothing would be seen.
/// Returns   none when the projected vertices span fewer dimensions than there are axes.
std::optional<Shadow> hull_shadow(const CentredFacets& facets, const PointView& points,
                                  std::span<const PointId> vertices, const DrawingAxes& axes,
                                  const WorkEnd& end = {});

/// [ratio] The outer polytope lies in the hull scaled about the centre by this; infinite when an inner plane
/// is not above the centre.
///
/// Proof  A ray from the centre leaves the hull through a simplex of some facet, at a height of at least
///        height + inner over the centre, and the outer polytope at a height of at most height + outer of it.
double outer_ratio(const CentredFacets& facets);

/// Rows of the points' coordinates along the axes: ids.size() x axes.count().
std::vector<double> coordinates_along(const DrawingAxes& axes, const PointView& points,
                                      std::span<const PointId> ids);

}  // namespace ndhull
