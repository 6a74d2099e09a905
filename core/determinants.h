// The volumes of the cones from the origin over all simplices of a hull, as determinants.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/simplicial_complex.h"

namespace ndhull {

/// Solves for the plane through each simplex's own vertices and the volume of its cone to the origin.
///
/// Shapes  points: point_count x rank (the frame); determinants: complex.row_count, the determinant of the
/// vertex
///         rows = +-rank! times the volume of the cone. The rows are oriented alike, so the sign is the same
///         for all but simplices that are folded back over others; with signs their sum is right even then.
/// Planes  of simplices with a shifted vertex (`is_shifted`, one a point; empty: none) are replaced by the
/// solved
///         ones, except where the simplex is so thin that the two differ by more than 1e-6: such a simplex
///         has no plane of its own to speak of.
/// Cost    O(rank^3) a simplex, eight simplices at a time. Gaussian elimination, with partial pivoting for
/// simplices
///         whose planes are replaced, and where without it the solved plane differs from growth's by more
///         than 1e-11 or a diagonal entry below 1e-4 is met. What a simplex gets does not depend on those
///         beside it.
void solve_simplices(SimplicialComplex& complex, const double* points,
                     std::span<const std::uint8_t> is_shifted, std::span<double> determinants);

/// The same determinants with most of them from a neighbour's: simplices with planes a and b, and vertices v
/// and w opposite their ridge, have determinants in the ratio of 1 - b.v to 1 - a.w, how deep each vertex is
/// below the other's plane. For hulls without a shifted point, whose planes go through their vertices.
///
/// Shapes  points: point_count x rank. determinants: complex.row_count; of free rows 0.
/// Returns whether the areas times their normals sum to 0, as those of a closed surface do, to 1e-11 of
///         their sizes: if not, planes have lost digits, and the simplices are to be solved.
/// Error   rank roundings over the depth for each simplex on the way from one that was solved, of which there
///         are some ten: with depths down to 1e-4 up to 1e-10 in 8-d. Measured on spheres: mostly 1e-14, at
///         most 1.3e-11.
/// Cost    O(rank) a simplex and random reads of a plane, a determinant and a mark, by one thread, in the
/// order
///         of the rows; one in ten, which is before all of its neighbours, those with depths below 1e-4 and
///         those beside a simplex without volume are solved.
bool chain_determinants(const SimplicialComplex& complex, const double* points, std::size_t point_count,
                        std::span<double> determinants);

}  // namespace ndhull
