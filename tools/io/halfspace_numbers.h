// The numbers of halfspaces in results are those of rows in the file they were read from.
#pragma once

#include "approx/polytope/halfspace_intersection.h"
#include "tools/io/halfspace_reader.h"

namespace ndhull {

/// Names rows of the file instead of the halfspaces that were made of them: an equation is one row for its
/// two, and its weight in a proof is negative where the second has it.
void number_as_in_file(HalfspaceIntersection& intersection, const HalfspaceFile& file);

}  // namespace ndhull
