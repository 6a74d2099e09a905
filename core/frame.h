// The frame: the affine map from input coordinates to those that growth works in, chosen from the data.
//
// The combinatorics of a hull do not change under affine maps, so uneven axes, narrow slabs and data far from
// the origin cost nothing when the map takes them away. Distances are always stated in input units: planes
// are mapped back, points never are.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/points.h"

namespace ndhull {

/// y = map (x - centre). The centre is strictly inside the hull and has y = 0.
struct Frame {
  std::size_t dimension = 0;   ///< columns of the input
  std::size_t rank = 0;        ///< affine dimension of the input, rows of the map
  std::vector<double> centre;  ///< dimension numbers, input units
  std::vector<double> map;     ///< rank x dimension, row-major
  /// True when each row of the map has one entry, a power of two: then y has the rounding of x - centre only.
  bool is_diagonal = false;
  /// rank < dimension: independent directions of length 1 that span the affine subspace, rank x dimension;
  /// otherwise empty. Nearly orthogonal; small entries are right to all their digits, which orthogonalising
  /// would lose.
  std::vector<double> basis;
  std::vector<PointId> simplex;                ///< rank + 1 affinely independent points; centre is their mean
  std::vector<double> column_min, column_max;  ///< of the input
};

/// Chooses the frame.
///
/// Method    Columns are scaled by powers of two to extents near 1. A simplex is taken greedily: the point
///           furthest from the mean, then again and again the point furthest from the affine span so far (QR
///           with column pivoting); of more than 32,768 points, among some 4,096 of them if that gives a
///           well shaped one. The rank is reached when no point is further from the span than the
///           rounding of the input itself. If the simplex is well shaped the scaling is the frame, else the
///           map that makes the simplex regular.
/// Returns   rank 0 when all points are equal (then map and basis are empty, the simplex one point).
/// Throws    Error kEmptyInput, kDimensionTooLow, kNotFinite (row and column, from 0), kTooManyPoints.
/// Cost      O(n d rank) time, 8 n d bytes of scratch.
Frame fit_frame(const PointView& points);

/// Throws Error kDimensionTooLow, kEmptyInput, kTooManyPoints: no columns, no rows, more than ids can number.
void check_shape(const PointView& points);

/// Throws Error kNotFinite with the first row, and its column, that has NaN or infinity.
void check_finite(const PointView& points);

/// Throws Error kOutOfRange where a column varies by less than 1e-300 or by more than doubles hold: planes
/// would not be doubles.
void check_extents(const Frame& frame);

/// Maps all points: out is points.rows x rank, row-major. Coordinates carry the error of one rounding, also
/// where the map is ill-conditioned (products and sums are compensated; Ogita, Rump, Oishi. Accurate sum and
/// dot product. SISC 26(6), 2005).
void map_points(const PointView& points, const Frame& frame, double* out);

/// Normals in input coordinates of planes in the frame, not of unit length: each row of `out` is the sum of
/// the map's rows times the numbers of a plane, with the error of one rounding, as map_points.
///
/// Shapes  planes: count x rank. columns: those of the map, dimension x rank. out: count x dimension; the
///         same memory when rank equals dimension.
void map_normals(const double* planes, std::size_t count, std::span<const double> columns, std::size_t rank,
                 double* out);

}  // namespace ndhull
