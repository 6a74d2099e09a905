// Some of a hull's facets, and the volume below their outer planes: #include <ndhull/selection.h>, call
// ndhull::select_facets, ndhull::outer_volume.
#pragma once

#include "approx/polytope/outer_volume.h"      // IWYU pragma: export
#include "approx/selection/facet_selection.h"  // IWYU pragma: export
