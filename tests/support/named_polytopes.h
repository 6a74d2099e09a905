// Polytopes whose facets are known in closed form or from the literature: the oracle of tests and benchmarks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/points/point_set.h"

namespace ndhull {

/// Points and what their hull must be. Facets are counted after coplanar simplices are merged.
struct NamedPolytope {
  std::string name;  ///< with parameters, as in "cube(5)"
  PointSet points;
  std::size_t rank = 0;  ///< affine dimension of the points
  std::uint64_t facets = 0;
  std::size_t vertices = 0;      ///< rows that are vertices; no row is given twice
  std::optional<double> volume;  ///< of dimension rank, relative error of a few 2^-53; none: not known here
};

/// Corners of [-1, 1]^d: 2 d facets.
NamedPolytope cube(std::size_t d);
/// +-e_i: 2^d facets.
NamedPolytope cross_polytope(std::size_t d);
/// 0 and e_i: d + 1 facets.
NamedPolytope simplex(std::size_t d);
/// The regular polytopes that exist in 4-d only: 24 octahedra; 600 tetrahedra (120 vertices); 120 dodecahedra
/// (600 vertices). Coordinates as in Coxeter. Regular Polytopes. Dover, 1973; the last two are rounded.
NamedPolytope cell_24();
NamedPolytope cell_600();
NamedPolytope cell_120();
/// All orders of 1 .. n: n! vertices in n coordinates, rank n-1, 2^n - 2 facets. Precondition: n >= 2.
NamedPolytope permutahedron(std::size_t n);
/// The n x n permutation matrices: n^2 coordinates, rank (n-1)^2, n^2 facets (2 for n = 2).
/// Precondition: n >= 2.
NamedPolytope birkhoff(std::size_t n);
/// n points of the curve (cos t, sin t, cos 2t, ..) or (t, t^2, .., t^d). Precondition: n > d; d even for
/// the first. The moment curve is rounded: with many points in high dimensions doubles no longer hold its
/// facets apart.
NamedPolytope cyclic_trigonometric(std::size_t n, std::size_t d);
NamedPolytope moment_curve(std::size_t n, std::size_t d);
/// {0, .., side-1}^d: 2 d facets, 2^d vertices among side^d points. Precondition: side >= 2.
NamedPolytope grid(std::size_t side, std::size_t d);
/// Cuts of the complete graph on n nodes: 2^(n-1) points in n(n-1)/2 coordinates. Precondition: 3 <= n <= 7.
/// Source of the counts: Deza, Laurent. Geometry of Cuts and Metrics. Springer, 1997, sec. 30.6.
NamedPolytope cut_polytope(std::size_t n);
/// Linear orders of n things: n! points in n(n-1) coordinates, rank n(n-1)/2. Precondition: 3 <= n <= 6.
/// Source of the counts: Marti, Reinelt. The Linear Ordering Problem. Springer, 2011, ch. 6.
NamedPolytope linear_ordering(std::size_t n);
/// simplex(a) x simplex(b): (a+1)(b+1) vertices, a + b + 2 facets. Precondition: a, b >= 1.
NamedPolytope product_of_simplices(std::size_t a, std::size_t b);

/// Facets of the cyclic polytope with n vertices in d dimensions, the most that n points can have.
/// Precondition: n > d >= 1 and the result fits.
/// Source  Gale. Neighborly and cyclic polytopes. Proc. Symp. Pure Math. 7, 1963. McMullen. The maximum
///         numbers of faces of a convex polytope. Mathematika 17, 1970.
std::uint64_t cyclic_facet_count(std::uint64_t n, std::uint64_t d);

/// One of each kind above, small enough for a property test: at most 720 points, at most 16-d in rank.
std::vector<NamedPolytope> small_named_polytopes();

}  // namespace ndhull
