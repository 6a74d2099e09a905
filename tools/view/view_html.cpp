#include "tools/view/view_html.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/view/view_drawing.h"
#include "tools/view/view_script.h"
#include "tools/view/view_svg.h"

namespace ndhull {
namespace {

using Json = nlohmann::ordered_json;

/// Five decimals: a hundredth of a pixel on a large screen.
double rounded(double value) { return std::round(value * 1e5) / 1e5 + 0.0; }

Json json_of(const Point3& point) { return {rounded(point[0]), rounded(point[1]), rounded(point[2])}; }

Json json_of(const SceneShell& shell, bool is_glass) {
  Json corners = Json::array(), faces = Json::array();
  for (const Point3& corner : shell.corners) corners.push_back(json_of(corner));
  for (const SceneFace& face : shell.faces) {
    Json json{{"corners", face.corners}, {"normal", json_of(face.normal)}};
    if (!is_glass) {
      json["fill"] = hex(lit(face.colour, brightness_of(face.normal)));
      json["facet"] = face.source;
      json["mark"] = face.mark;
      json["tip"] = face.tip;
    }
    faces.push_back(std::move(json));
  }
  return {{"corners", std::move(corners)}, {"faces", std::move(faces)}};
}

Json json_of(const SceneAxis& axis) {
  Json ticks = Json::array();
  for (const Tick& tick : axis.ticks) ticks.push_back({{"at", rounded(tick.value)}, {"label", tick.label}});
  return {{"name", axis.name}, {"low", rounded(axis.low)}, {"high", rounded(axis.high)}, {"ticks", ticks}};
}

Json json_of(const Scene& scene) {
  const bool both = scene.inner.has_value() && scene.outer.has_value();
  const Camera camera = first_camera();
  Json json;
  json["camera"] = {{"azimuth", camera.azimuth},
                    {"elevation", camera.elevation},
                    {"distance", camera.distance},
                    {"field_of_view", camera.field_of_view}};
  json["axes"] = Json::array();
  for (const SceneAxis& axis : scene.axes) json["axes"].push_back(json_of(axis));
  json["solid"] = json_of(scene.inner.has_value() ? *scene.inner : *scene.outer, false);
  json["glass"] = both ? json_of(*scene.outer, true) : Json(nullptr);
  json["outlines"] = Json::array();
  for (const SceneOutline& outline : scene.outlines) {
    for (const auto& [from, to] : outline.edges) json["outlines"].push_back({json_of(from), json_of(to)});
  }
  json["mark_colour"] = kMarkColour;
  return json;
}

/// JSON that may stand inside <script>: no letter in it can end the element.
std::string for_script(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

std::string switch_box(std::string_view id, std::string_view text) {
  return fmt::format("<label><input type=\"checkbox\" id=\"{}\" checked> {}</label>\n", id, text);
}

std::string solid_body(const Scene& scene) {
  std::string text = fmt::format("<h1>{}</h1>\n", escaped(scene.title));
  for (const std::string& fact : scene.facts) text += fmt::format("<p>{}</p>\n", escaped(fact));
  text +=
      "<main>\n<div id=\"stage\"><canvas id=\"drawing\" tabindex=\"0\" aria-label=\"the hull; drag or use "
      "the "
      "arrow keys to turn it\"></canvas><div id=\"tip\" hidden></div></div>\n<aside>\n";
  text += scene_legend_svg(scene);
  text += "<form>\n";
  if (scene.inner.has_value() && scene.outer.has_value()) text += switch_box("show-outer", "outer shell");
  if (!scene.mark_text.empty()) text += switch_box("show-marks", "largest facets");
  text += switch_box("show-box", "axes");
  text +=
      "<button type=\"button\" id=\"reset\">first view</button>\n</form>\n"
      "<p>drag: turn \u00B7 wheel: nearer, further \u00B7 point at a face: what it is</p>\n"
      "</aside>\n</main>\n<noscript>Turning the drawing needs JavaScript.</noscript>\n";
  text += "<script id=\"scene\" type=\"application/json\">" + for_script(json_of(scene)) + "</script>\n";
  return text + "<script>" + std::string(kViewScript) + "</script>\n";
}

}  // namespace

std::string scene_html(const Scene& scene) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  // Without this a browser asks the server for an icon.
  text += "<link rel=\"icon\" href=\"data:,\">\n";
  text += fmt::format("<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n", escaped(scene.title),
                      kViewStyle);
  text += scene.dimension == 3 ? solid_body(scene) : scene_svg(scene);
  return text + "</body>\n</html>\n";
}

}  // namespace ndhull
