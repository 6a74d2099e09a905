// The facets' planes restricted to the flat are halfplanes or halfspaces of it. Their intersection is the
// polar of the hull of the points normal / height, so the library's own hull does the work, degenerate cases
// included.
#include "approx/drawing/section.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/polytope/plane_polytope.h"
#include "core/error.h"

namespace ndhull {
namespace {

/// [ratio] of a facet's height: what an inner plane must leave of it. Less makes poles too far apart for
/// doubles.
constexpr double kLeastHeight = 1e-6;

Point3 minus(const Point3& a, const Point3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point3 cross(const Point3& a, const Point3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}
Point3 unit(const Point3& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

/// Puts the corners of a face in counterclockwise order about its normal.
void order_corners(Shell& shell, Shell::Face& face) {
  const Point3 normal = face.normal;
  if (shell.dimension == 2) {
    const Point3 along = {-normal[1], normal[0], 0.0};
    std::sort(face.corners.begin(), face.corners.end(), [&](std::uint32_t a, std::uint32_t b) {
      return dot(shell.corners[a], along) < dot(shell.corners[b], along);
    });
    face.corners = {face.corners.front(), face.corners.back()};
    return;
  }
  Point3 middle{};
  for (const std::uint32_t corner : face.corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      middle[k] += shell.corners[corner][k] / static_cast<double>(face.corners.size());
    }
  }
  const std::size_t least = std::abs(normal[0]) < std::abs(normal[1]) ? 0 : 1;
  const Point3 helper = {least == 0 ? 1.0 : 0.0, least == 1 ? 1.0 : 0.0, 0.0};
  const Point3 right = unit(cross(helper, normal));
  const Point3 up = cross(normal, right);
  const auto angle = [&](std::uint32_t corner) {
    const Point3 arm = minus(shell.corners[corner], middle);
    return std::atan2(dot(arm, up), dot(arm, right));
  };
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const std::uint32_t corner : face.corners) order.emplace_back(angle(corner), corner);
  std::sort(order.begin(), order.end());
  for (std::size_t k = 0; k < order.size(); ++k) face.corners[k] = order[k].second;
}

Point3 padded(std::span<const double> values) {
  Point3 point{};
  std::copy(values.begin(), values.end(), point.begin());
  return point;
}

}  // namespace

CentredFacets centred_facets(const Hull& hull) {
  CentredFacets facets;
  facets.dimension = hull.dimension;
  facets.centre = hull.interior_point;
  facets.subspace_equations = hull.subspace_equations;
  facets.normals.reserve(hull.facet_count() * hull.dimension);
  for (std::vector<double>* values :
       {&facets.heights, &facets.outer, &facets.inner, &facets.widths, &facets.areas})
    values->reserve(hull.facet_count());
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    const std::span<const double> normal = hull.normal(facet);
    double value = hull.centred_offset(facet);
    for (std::size_t k = 0; k < hull.dimension; ++k) {
      value += normal[k] * (hull.interior_point[k] - hull.reference[k]);
    }
    const double scale = hull.input_per_length_unit(facet);
    facets.normals.insert(facets.normals.end(), normal.begin(), normal.end());
    facets.heights.push_back(-value);
    facets.outer.push_back(hull.outer_offset(facet) * scale);
    facets.inner.push_back(hull.inner_offset(facet) * scale);
    facets.widths.push_back(hull.outer_offset(facet) - hull.inner_offset(facet));
    facets.areas.push_back(hull.area_of(facet));
  }
  return facets;
}

Shell bounded_by_planes(std::span<const double> normals, std::span<const double> heights,
                        std::size_t dimension) {
  PlanesAboutOrigin planes{dimension, {}, {}};
  std::vector<std::uint32_t> sources;
  planes.normals.reserve(normals.size());
  planes.heights.reserve(heights.size());
  sources.reserve(heights.size());
  for (std::uint32_t plane = 0; plane < heights.size(); ++plane) {
    const std::span<const double> normal = normals.subspan(plane * dimension, dimension);
    const double length = std::sqrt(dot(normal, normal));
    if (length == 0.0) continue;  // parallel to the flat: no bound in it
    for (const double value : normal) planes.normals.push_back(value / length);
    planes.heights.push_back(heights[plane] / length);
    sources.push_back(plane);
  }
  const PlanePolytope polytope = intersect_about_origin(planes, {.threads = 1});
  if (!polytope.bounded) {
    throw Error(ErrorCode::kUsage,
                "found planes that leave the drawing open, expected those of all facets of a hull");
  }
  Shell shell;
  shell.dimension = dimension;
  for (std::size_t vertex = 0; vertex < polytope.vertex_count(dimension); ++vertex) {
    shell.corners.push_back(padded({polytope.vertices.data() + vertex * dimension, dimension}));
  }
  std::vector<std::vector<std::uint32_t>> corners_of(sources.size());
  for (std::size_t entry = 0; entry < polytope.planes.size(); ++entry) {
    std::vector<std::uint32_t>& corners = corners_of[polytope.planes[entry]];
    const std::uint32_t vertex = polytope.vertex_of[entry / dimension];
    // The simplices of a vertex follow each other or not: a face has few corners.
    if (std::find(corners.begin(), corners.end(), vertex) == corners.end()) corners.push_back(vertex);
  }
  for (const std::uint32_t plane : polytope.non_redundant) {
    if (corners_of[plane].size() < dimension) continue;
    const Point3 normal = padded({planes.normals.data() + plane * dimension, dimension});
    shell.faces.push_back({sources[plane], normal, std::move(corners_of[plane])});
    order_corners(shell, shell.faces.back());
  }
  return shell;
}

std::optional<Shell> shell_of_points(const PointView& points) {
  const Hull hull = convex_hull(points, {.threads = 1});
  if (hull.rank < points.dimension) return std::nullopt;
  Shell shell;
  shell.dimension = points.dimension;
  std::vector<std::uint32_t> corner_of(points.rows, 0);
  for (const PointId vertex : hull.vertices) {
    corner_of[vertex.value] = static_cast<std::uint32_t>(shell.corners.size());
    Point3 corner{};
    points.copy_row(vertex.value, corner.data());
    shell.corners.push_back(corner);
  }
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    Shell::Face face{row, padded(hull.normal(FacetId{row})), {}};
    for (const PointId vertex : hull.vertices_of(FacetId{row})) {
      face.corners.push_back(corner_of[vertex.value]);
    }
    order_corners(shell, face);
    shell.faces.push_back(std::move(face));
  }
  return shell;
}

std::optional<Shell> section_shell(const CentredFacets& facets, const DrawingAxes& axes, ShellKind kind) {
  const std::vector<double>& offsets = kind == ShellKind::kOuter ? facets.outer : facets.inner;
  std::vector<double> normals, heights;
  normals.reserve(facets.size() * axes.count());
  heights.reserve(facets.size());
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    heights.push_back(facets.heights[facet] + offsets[facet]);
    if (heights.back() < kLeastHeight * facets.heights[facet]) return std::nullopt;
    for (std::size_t axis = 0; axis < axes.count(); ++axis) {
      normals.push_back(dot(facets.normal(facet), axes.direction(axis)));
    }
  }
  return bounded_by_planes(normals, heights, axes.count());
}

std::vector<std::uint32_t> largest_facets(const CentredFacets& facets, std::size_t count) {
  std::vector<std::uint32_t> order(facets.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
  std::partial_sort(order.begin(), middle, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return facets.areas[a] != facets.areas[b] ? facets.areas[a] > facets.areas[b] : a < b;
  });
  order.erase(middle, order.end());
  return order;
}

}  // namespace ndhull
