// A scene as a page: title, drawing, legend.
#pragma once

#include <string>

#include "tools/view/view_scene.h"

namespace ndhull {

/// One SVG document, complete with styles; it refers to nothing outside itself.
std::string scene_svg(const Scene& scene);

/// The legend alone, an element for another page.
std::string scene_legend_svg(const Scene& scene);

}  // namespace ndhull
