// Planes of a hull as doubles that keep every point below them: #include <ndhull/planes.h>,
// ndhull::WrittenPlanes.
#pragma once

#include "approx/planes/written_planes.h"  // IWYU pragma: export
