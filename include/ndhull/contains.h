// Which points are inside outer planes, and how far: #include <ndhull/contains.h>, call
// ndhull::distances_to_planes.
#pragma once

#include "approx/planes/contains.h"  // IWYU pragma: export
