// What halfspaces have in common: #include <ndhull/intersection.h>, call ndhull::intersect_halfspaces.
#pragma once

#include "approx/polytope/halfspace_intersection.h"  // IWYU pragma: export
