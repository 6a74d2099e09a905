// Qhull formats with one line a facet: n Fo Fi Fa FC Fv Fn i o.
#include <vector>

#include "tools/qhull_formats.h"

namespace ndhull {
namespace {

void print_row(OutputFile& file, const std::vector<double>& numbers) {
  for (const double number : numbers) file.print("{:6.16g} ", number);
  file.write("\n");
}

void print_ids(OutputFile& file, std::span<const PointId> ids) {
  for (const PointId id : ids) file.print("{} ", id.value);
  file.write("\n");
}

/// Mean of the facet's vertices, moved along the normal into its plane.
std::vector<double> centrum(const QhullPrint& print, FacetId facet) {
  const std::span<const PointId> vertices = print.hull.vertices_of(facet);
  const std::span<const double> normal = print.hull.normal(facet);
  std::vector<double> mean(print.hull.dimension, 0.0);
  for (const PointId vertex : vertices) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += print.points.at(vertex.value, k);
  }
  double distance = print.hull.offset(facet);
  for (std::size_t k = 0; k < mean.size(); ++k) {
    mean[k] /= static_cast<double>(vertices.size());
    distance += normal[k] * mean[k];
  }
  for (std::size_t k = 0; k < mean.size(); ++k) mean[k] -= distance * normal[k];
  return mean;
}

}  // namespace

void write_planes_format(OutputFile& file, std::string_view format, const QhullPrint& print) {
  const Hull& hull = print.hull;
  file.print("{}\n{}\n", hull.dimension + 1, print.facets.size());
  std::vector<double> row(hull.dimension + 1);
  for (const FacetId facet : print.facets) {
    const std::span<const double> normal = hull.normal(facet);
    std::copy(normal.begin(), normal.end(), row.begin());
    // A plane further out has the smaller offset: normal.x + offset <= 0 is inside.
    double shift = 0.0;
    if (format == "Fo") shift = hull.outer_offset(facet) * hull.input_per_length_unit(facet);
    if (format == "Fi") shift = hull.inner_offset(facet) * hull.input_per_length_unit(facet);
    row[hull.dimension] = hull.offset(facet) - shift;
    print_row(file, row);
  }
}

void write_facet_areas(OutputFile& file, const QhullPrint& print) {
  file.print("{}\n", print.facets.size());
  for (const FacetId facet : print.facets) file.print("{:6.16g} \n", print.hull.area_of(facet));
}

void write_facet_centrums(OutputFile& file, const QhullPrint& print) {
  file.print("{}\n{}\n", print.hull.dimension, print.facets.size());
  for (const FacetId facet : print.facets) print_row(file, centrum(print, facet));
}

void write_facet_vertices(OutputFile& file, const QhullPrint& print) {
  file.print("{}\n", print.facets.size());
  for (const FacetId facet : print.facets) {
    const std::span<const PointId> vertices = print.hull.vertices_of(facet);
    file.print("{}", vertices.size());
    for (const PointId vertex : vertices) file.print(" {}", vertex.value);
    file.write("\n");
  }
}

void write_facet_neighbours(OutputFile& file, const QhullPrint& print) {
  file.print("{}\n", print.facets.size());
  for (const FacetId facet : print.facets) {
    const std::span<const FacetId> neighbours = print.hull.neighbours_of(facet);
    file.print("{}", neighbours.size());
    for (const FacetId neighbour : neighbours) file.print(" {}", print.label[neighbour.value]);
    file.write("\n");
  }
}

void write_facet_simplices(OutputFile& file, const QhullPrint& print) {
  const Hull& hull = print.hull;
  // Up to dimension 3 a facet is a polygon or less, and printed as such.
  const bool cones = hull.rank >= 4;
  std::size_t count = 0;
  for (const FacetId facet : print.facets) {
    count += cones && !hull.is_simplicial(facet) ? print.order.ridge_count(facet) : 1;
  }
  file.print("{}\n", count);
  auto inside_point = static_cast<std::uint32_t>(hull.point_count);
  for (const FacetId facet : print.facets) {
    if (!cones || hull.is_simplicial(facet)) {
      print_ids(file, print.order.vertices(facet));
      continue;
    }
    print.order.for_each_cone(facet, PointId{inside_point},
                              [&file](std::span<const PointId> cone) { print_ids(file, cone); });
    ++inside_point;
  }
}

void write_off(OutputFile& file, const QhullPrint& print) {
  const Hull& hull = print.hull;
  std::size_t neighbour_count = 0;
  for (const FacetId facet : print.facets) neighbour_count += hull.neighbours_of(facet).size();
  file.print("{}\n{} {} {}\n", hull.dimension, hull.point_count, print.facets.size(), neighbour_count / 2);
  std::vector<double> row(hull.dimension);
  for (std::size_t point = 0; point < hull.point_count; ++point) {
    print.points.copy_row(point, row.data());
    print_row(file, row);
  }
  for (const FacetId facet : print.facets) {
    const std::vector<PointId> vertices = print.order.vertices(facet);
    file.print("{} ", vertices.size());
    print_ids(file, vertices);
  }
}

}  // namespace ndhull
