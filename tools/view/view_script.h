// The page's style and script, as they stand in it.
#pragma once

#include <string_view>

namespace ndhull {

extern const std::string_view kViewStyle;
/// Reads the element #scene and draws on #drawing: the same camera, order and looks as the SVG.
extern const std::string_view kViewScript;

}  // namespace ndhull
