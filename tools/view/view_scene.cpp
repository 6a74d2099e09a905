// Steps: axes, shells of the section or shadow, the box around them, colours and marks, texts.
#include "tools/view/view_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "approx/drawing/shadow.h"
#include "core/error.h"
#include "tools/view/point_extent.h"

namespace ndhull {
namespace {

/// [ratio] of a facet's height: shells closer than this are one line on the page.
constexpr double kVisibleGap = 1e-3;
/// [ratio] of the longest to the shortest axis that is still drawn in one unit.
constexpr double kMostUneven = 4.0;

struct Shells {
  std::optional<Shell> inner, outer;
  std::vector<double> values;  // what each source of `inner` or `outer` is coloured by
};

/// Does the direction leave the subspace that flat points span?
bool leaves_subspace(const CentredFacets& facets, std::size_t column) {
  const std::size_t stride = facets.dimension + 1;
  for (std::size_t row = 0; row + facets.dimension < facets.subspace_equations.size(); row += stride) {
    if (std::abs(facets.subspace_equations[row + column]) > 1e-9) return true;
  }
  return false;
}

/// Principal components are found by squares of lengths, and sections along them by products of squares.
void check_extents(const PointView& points) {
  constexpr double kShortest = 1e-140, kLongest = 1e140;
  const double extent = largest_extent(points);
  if (extent > kShortest && extent < kLongest) return;
  throw Error(
      ErrorCode::kOutOfRange,
      fmt::format("points: found an extent of {:.3g}, expected 1e-140 to 1e140 for principal components; "
                  "multiply the coordinates by a power of two, or choose columns with --axes",
                  extent));
}

DrawingAxes axes_of(const ViewedHull& viewed, const ViewWish& wish) {
  const PointView points = viewed.points.view();
  const auto names = column_names_or_numbers(viewed.points.column_names, viewed.dimension());
  if (viewed.rank < 2) {
    throw Error(ErrorCode::kUsage,
                fmt::format("{}: found points that span only {} dimensions, expected at least 2 to draw",
                            viewed.points.path, viewed.rank));
  }
  if (wish.columns.empty()) {
    check_extents(points);
    return principal_axes(points, std::min<std::size_t>(3, viewed.rank), viewed.facets.centre, viewed.extents,
                          names, viewed.facets.subspace_equations);
  }
  for (const std::size_t column : wish.columns) {
    if (wish.kind == ViewKind::kShadow || !leaves_subspace(viewed.facets, column)) continue;
    throw Error(ErrorCode::kUsage,
                fmt::format("--axes: found {}, which leaves the {}-d subspace that the points span; take "
                            "--principal or --shadow",
                            names[column], viewed.rank));
  }
  return column_axes(wish.columns, viewed.facets.centre, names);
}

bool shells_coincide(const CentredFacets& facets) {
  double widest = 0.0;
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    widest = std::max(widest, (facets.outer[facet] - facets.inner[facet]) / facets.heights[facet]);
  }
  return widest < kVisibleGap;
}

Shells shells_of(const ViewedHull& viewed, const ViewWish& wish, const DrawingAxes& axes, Scene& scene) {
  Shells shells;
  if (wish.kind == ViewKind::kShadow) {
    std::optional<Shadow> shadow =
        hull_shadow(viewed.facets, viewed.points.view(), viewed.vertices, axes, wish.end);
    if (!shadow.has_value()) {
      throw Error(ErrorCode::kUsage,
                  "--axes: found a shadow that is flat along these axes, expected one with "
                  "an inside; take other axes or --principal");
    }
    const double margin = *std::max_element(shadow->margins.begin(), shadow->margins.end());
    shells = {std::move(shadow->inner), std::nullopt, std::move(shadow->margins)};
    scene.inner_text = "shadow of the hull";
    scene.outer_text = "outer shell: contains the shadow of every input point";
    if (margin >= kVisibleGap) shells.outer = std::move(shadow->outer);
    if (!shells.outer.has_value())
      scene.inner_text += margin < kVisibleGap ? ", inner and outer shell coincide at this scale"
                                               : "; no outer shell was found";
  } else {
    shells = {section_shell(viewed.facets, axes, ShellKind::kInner),
              section_shell(viewed.facets, axes, ShellKind::kOuter), viewed.facets.widths};
    scene.inner_text = "inner shell: inside the hull of the points";
    scene.outer_text = "outer shell: no input point is beyond it";
    if (shells_coincide(viewed.facets)) {
      shells.inner.reset();
      scene.outer_text = "the hull: inner and outer shell coincide at this scale";
    } else if (!shells.inner.has_value()) {
      scene.outer_text = "outer shell; an inner plane is below the interior point: no inner shell";
    }
  }
  return shells;
}

/// Maps coordinates along the axes to the drawing's units: the middle of the box is 0.
class Box {
 public:
  Box(const Shell& outermost, std::size_t dimension) : dimension_(dimension) {
    Point3 low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const Point3& corner : outermost.corners) {
      for (std::size_t k = 0; k < dimension; ++k) {
        low[k] = std::min(low[k], corner[k]);
        high[k] = std::max(high[k], corner[k]);
      }
    }
    double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      middle_[k] = 0.5 * (low[k] + high[k]);
      half_[k] = 0.5 * (high[k] - low[k]);
      shortest = std::min(shortest, half_[k]);
      longest = std::max(longest, half_[k]);
    }
    is_stretched_ = longest > kMostUneven * shortest;
    for (std::size_t k = 0; k < dimension; ++k) unit_[k] = is_stretched_ ? half_[k] : longest;
  }

  bool is_stretched() const { return is_stretched_; }
  double to_drawing(double value, std::size_t k) const { return (value - middle_[k]) / unit_[k]; }
  Point3 point(const Point3& corner) const {
    Point3 result{};
    for (std::size_t k = 0; k < dimension_; ++k) result[k] = to_drawing(corner[k], k);
    return result;
  }
  /// Normals map with the inverse of the scaling.
  Point3 normal(const Point3& normal) const {
    Point3 result{};
    double square = 0.0;
    for (std::size_t k = 0; k < dimension_; ++k) {
      result[k] = normal[k] * unit_[k];
      square += result[k] * result[k];
    }
    for (double& value : result) value /= std::sqrt(square);
    return result;
  }
  SceneAxis axis(const DrawingAxes& axes, std::size_t k) const {
    SceneAxis axis{axes.names[k], axes.remarks[k], -half_[k] / unit_[k], half_[k] / unit_[k], {}};
    double origin = axes.origin[k];
    // Values whose leading digits are all alike are told from the interior point.
    if (std::abs(origin + middle_[k]) > 1e5 * half_[k]) {
      axis.name += fmt::format(" \u2212 {:.17g}", origin);
      origin = 0.0;
    }
    axis.ticks = round_ticks(origin + middle_[k] - half_[k], origin + middle_[k] + half_[k], 5);
    for (Tick& tick : axis.ticks) tick.value = to_drawing(tick.value - origin, k);
    return axis;
  }

 private:
  std::size_t dimension_;
  Point3 middle_{}, half_{}, unit_{};
  bool is_stretched_ = false;
};

