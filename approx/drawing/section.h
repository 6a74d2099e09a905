// Shells to draw: the inner and the outer planes of a hull cut by a flat of two or three axes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "approx/drawing/drawing_axes.h"
#include "approx/drawing/projection.h"
#include "approx/hull.h"

namespace ndhull {

/// The facets of a hull, seen from its interior point: all that sections need, from a hull or from a report.
struct CentredFacets {
  std::size_t dimension = 0;
  std::vector<double> centre;              ///< dimension numbers, strictly inside
  std::vector<double> normals;             ///< size() x dimension, unit length
  std::vector<double> heights;             ///< [distance, input] of a facet's plane above the centre, > 0
  std::vector<double> outer;               ///< [distance, input] certified, >= 0
  std::vector<double> inner;               ///< [distance, input] certified, <= 0
  std::vector<double> widths;              ///< [distance, length unit] outer - inner
  std::vector<double> areas;               ///< input units
  std::vector<double> subspace_equations;  ///< as Hull has them; empty unless the points are flat

  std::size_t size() const { return heights.size(); }
  std::span<const double> normal(std::size_t facet) const {
    return {normals.data() + facet * dimension, dimension};
  }
};

CentredFacets centred_facets(const Hull& hull);

/// A convex polyhedron (or polygon, with the third coordinate 0) about the origin of the axes.
struct Shell {
  struct Face {
    std::uint32_t source;                ///< the facet, or the plane, that the face lies in
    Point3 normal;                       ///< unit length, outward, in the coordinates of the axes
    std::vector<std::uint32_t> corners;  ///< counterclockwise seen from outside; two in a polygon
  };
  std::size_t dimension = 3;    ///< 2 or 3
  std::vector<Point3> corners;  ///< coordinates along the axes
  std::vector<Face> faces;      ///< ascending source
};

/// The region y with normals[f] . y <= heights[f] for all f.
///
/// Shapes    normals: heights.size() x dimension (2 or 3), any length, 0 too; heights > 0.
/// Returns   one face for every plane that carries one; coincident planes share one of theirs.
/// Throws    Error kUsage when the region is not bounded: some facets' planes are missing.
Shell bounded_by_planes(std::span<const double> normals, std::span<const double> heights,
                        std::size_t dimension);

/// The hull of `points` (rows x dimension, 2 or 3) as a shell; source is the index of the face itself.
/// Returns none when the points span fewer dimensions.
std::optional<Shell> shell_of_points(const PointView& points);

enum class ShellKind { kInner, kOuter };

/// The section of a hull's shell by the flat through the centre along the axes.
///
/// kOuter    bounded by the planes at the outer offsets: the hull and all input points of the flat are in it.
/// kInner    bounded by the planes at the inner offsets: it is part of the hull. (A ray from the centre
///           leaves the hull through a simplex of some facet, which is not below that facet's inner plane.)
/// Returns   one face for each facet that the flat cuts there; none when an inner plane is not clearly above
///           the centre: then the inner planes bound nothing around it.
/// Throws    Error kUsage when the planes leave the section open, as those of some facets only do.
/// Precondition  the axes lie in the subspace that the points span.
std::optional<Shell> section_shell(const CentredFacets& facets, const DrawingAxes& axes, ShellKind kind);

/// Indices of the facets of largest area, the largest first; of equal ones the lowest index first.
std::vector<std::uint32_t> largest_facets(const CentredFacets& facets, std::size_t count);

}  // namespace ndhull
