// The largest facets, also of a hull that cannot be built: #include <ndhull/largest.h>,
// ndhull::largest_facets.
#pragma once

#include "approx/rays/largest_facets.h"  // IWYU pragma: export
