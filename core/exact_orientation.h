// Exact arithmetic on doubles: the sign of a plane's value, the orientation of points, and heights over
// simplices. The only part that uses CGAL: its d-dimensional kernel and GMP number types, which are under the
// LGPL.
#pragma once

#include <cstddef>
#include <span>

#include "core/plane_value.h"

namespace ndhull {

/// The value of `plane` at `point`, without any error in its sign.
///
/// Returns   the exact value, rounded; negative, 0 or positive exactly as the value is, also where the
///           rounded number would underflow to 0 (then the smallest subnormal of that sign).
/// Cost      a few microseconds, allocates.
double exact_plane_value(const CentredPlane& plane, std::span<const double> point);

/// Orientation of d + 1 points in d dimensions: the sign of det(p_1 - p_0, .., p_d - p_0), exact.
///
/// Shapes    points: (d + 1) x d, row-major. Precondition: d >= 1.
/// Returns   1, -1, or 0 when they lie in one hyperplane.
/// Cost      d <= 10: about 1-3 us where intervals decide, 40-800 us where only exact numbers do.
int exact_orientation(std::span<const double> points, std::size_t dimension);

/// How high a point stands over the hyperplane of a simplex, against what the simplex's own width explains.
enum class HeightTest {
  kWithin,    ///< not higher than width times the sum of its positive barycentric coordinates
  kAbove,     ///< higher
  kSingular,  ///< the simplex spans no hyperplane, or one that contains the normal
};

/// Solves point = sum_i lambda_i vertex_i + height * normal, sum_i lambda_i = 1, in rational numbers and
/// compares height with (outer - inner) * unit * the sum of the positive lambda_i.
///
/// Why this bound: let L be the distance from a plane with this normal below whose outer plane the point is,
/// and above whose inner plane the vertices are. Then height = L(point) - sum lambda_i L(vertex_i) =
/// (L(point) - outer) + sum lambda_i (outer - L(vertex_i)) <= sum over positive lambda_i of
/// lambda_i (outer - inner). No point of a sound facet is above it, however thin the simplex.
///
/// Shapes    vertices: d x d row-major; normal, point: d numbers. Cost O(d^3) rational operations.
HeightTest exact_height_test(std::span<const double> vertices, std::span<const double> normal,
                             std::span<const double> point, double outer, double inner, double unit);

}  // namespace ndhull
