// Which points are as good as equal to an earlier one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ndhull {

/// Of each point the first that is no further from it than `distance` and stands for itself; itself, if there
/// is none. Distance 0: of equal points the first.
///
/// Shapes  rows: count x dimension, row-major.
/// Cost    a sort by a random projection, and a look at those that are as near along it.
std::vector<std::uint32_t> find_near_copies(const double* rows, std::size_t count, std::size_t dimension,
                                            double distance);

}  // namespace ndhull
