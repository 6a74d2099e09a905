// The simplices of a pulling triangulation, for those who want them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/whole_facets/face_pulling.h"

namespace ndhull {

/// Shapes  first_rows: the vertices of the facets that are simplices, which come first, in the order that
///         orients them alike; rank each.
/// Returns a complex as core/complex/simplicial_complex.h describes: closed, oriented alike.
/// Throws  Error kTooManySimplices more than 2^27 simplices.
/// Cost    O(s rank^2) for s simplices.
GroupedComplex make_complex(const PulledFaces& faces, std::span<const std::uint32_t> first_rows);

}  // namespace ndhull
