// The vertices of a hull without its facets, and a choice of a few: #include <ndhull/extreme.h>,
// ndhull::extreme_points, ndhull::keep_points.
#pragma once

#include "approx/rays/extreme_points.h"    // IWYU pragma: export
#include "approx/reduction/kept_points.h"  // IWYU pragma: export
