#include "tools/view/view_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ndhull {
namespace {

struct PagePoint {
  double x = 0.0, y = 0.0;
};

Point3 in_box(const Scene& scene, std::size_t axis, double value, std::array<bool, 3> is_high) {
  Point3 point{};
  for (std::size_t k = 0; k < scene.dimension; ++k) {
    point[k] = is_high[k] ? scene.axes[k].high : scene.axes[k].low;
  }
  point[axis] = value;
  return point;
}

/// Turns scene points into page points so that the box fills the area, with room for its scales.
class Page {
 public:
  Page(const Scene& scene, const PageArea& area) {
    if (scene.dimension == 3) camera_.emplace(first_camera(), area.width, area.height);
    double low_x = std::numeric_limits<double>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;
    for (unsigned corner = 0; corner < (1U << scene.dimension); ++corner) {
      Point3 point{};
      for (std::size_t k = 0; k < scene.dimension; ++k) {
        point[k] = (corner >> k & 1U) != 0 ? scene.axes[k].high : scene.axes[k].low;
      }
      const PagePoint at = unscaled(point);
      low_x = std::min(low_x, at.x);
      high_x = std::max(high_x, at.x);
      low_y = std::min(low_y, at.y);
      high_y = std::max(high_y, at.y);
    }
    const double margin = scene.dimension == 3 ? 50.0 : 70.0;  // [px] tick labels and names
    scale_ =
        std::min((area.width - 2 * margin) / (high_x - low_x), (area.height - 2 * margin) / (high_y - low_y));
    shift_ = {area.x + 0.5 * area.width - 0.5 * scale_ * (low_x + high_x),
              area.y + 0.5 * area.height - 0.5 * scale_ * (low_y + high_y)};
  }

  PagePoint at(const Point3& point) const {
    const PagePoint place = unscaled(point);
    return {shift_.x + scale_ * place.x, shift_.y + scale_ * place.y};
  }
  bool is_facing(const Point3& point, const Point3& normal) const {
    return !camera_.has_value() || camera_->is_facing(point, normal);
  }

 private:
  PagePoint unscaled(const Point3& point) const {
    if (!camera_.has_value()) return {point[0], -point[1]};
    const Projection::OnPage place = camera_->project(point);
    return {place.x, place.y};
  }

  std::optional<Projection> camera_;
  double scale_ = 1.0;
  PagePoint shift_;
};

std::string points_text(const Page& page, const SceneShell& shell, const SceneFace& face) {
  std::string text;
  for (const std::uint32_t corner : face.corners) {
    const PagePoint at = page.at(shell.corners[corner]);
    text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", at.x, at.y);
  }
  return text;
}

std::string line(const Page& page, const Point3& from, const Point3& to, const std::string& style) {
  const PagePoint a = page.at(from), b = page.at(to);
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", a.x, a.y, b.x,
                     b.y, style);
}

/// The middle of a face on the page.
PagePoint middle_of(const Page& page, const SceneShell& shell, const SceneFace& face) {
  PagePoint middle;
  for (const std::uint32_t corner : face.corners) {
    const PagePoint at = page.at(shell.corners[corner]);
    middle.x += at.x / static_cast<double>(face.corners.size());
    middle.y += at.y / static_cast<double>(face.corners.size());
  }
  return middle;
}

class SolidDrawing {
 public:
  SolidDrawing(const Scene& scene, const Page& page) : scene_(scene), page_(page) {}

  std::string text() {
    for (std::size_t axis = 0; axis < 3; ++axis) draw_back_wall(axis);
    for (std::size_t axis = 0; axis < 3; ++axis) draw_scale(axis);
    const bool both = scene_.inner.has_value() && scene_.outer.has_value();
    if (both) draw_shell(*scene_.outer, false, "outer", kGlass);
    const SceneShell& solid = scene_.inner.has_value() ? *scene_.inner : *scene_.outer;
    draw_shell(solid, true, scene_.inner.has_value() ? "inner" : "outer", kSolid);
    if (both) draw_shell(*scene_.outer, true, "outer", kGlass);
    draw_marks(solid);
    draw_outlines();
    return text_;
  }

 private:
  enum Look { kSolid, kGlass };

  bool wall_faces(std::size_t axis, bool is_high) const {
    Point3 normal{}, point{};
    normal[axis] = is_high ? 1.0 : -1.0;
    point[axis] = is_high ? scene_.axes[axis].high : scene_.axes[axis].low;
    return page_.is_facing(point, normal);
  }

