// Convex hull of points: #include <ndhull/hull.h>, link ndhull::ndhull, call ndhull::convex_hull.
#pragma once

#include "approx/hull.h"  // IWYU pragma: export
