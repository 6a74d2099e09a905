// What a plane and a volume in the frame are in input units.
#pragma once

#include <cstddef>
#include <vector>

#include "core/frame.h"

namespace ndhull {

/// |det| of the frame's map on the subspace of the data: frame volume per input volume.
double volume_scale(const Frame& frame);

/// Unit normals in input coordinates of planes in the frame; of flat data, normals that lie in the subspace.
///
/// Shapes   planes: count x rank. out: count x dimension; the same memory when rank equals dimension.
/// lengths  count numbers, or null: the length of the normal before it was made a unit one, which is one over
///          the distance [input units] of the plane a.y = 1 from the frame's centre.
void map_normals(const Frame& frame, const double* planes, std::size_t count, double* out,
                 double* lengths = nullptr);

/// Rows normal, offset of dimension - rank independent equations normal . x + offset = 0 of the subspace that
/// the data lie in; empty when that is the whole space.
std::vector<double> find_subspace_equations(const Frame& frame);

/// Bound on the error of a computed sum of `terms` products of the given size: gamma_terms * size.
/// Source  Higham. Accuracy and Stability of Numerical Algorithms, 2nd ed., eq. 3.5.
double sum_error(std::size_t terms, double size);

}  // namespace ndhull