std::string unit_text(const ViewedHull& viewed) { return viewed.is_unit_cube() ? "[unit cube]" : "[input]"; }

std::string facet_tip(const ViewedHull& viewed, std::uint32_t facet, std::size_t mark) {
  std::string tip = fmt::format("facet {}\nwidth {} {}\narea {} [input^{}]", facet,
                                three_digits(viewed.facets.widths[facet]), unit_text(viewed),
                                three_digits(viewed.facets.areas[facet]), viewed.rank - 1);
  if (mark == 1) tip += "\nthe largest facet";
  if (mark > 1) tip += fmt::format("\nnumber {} of the largest facets", mark);
  return tip;
}

SceneShell scene_shell(const Shell& shell, const Box& box) {
  SceneShell result;
  for (const Point3& corner : shell.corners) result.corners.push_back(box.point(corner));
  for (const Shell::Face& face : shell.faces) {
    result.faces.push_back({face.corners, box.normal(face.normal), {}, face.source, 0, {}});
  }
  return result;
}

void colour_section(SceneShell& shell, const ViewedHull& viewed, const ColourScale& scale,
                    const std::vector<std::uint32_t>& largest) {
  for (SceneFace& face : shell.faces) {
    const auto place = std::find(largest.begin(), largest.end(), face.source);
    if (place != largest.end()) face.mark = static_cast<std::size_t>(place - largest.begin()) + 1;
    face.colour = scale.colour_of(viewed.facets.widths[face.source]);
    face.tip = facet_tip(viewed, face.source, face.mark);
  }
}

void colour_shadow(SceneShell& shell, const std::vector<double>& margins, const ColourScale& scale) {
  for (SceneFace& face : shell.faces) {
    face.colour = scale.colour_of(margins[face.source]);
    face.tip = fmt::format("the outer shell is {} % further out", three_digits(100.0 * margins[face.source]));
  }
}

