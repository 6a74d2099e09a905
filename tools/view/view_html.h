// A scene as one page that can be turned with the mouse.
#pragma once

#include <string>

#include "tools/view/view_scene.h"

namespace ndhull {

/// One HTML document with all it needs in it: it loads nothing. Without scripts it says so; a flat scene has
/// nothing to turn and stands in it as SVG.
std::string scene_html(const Scene& scene);

}  // namespace ndhull