  /// The wall behind the shells, and the ticks' lines on it.
  void draw_back_wall(std::size_t axis) {
    const bool is_high = !wall_faces(axis, true);
    if (wall_faces(axis, is_high)) return;  // seen from inside the slab: both walls are in front
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (const auto& [along, across] : {std::pair{b, c}, std::pair{c, b}}) {
      std::vector<double> values{scene_.axes[across].low, scene_.axes[across].high};
      for (const Tick& tick : scene_.axes[across].ticks) values.push_back(tick.value);
      for (const double value : values) {
        Point3 from{}, to{};
        from[axis] = to[axis] = is_high ? scene_.axes[axis].high : scene_.axes[axis].low;
        from[across] = to[across] = value;
        from[along] = scene_.axes[along].low;
        to[along] = scene_.axes[along].high;
        text_ += line(page_, from, to, "class=\"grid\"");
      }
    }
  }

  /// Ticks, numbers and name along the edge of the box that is best to read.
  void draw_scale(std::size_t axis) {
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    std::optional<std::array<bool, 3>> best;
    double best_score = 0.0;
    for (const bool high_b : {false, true}) {
      for (const bool high_c : {false, true}) {
        // On an edge of the box's outline one wall is seen and one is not.
        if (wall_faces(b, high_b) == wall_faces(c, high_c)) continue;
        std::array<bool, 3> place{};
        place[b] = high_b;
        place[c] = high_c;
        const PagePoint at = page_.at(in_box(scene_, axis, 0.0, place));
        const double score = axis == 2 ? -at.x : at.y;
        if (best.has_value() && score <= best_score) continue;
        best = place;
        best_score = score;
      }
    }
    if (!best.has_value()) return;
    const PagePoint from = page_.at(in_box(scene_, axis, scene_.axes[axis].low, *best));
    const PagePoint to = page_.at(in_box(scene_, axis, scene_.axes[axis].high, *best));
    const PagePoint centre = page_.at({0.0, 0.0, 0.0});
    PagePoint out{to.y - from.y, from.x - to.x};
    const double length = std::hypot(out.x, out.y);
    if (length == 0.0) return;
    const double sign = out.x * (from.x - centre.x) + out.y * (from.y - centre.y) < 0.0 ? -1.0 : 1.0;
    out = {sign * out.x / length, sign * out.y / length};
    const char* const anchor = out.x < -0.3 ? "end" : out.x > 0.3 ? "start" : "middle";
    std::size_t longest = 0;
    for (const Tick& tick : scene_.axes[axis].ticks) {
      longest = std::max(longest, tick.label.size());
      const PagePoint at = page_.at(in_box(scene_, axis, tick.value, *best));
      // Numbers at the foot of the upright scale make room for those of the scale that starts there.
      const double down = axis == 2 ? 1.0 : 7.0;
      text_ += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                           at.x + 9.0 * out.x, at.y + 9.0 * out.y + down, anchor, escaped(tick.label));
    }
    // [px] The name stands beyond the longest number; a digit is some 6.6 wide.
    const double beside = std::max(42.0, 18.0 + 6.6 * static_cast<double>(longest));
    const PagePoint name{0.5 * (from.x + to.x) + beside * out.x, 0.5 * (from.y + to.y) + 36.0 * out.y + 5.0};
    text_ += fmt::format("<text class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                         name.x, name.y, anchor, escaped(scene_.axes[axis].name));
  }

  void draw_shell(const SceneShell& shell, bool facing, const char* name, Look look) {
    for (const SceneFace& face : shell.faces) {
      if (page_.is_facing(shell.corners[face.corners.front()], face.normal) != facing) continue;
      const std::string points = points_text(page_, shell, face);
      if (look == kGlass) {
        text_ += fmt::format("<polygon class=\"{} {}\" points=\"{}\"/>\n", facing ? "glass" : "behind", name,
                             points);
      } else {
        text_ += fmt::format("<polygon class=\"face {}\" data-facet=\"{}\" fill=\"{}\" points=\"{}\"/>\n",
                             name, face.source, hex(lit(face.colour, brightness_of(face.normal))), points);
      }
    }
  }

  void draw_marks(const SceneShell& shell) {
    std::string labels;
    for (const SceneFace& face : shell.faces) {
      if (face.mark == 0 || !page_.is_facing(shell.corners[face.corners.front()], face.normal)) continue;
      text_ += fmt::format("<polygon class=\"mark\" data-facet=\"{}\" points=\"{}\"/>\n", face.source,
                           points_text(page_, shell, face));
      const PagePoint at = middle_of(page_, shell, face);
      labels += fmt::format("<text class=\"number\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", at.x, at.y + 4.5,
                            face.mark);
    }
    text_ += labels;
  }

  void draw_outlines() {
    for (const SceneOutline& outline : scene_.outlines) {
      for (const auto& [from, to] : outline.edges) text_ += line(page_, from, to, "class=\"mark outline\"");
    }
  }

  const Scene& scene_;
  const Page& page_;
  std::string text_;
};

class FlatDrawing {
 public:
  FlatDrawing(const Scene& scene, const Page& page) : scene_(scene), page_(page) {}

