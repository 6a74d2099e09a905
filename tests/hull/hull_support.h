// What the tests of the hull share: facets as vertex sets, certificates checked in long double, face numbers.
//
// Nothing here calls the library's own verifier: it would share a mistake with the hull.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "approx/hull.h"
#include "tests/support/named_polytopes.h"
#include "tools/points/generate.h"
#include "tools/points/point_set.h"

namespace ndhull {

/// Ids of the vertices of one facet, ascending.
using VertexSet = std::vector<std::uint32_t>;

inline Hull hull_of(const PointSet& set, const HullOptions& options = {}) {
  return convex_hull(set.view(), options);
}

/// Points of a family; the seed replays them.
PointSet family_points(PointFamily family, std::size_t n, std::size_t d, std::uint64_t seed);

/// One vertex set a facet, sorted: two hulls of the same points have the same facets exactly when these
/// agree.
std::vector<VertexSet> facet_sets(const Hull& hull);
/// The same with `id` replaced by new_of_old[id].
std::vector<VertexSet> renamed(const std::vector<VertexSet>& facets,
                               const std::vector<std::size_t>& new_of_old);
/// The rows of hull.vertices, in that order.
PointSet vertex_rows(const PointSet& set, const Hull& hull);
/// [distance] the largest extent of a column.
double extent_of(const PointSet& set);

/// Largest distance of an input point above a facet's certified outer plane, in input units and long double:
/// not positive when the certificate holds. 0 without facets.
long double largest_outer_excess(const Hull& hull, const PointView& points);
/// The same for the vertices of the facets' simplices below the inner planes.
long double largest_inner_excess(const Hull& hull, const PointView& points);

/// Expects every law of the result that holds for each input: planes certified against all points (long
/// double), neighbours symmetric, at least rank vertices and neighbours a facet, vertices and simplices
/// divided consistently, sums and extremes of the facets' numbers, a sound complex.
void expect_sound(const Hull& hull, const PointView& points);
inline void expect_sound(const Hull& hull, const PointSet& set) { expect_sound(hull, set.view()); }

/// Numbers of faces of the simplicial complex: [k] has dimension k, k < rank.
std::vector<std::uint64_t> face_numbers(const SimplicialComplex& complex);
/// Numbers of faces of the polytope whose facets these are, [k] of dimension k, k < rank; from intersections
/// of vertex sets alone. For a few hundred faces a dimension.
std::vector<std::uint64_t> lattice_face_numbers(const std::vector<VertexSet>& facets, std::size_t rank);
/// f_0 - f_1 + f_2 .. = 1 - (-1)^rank.
void expect_euler(const std::vector<std::uint64_t>& faces);

}  // namespace ndhull
