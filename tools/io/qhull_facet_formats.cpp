// Qhull formats with one line a facet: n Fo Fi Fa FC Fm FI Fv Fn i o Ft.
#include <algorithm>
#include <vector>

#include "tools/io/qhull_formats.h"

namespace ndhull {
namespace {

void print_ids(OutputFile& file, std::span<const PointId> ids) {
  for (const PointId id : ids) file.print("{} ", id.value);
  file.write("\n");
}

}  // namespace

void print_row(OutputFile& file, std::span<const double> numbers) {
  for (const double number : numbers) file.print("{:6.16g} ", number);
  file.write("\n");
}

std::vector<double> centrum(const PointView& points, std::span<const PointId> vertices,
                            std::span<const double> normal, double offset) {
  std::vector<double> mean(points.dimension, 0.0);
  for (const PointId vertex : vertices) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += points.at(vertex.value, k);
  }
  double distance = offset;
  for (std::size_t k = 0; k < mean.size(); ++k) {
    mean[k] /= static_cast<double>(vertices.size());
    distance += normal[k] * mean[k];
  }
  for (std::size_t k = 0; k < mean.size(); ++k) mean[k] -= distance * normal[k];
  return mean;
}

std::vector<double> centrum(const QhullPrint& print, FacetId facet) {
  const Hull& hull = print.hull;
  return centrum(print.points, hull.vertices_of(facet), hull.normal(facet), hull.offset(facet));
}

void write_planes_format(OutputFile& file, std::string_view format, const QhullPrint& print) {
  const Hull& hull = print.hull;
  if (print.writes_cdd) {
    file.print("{}\nbegin\n    {} {} real\n", print.invocation, print.facets.size(), hull.dimension + 1);
  } else {
    file.print("{}\n{}\n", hull.dimension + 1, print.facets.size());
  }
  std::vector<double> row(hull.dimension + 1);
  for (const FacetId facet : print.facets) {
    const std::span<const double> normal = hull.normal(facet);
    std::copy(normal.begin(), normal.end(), row.begin());
    // A plane further out has the smaller offset: normal.x + offset <= 0 is inside.
    double shift = 0.0;
    if (format == "Fo") shift = hull.outer_offset(facet) * hull.input_per_length_unit(facet);
    if (format == "Fi") shift = hull.inner_offset(facet) * hull.input_per_length_unit(facet);
    row[hull.dimension] = hull.offset(facet) - shift;
    if (print.writes_cdd) {
      // n.x + b <= 0 is -b - n.x >= 0, the constant first.
      std::rotate(row.begin(), row.end() - 1, row.end());
      for (double& number : row) number = 0.0 - number;
    }
    print_row(file, row);
  }
  if (print.writes_cdd) file.write("end\n");
}

void write_merge_counts(OutputFile& file, const QhullPrint& print) {
  // Qhull's counters end here.
  constexpr std::size_t kLargestCount = 511;
  file.print("{}\n", print.facets.size());
  for (const FacetId facet : print.facets) {
    file.print("{}\n", std::min<std::uint64_t>(print.hull.simplex_count_of(facet) - 1, kLargestCount));
  }
}

void write_facet_ids(OutputFile& file, const QhullPrint& print) {
  file.print("{}\n", print.facets.size());
  for (const FacetId facet : print.facets) file.print("{}\n", QhullPrint::printed_id(facet));
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

namespace {

void print_points(OutputFile& file, const QhullPrint& print) {
  std::vector<double> row(print.hull.dimension);
  for (std::size_t point = 0; point < print.hull.point_count; ++point) {
    print.points.copy_row(point, row.data());
    print_row(file, row);
  }
}

std::size_t ridge_count(const QhullPrint& print) {
  std::size_t neighbours = 0;
  for (const FacetId facet : print.facets) neighbours += print.hull.neighbours_of(facet).size();
  return neighbours / 2;
}

void print_polygon(OutputFile& file, std::span<const PointId> vertices) {
  file.print("{} ", vertices.size());
  print_ids(file, vertices);
}

}  // namespace

void write_off(OutputFile& file, const QhullPrint& print) {
  const Hull& hull = print.hull;
  file.print("{}\n{} {} {}\n", hull.dimension, hull.point_count, print.facets.size(), ridge_count(print));
  print_points(file, print);
  for (const FacetId facet : print.facets) print_polygon(file, print.order.vertices(facet));
}

void write_triangulated_off(OutputFile& file, const QhullPrint& print) {
  const Hull& hull = print.hull;
  std::vector<FacetId> merged;
  std::size_t count = 0;
  for (const FacetId facet : print.facets) {
    if (!hull.is_simplicial(facet)) merged.push_back(facet);
    count += hull.is_simplicial(facet) ? 1 : print.order.ridge_count(facet);
  }
  file.print("{}\n{} {} {}\n", hull.dimension, hull.point_count + merged.size(), count, ridge_count(print));
  print_points(file, print);
  for (const FacetId facet : merged) print_row(file, centrum(print, facet));
  auto inside_point = static_cast<std::uint32_t>(hull.point_count);
  for (const FacetId facet : print.facets) {
    if (hull.is_simplicial(facet)) {
      print_polygon(file, print.order.vertices(facet));
      continue;
    }
    print.order.for_each_cone(facet, PointId{inside_point++},
                              [&file](std::span<const PointId> cone) { print_polygon(file, cone); });
  }
}

}  // namespace ndhull
