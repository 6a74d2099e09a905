// The volumes of the cones from the origin over all simplices of a hull, as determinants.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/complex/simplicial_complex.h"
#include "core/machine/blocks.h"

namespace ndhull {

/// Solves for the plane through each simplex's own vertices and the volume of its cone to the origin.
///
/// Shapes  points: point_count x rank (the frame); determinants: complex.row_count, the determinant of the
///         vertex rows = +-rank! times the volume of the cone. The rows are oriented alike, so the sign is
///         the same for all but simplices that are folded back over others; with signs their sum is right
///         even then.
/// Planes  of simplices with a shifted vertex (`is_shifted`, one a point; empty: none) are replaced by the
///         solved ones, except where the simplex is so thin that the two differ by more than 1e-6: such a
///         simplex has no plane of its own to speak of.
/// Cost    O(rank^3) a simplex, eight simplices at a time. Gaussian elimination, with partial pivoting for
///         simplices whose planes are replaced, and where without it the solved plane differs from growth's
///         by more than 1e-11 or a diagonal entry below 1e-4 is met. What a simplex gets does not depend on
///         those beside it.
void solve_simplices(SimplicialComplex& complex, const double* points,
                     std::span<const std::uint8_t> is_shifted, std::span<double> determinants);

/// The same determinants of a hull without a shifted point, whose planes go through their vertices: they are
/// not solved for.
///
/// Shapes  points: point_count x rank. determinants: complex.row_count; of free rows 0.
/// Returns whether the areas times their normals sum to 0, as those of a closed surface do, to 1e-11 of
///         their sizes: if not, planes have lost digits, and the simplices are to be solved.
/// Error   what elimination without pivots loses where no diagonal entry is below 1e-4; simplices that have
///         smaller ones are solved.
/// `also`  is called for blocks of all rows while they are in cache, by the thread that has them there.
/// Cost    O(rank^3) a simplex, eight simplices at a time, three fifths of solving them.
bool find_determinants(const SimplicialComplex& complex, const double* points, std::span<double> determinants,
                       const BlockWork& also);

/// The planes through simplices that no complex has, as dual vertices, and their determinants.
///
/// Shapes  points: any number x rank. vertices: simplices x rank, rows of the points. planes: simplices x
///         rank. determinants: one a simplex, of its vertex rows, +-rank! times the volume of its cone.
/// Of a simplex without volume they are 0, infinite or NaN.
/// Cost    O(rank^3) a simplex, eight simplices at a time, by the calling thread: Gaussian elimination with
///         partial pivoting. What a simplex gets does not depend on those beside it.
void solve_planes(std::size_t rank, const double* points, std::span<const std::uint32_t> vertices,
                  std::span<double> planes, std::span<double> determinants);

}  // namespace ndhull
