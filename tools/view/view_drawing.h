// The drawing in the middle of a picture, as SVG: box with scales, shells, marks.
#pragma once

#include <string>

#include "approx/drawing/projection.h"
#include "tools/view/view_scene.h"

namespace ndhull {

/// A place on the page. [px] y grows downwards
struct PageArea {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

/// The colour of marks and the brightness of faces under the light, for all kinds of pictures.
inline constexpr const char* kMarkColour = "#d9480f";
double brightness_of(const Point3& normal);

/// Where the camera stands at first.
Camera first_camera();

/// SVG elements. Faces are <polygon class="face inner|outer" data-facet="..">, those that are turned away are
/// left out; in a flat drawing they are <line>. Shells are convex, so nothing has to be sorted.
std::string draw_scene(const Scene& scene, const PageArea& area);

/// `text` for XML and HTML: & < > " escaped, control characters and what is no UTF-8 replaced.
std::string escaped(const std::string& text);

}  // namespace ndhull