/// The edges of the hull of a facet's projected vertices; none when they fall on one line.
SceneOutline facet_outline(const ViewedHull& viewed, const DrawingAxes& axes, const Box& box,
                           std::uint32_t facet, std::size_t mark) {
  std::vector<PointId> ids;
  for (const std::uint32_t id : viewed.facet_vertices.row(facet)) ids.push_back(PointId{id});
  const std::vector<double> projected = coordinates_along(axes, viewed.points.view(), ids);
  const Hull hull =
      convex_hull(PointView::row_major(projected.data(), ids.size(), axes.count()), {.threads = 1});
  const auto place = [&](PointId id) {
    Point3 point{};
    std::copy_n(projected.begin() + static_cast<std::ptrdiff_t>(id.value * axes.count()), axes.count(),
                point.begin());
    return box.point(point);
  };
  SceneOutline outline{mark, {}};
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const auto one = hull.vertices_of(FacetId{row});
    if (hull.rank == 2) outline.edges.emplace_back(place(one[0]), place(one[1]));
    if (hull.rank < 3) continue;
    for (const FacetId neighbour : hull.neighbours_of(FacetId{row})) {
      if (neighbour.value < row) continue;
      std::vector<PointId> shared;
      const auto other = hull.vertices_of(neighbour);
      std::copy_if(one.begin(), one.end(), std::back_inserter(shared),
                   [&](PointId id) { return std::find(other.begin(), other.end(), id) != other.end(); });
      if (shared.size() >= 2) outline.edges.emplace_back(place(shared.front()), place(shared.back()));
    }
  }
  return outline;
}

std::string axis_names(const DrawingAxes& axes) { return fmt::format("{}", fmt::join(axes.names, ", ")); }

void add_texts(const ViewedHull& viewed, const ViewWish& wish, const DrawingAxes& axes, const Shells& shells,
               Scene& scene) {
  const std::size_t faces = (shells.outer.has_value() ? *shells.outer : *shells.inner).faces.size();
  const bool is_whole = viewed.rank == viewed.dimension() && viewed.rank == axes.count();
  const std::string_view what = wish.kind == ViewKind::kShadow ? "Shadow" : "Section";
  scene.title = is_whole ? fmt::format("Hull of {}", viewed.points_name)
                         : fmt::format("{} of the hull of {}", what, viewed.points_name);
  if (!is_whole && wish.kind == ViewKind::kSection) {
    scene.facts.push_back(fmt::format("section through the interior point along {}", axis_names(axes)));
  } else if (!is_whole) {
    scene.facts.push_back(fmt::format("projection on {}", axis_names(axes)));
  }
  const double widest = *std::max_element(viewed.facets.widths.begin(), viewed.facets.widths.end());
  std::string facets = fmt::format("{} facets", with_commas(viewed.facets.size()));
  if (!is_whole && wish.kind == ViewKind::kSection)
    facets += fmt::format(", {} in the section", with_commas(faces));
  scene.facts.push_back(fmt::format("{} points in {}-d \u00B7 {} \u00B7 widest facet {} {}{}",
                                    with_commas(viewed.points.view().rows), viewed.dimension(), facets,
                                    three_digits(widest), unit_text(viewed),
                                    viewed.status == "complete" ? "" : " \u00B7 status " + viewed.status));
}

}  // namespace

std::string with_commas(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t place = digits.size(); place > 3; place -= 3) digits.insert(place - 3, 1, ',');
  return digits;
}

Scene make_scene(const ViewedHull& viewed, const ViewWish& wish) {
  Scene scene;
  const DrawingAxes axes = axes_of(viewed, wish);
  const Shells shells = shells_of(viewed, wish, axes, scene);
  scene.dimension = axes.count();
  const Box box(shells.outer.has_value() ? *shells.outer : *shells.inner, axes.count());
  if (shells.inner.has_value()) scene.inner = scene_shell(*shells.inner, box);
  if (shells.outer.has_value()) scene.outer = scene_shell(*shells.outer, box);

  const std::vector<std::uint32_t> largest = largest_facets(viewed.facets, wish.highlight);
  std::size_t marks = 0;
  if (wish.kind == ViewKind::kShadow) {
    scene.scale = ColourScale(shells.values, "margin of the outer shell [ratio]");
    for (auto* shell : {&scene.inner, &scene.outer}) {
      if (shell->has_value()) colour_shadow(**shell, shells.values, scene.scale);
    }
    for (std::size_t k = 0; k < largest.size(); ++k) {
      scene.outlines.push_back(facet_outline(viewed, axes, box, largest[k], k + 1));
    }
    marks = largest.size();
  } else {
    std::vector<double> shown;
    for (const SceneFace& face : scene.outer->faces) shown.push_back(viewed.facets.widths[face.source]);
    scene.scale = ColourScale(shown, "facet width " + unit_text(viewed));
    for (auto* shell : {&scene.inner, &scene.outer}) {
      if (shell->has_value()) colour_section(**shell, viewed, scene.scale, largest);
    }
    for (const SceneFace& face : scene.outer->faces) marks += face.mark > 0 ? 1 : 0;
  }
  if (!largest.empty()) {
    scene.mark_text = largest.size() == 1 ? "the largest facet by area"
                                          : fmt::format("the {} largest facets by area", largest.size());
    if (marks < largest.size()) scene.mark_text += fmt::format("; {} in the section", marks);
  }
  for (std::size_t k = 0; k < axes.count(); ++k) scene.axes.push_back(box.axis(axes, k));
  if (box.is_stretched()) scene.stretch_text = "axes stretched to one length";
  add_texts(viewed, wish, axes, shells, scene);
  return scene;
}

}  // namespace ndhull
