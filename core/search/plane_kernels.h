// The products of many planes with many points that certificates, volumes and planes are made of. Each is
// compiled for every instruction set and every usual dimension, and knows nothing of growth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/complex/simplicial_complex.h"
#include "core/id_rows.h"

namespace ndhull {

/// Largest dot product of each normal with any of the points.
///
/// Shapes  normals: facets x dimension; points: any number of rows x dimension; max_dot: one a facet.
/// Error   each dot product is a chain of fused multiply-adds: at most gamma_dimension sum |n_k x_k|
///         (Higham. Accuracy and Stability of Numerical Algorithms, 2nd ed., eq. 3.5).
/// Cost    facets x points x dimension fused multiply-adds, at close to the machine's peak. Where the facets'
///         own vertices are known, core/search/highest_dots.h needs less.
void max_dots(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
              std::span<double> max_dot);

/// Smallest and largest dot product of the normals of simplices `first` and on with their own vertices.
///
/// Shapes  normals: rows x dimension, from that simplex on; points: any number of rows x dimension;
/// row_of_point: the row of each
///         PointId in `points`; low, high: one a simplex, for as many as wanted. Error as above.
void own_dots(const SimplicialComplex& complex, std::size_t first, std::size_t dimension,
              std::span<const double> normals, std::span<const double> points,
              std::span<const std::uint32_t> row_of_point, std::span<double> low, std::span<double> high);

/// Smallest and largest dot product of each normal with the points in its row of `lists`: rows of `points`,
/// at least one; and how many are within kCloseProducts (core/search/highest_dots.h) of the largest. Shapes
/// and error as above.
void listed_dots(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
                 const IdRows& lists, std::span<double> low, std::span<double> high,
                 std::span<std::uint32_t> close);

/// Marks both sides of the flat ridges of some simplices: those across which the opposite vertex of either
/// side is less than `tolerance` (a gauge) below the other side's plane.
///
/// Shapes  points: any number of rows x rank; looks_at: row_count, not 0 for the simplices to look at;
///         is_flat: row_count, set to 1 for each simplex found, else untouched.
/// Cost    rank plane evaluations and rank random reads of neighbours a simplex looked at.
void mark_flat(const SimplicialComplex& complex, const double* points, double tolerance,
               std::span<const std::uint8_t> looks_at, std::span<std::uint8_t> is_flat);

}  // namespace ndhull