  std::string text() {
    draw_scale(0);
    draw_scale(1);
    const bool both = scene_.inner.has_value() && scene_.outer.has_value();
    const SceneShell& solid = scene_.inner.has_value() ? *scene_.inner : *scene_.outer;
    if (both) draw_region(*scene_.outer, "glass outer");
    draw_region(solid, "region");
    for (const SceneFace& face : solid.faces) {
      const Point3 &from = solid.corners[face.corners[0]], &to = solid.corners[face.corners[1]];
      text_ += line(page_, from, to,
                    fmt::format("class=\"side {}\" data-facet=\"{}\" stroke=\"{}\"",
                                scene_.inner.has_value() ? "inner" : "outer", face.source, hex(face.colour)));
    }
    for (const SceneFace& face : solid.faces) draw_mark(solid, face);
    for (const SceneOutline& outline : scene_.outlines) {
      for (const auto& [from, to] : outline.edges) text_ += line(page_, from, to, "class=\"mark outline\"");
    }
    return text_;
  }

 private:
  static constexpr double kNameDistance = 58.0;  // [px] of the upright axis: beyond numbers of six digits

  void draw_scale(std::size_t axis) {
    const SceneAxis& scale = scene_.axes[axis];
    std::vector<double> values{scale.low, scale.high};
    for (const Tick& tick : scale.ticks) values.push_back(tick.value);
    for (const double value : values) {
      text_ += line(page_, in_box(scene_, axis, value, {false, false, false}),
                    in_box(scene_, axis, value, {true, true, true}), "class=\"grid\"");
    }
    for (const Tick& tick : scale.ticks) {
      const PagePoint at = page_.at(in_box(scene_, axis, tick.value, {}));
      text_ += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                           axis == 0 ? at.x : at.x - 8.0, axis == 0 ? at.y + 18.0 : at.y + 4.0,
                           axis == 0 ? "middle" : "end", escaped(tick.label));
    }
    const PagePoint middle = page_.at(in_box(scene_, axis, 0.0, {}));
    const std::string turn = axis == 0 ? ""
                                       : fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"",
                                                     middle.x - kNameDistance, middle.y);
    text_ +=
        fmt::format("<text class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\"{}>{}</text>\n",
                    axis == 0 ? middle.x : middle.x - kNameDistance, axis == 0 ? middle.y + 40.0 : middle.y,
                    turn, escaped(scale.name));
  }

  /// Corners in order around the middle: the region is convex and holds it.
  void draw_region(const SceneShell& shell, const char* name) {
    std::vector<Point3> corners = shell.corners;
    Point3 middle{};
    for (const Point3& corner : corners) {
      for (std::size_t k = 0; k < 2; ++k) middle[k] += corner[k] / static_cast<double>(corners.size());
    }
    std::sort(corners.begin(), corners.end(), [&](const Point3& a, const Point3& b) {
      return std::atan2(a[1] - middle[1], a[0] - middle[0]) < std::atan2(b[1] - middle[1], b[0] - middle[0]);
    });
    std::string points;
    for (const Point3& corner : corners) {
      const PagePoint at = page_.at(corner);
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", at.x, at.y);
    }
    text_ += fmt::format("<polygon class=\"{}\" points=\"{}\"/>\n", name, points);
  }

  static constexpr double kBeside = 6.0;  // [px] a mark runs beside its side

  void draw_mark(const SceneShell& shell, const SceneFace& face) {
    if (face.mark == 0) return;
    PagePoint at = middle_of(page_, shell, face);
    const auto beside = [&](std::uint32_t corner) {
      const PagePoint on = page_.at(shell.corners[corner]);
      return PagePoint{on.x + kBeside * face.normal[0], on.y - kBeside * face.normal[1]};
    };
    const PagePoint from = beside(face.corners[0]), to = beside(face.corners[1]);
    text_ += fmt::format(
        "<line class=\"mark\" data-facet=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
        face.source, from.x, from.y, to.x, to.y);
    at = {at.x + 3.0 * kBeside * face.normal[0], at.y - 3.0 * kBeside * face.normal[1]};
    text_ += fmt::format("<text class=\"number\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", at.x, at.y + 4.5,
                         face.mark);
  }

  const Scene& scene_;
  const Page& page_;
  std::string text_;
};

}  // namespace

Camera first_camera() { return {.azimuth = -0.95, .elevation = 0.42, .distance = 6.5, .field_of_view = 0.5}; }

double brightness_of(const Point3& normal) {
  // A light over the left shoulder of the first camera; dim enough that colours can be read as widths.
  constexpr Point3 kLight{-0.05, -0.66, 0.75};
  const double cosine = normal[0] * kLight[0] + normal[1] * kLight[1] + normal[2] * kLight[2];
  return 0.86 + 0.14 * cosine;
}

std::string draw_scene(const Scene& scene, const PageArea& area) {
  const Page page(scene, area);
  return scene.dimension == 3 ? SolidDrawing(scene, page).text() : FlatDrawing(scene, page).text();
}

}  // namespace ndhull
