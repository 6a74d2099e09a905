// What halfspaces have in common: #include <ndhull/intersection.h>, call ndhull::intersect_halfspaces.
#pragma once

#include "approx/halfspace_intersection.h"  // IWYU pragma: export
