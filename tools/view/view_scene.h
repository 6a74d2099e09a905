// What a picture shows, before it is drawn: shells in the drawing's own units, colours, axes, texts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "approx/drawing/projection.h"
#include "approx/work_end.h"
#include "tools/view/view_input.h"
#include "tools/view/view_scale.h"

namespace ndhull {

enum class ViewKind {
  kSection,  ///< what lies in the flat through the interior point along the axes
  kShadow,   ///< what projects to the axes
};

struct ViewWish {
  ViewKind kind = ViewKind::kSection;
  std::vector<std::size_t> columns;  ///< from 0; empty: principal components
  std::size_t highlight = 5;         ///< facets of largest area that are marked
  WorkEnd end = {};                  ///< of what only makes the picture sharper
};

struct SceneFace {
  std::vector<std::uint32_t> corners;  ///< counterclockwise seen from outside
  Point3 normal{};
  Colour colour{};
  std::uint32_t source = 0;  ///< the facet of a section
  std::size_t mark = 0;      ///< its place among the largest facets, from 1; 0: none
  std::string tip;           ///< what it is, lines separated by \n
};

/// A convex body in units in which the drawing is two high.
struct SceneShell {
  std::vector<Point3> corners;
  std::vector<SceneFace> faces;
};

/// The outline of a facet's own shadow.
struct SceneOutline {
  std::size_t mark = 0;
  std::vector<std::pair<Point3, Point3>> edges;
};

struct SceneAxis {
  std::string name, remark;
  double low = -1.0, high = 1.0;  ///< of the box around the drawing
  std::vector<Tick> ticks;        ///< values in the drawing's units
};

struct Scene {
  std::size_t dimension = 3;
  std::string title;
  std::vector<std::string> facts;  ///< lines below the title
  std::optional<SceneShell> inner, outer;
  std::string inner_text, outer_text;  ///< of the legend
  std::string mark_text;               ///< empty without marks
  std::vector<SceneOutline> outlines;
  std::vector<SceneAxis> axes;
  ColourScale scale;
  std::string stretch_text;  ///< empty when all axes have one unit
};

/// Builds the scene.
/// Throws Error kUsage when the axes cannot be drawn: the points are flat along them, or span no plane.
Scene make_scene(const ViewedHull& viewed, const ViewWish& wish);

/// 53940 as 53,940.
std::string with_commas(std::uint64_t count);

}  // namespace ndhull
