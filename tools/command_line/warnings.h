// Lines on standard error about results that are right, and may be taken for more than they say.
#pragma once

#include <cstddef>

#include "approx/hull.h"

namespace ndhull {

/// The planes written of flat data bound nothing off the subspace of the points.
void warn_of_open_subspace(std::size_t rank, std::size_t dimension);

/// Volume and areas printed of flat data are those of fewer dimensions. Where Qhull stops with QH6154.
void warn_of_flat_volume(std::size_t rank, std::size_t dimension);

/// A limit or Ctrl-C has ended the search for the vertices of an intersection. Nothing of one that is complete.
void warn_of_missing_vertices(HullStatus status);

}  // namespace ndhull
