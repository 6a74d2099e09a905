// Qhull formats about points: FV Fx FN p Fc FP.
#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/io/qhull_formats.h"

namespace ndhull {

void write_mean_vertex(OutputFile& file, const QhullPrint& print) {
  const std::size_t dimension = print.hull.dimension;
  // Of the hull when nothing was selected: the mean of no vertices is no point.
  const std::vector<PointId>& vertices = print.vertices.empty() ? print.hull.vertices : print.vertices;
  std::vector<double> mean(dimension, 0.0);
  for (const PointId vertex : vertices) {
    for (std::size_t k = 0; k < dimension; ++k) mean[k] += print.points.at(vertex.value, k);
  }
  file.print("{} 1\n", dimension);
  for (const double sum : mean) file.print("{:6.16g} ", sum / static_cast<double>(vertices.size()));
  file.write("\n");
}

void write_extreme_points(OutputFile& file, const QhullPrint& print) {
  std::vector<PointId> ids = print.vertices;
  if (std::vector<PointId> polygon = print.order.polygon(); !polygon.empty()) {
    std::erase_if(polygon,
                  [&ids](PointId point) { return !std::binary_search(ids.begin(), ids.end(), point); });
    ids = std::move(polygon);
  }
  file.print("{}\n", ids.size());
  for (const PointId point : ids) file.print("{}\n", point.value);
}

void write_vertex_coordinates(OutputFile& file, const QhullPrint& print) {
  const std::size_t dimension = print.hull.dimension;
  std::vector<PointId> ids = print.vertices;
  for (const AttachedPoint& attached : print.attached) ids.push_back(attached.point);
  std::sort(ids.begin(), ids.end());
  if (print.writes_cdd) {
    file.print("{}\nbegin\n{} {} real\n", print.invocation, ids.size(), dimension + 1);
  } else {
    file.print("{}\n{}\n", dimension, ids.size());
  }
  std::vector<double> row(dimension);
  for (const PointId id : ids) {
    print.points.copy_row(id.value, row.data());
    if (print.writes_cdd) file.write("1 ");  // a point, where 0 is a ray
    print_row(file, row);
  }
  if (print.writes_cdd) file.write("end\n");
}

void write_attached_points(OutputFile& file, const QhullPrint& print) {
  std::vector<std::vector<PointId>> points_of(print.facets.size());
  for (const AttachedPoint& attached : print.attached) {
    points_of[static_cast<std::size_t>(print.label[attached.facet.value])].push_back(attached.point);
  }
  file.print("{}\n", print.facets.size());
  for (const std::vector<PointId>& points : points_of) {
    file.print("{}", points.size());
    for (const PointId point : points) file.print(" {}", point.value);
    file.write("\n");
  }
}

void write_nearest_vertices(OutputFile& file, const QhullPrint& print) {
  file.print("{}\n", print.attached.size());
  for (const AttachedPoint& attached : print.attached) {
    PointId nearest;
    double least_sq = HUGE_VAL;
    for (const PointId vertex : print.hull.vertices_of(attached.facet)) {
      double sum = 0.0;
      for (std::size_t k = 0; k < print.hull.dimension; ++k) {
        const double step = print.points.at(attached.point.value, k) - print.points.at(vertex.value, k);
        sum += step * step;
      }
      if (sum >= least_sq) continue;
      least_sq = sum;
      nearest = vertex;
    }
    file.print("{} {} {} {:6.16g} \n", nearest.value, attached.point.value,
               QhullPrint::printed_id(attached.facet), std::sqrt(least_sq));
  }
}

void write_vertex_facets(OutputFile& file, const QhullPrint& print) {
  // The facets of each point in one array: counts, their sums, then the entries.
  const Hull& hull = print.hull;
  std::vector<std::size_t> begin(hull.point_count + 1, 0);
  const auto facet_id = [](std::size_t row) { return FacetId{static_cast<std::uint32_t>(row)}; };
  for (std::size_t row = 0; row < hull.facet_count(); ++row) {
    for (const PointId vertex : hull.vertices_of(facet_id(row))) ++begin[vertex.value + 1];
  }
  for (std::size_t point = 0; point < hull.point_count; ++point) begin[point + 1] += begin[point];
  std::vector<FacetId> facets(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t row = 0; row < hull.facet_count(); ++row) {
    for (const PointId vertex : hull.vertices_of(facet_id(row))) facets[next[vertex.value]++] = facet_id(row);
  }

  std::vector<FacetId> facet_of_attached(
      print.attached.empty() && print.attached_elsewhere.empty() ? 0 : hull.point_count);
  for (const auto* const list : {&print.attached, &print.attached_elsewhere})
    for (const AttachedPoint& attached : *list) facet_of_attached[attached.point.value] = attached.facet;
  file.print("{}\n", hull.point_count);
  for (std::size_t point = 0; point < hull.point_count; ++point) {
    const PointId id{static_cast<std::uint32_t>(point)};
    if (!facet_of_attached.empty() && facet_of_attached[point].valid()) {
      file.print("1 {}\n", print.label[facet_of_attached[point].value]);
      continue;
    }
    if (!std::binary_search(print.vertices.begin(), print.vertices.end(), id)) {
      file.write("0\n");
      continue;
    }
    file.print("{}", begin[point + 1] - begin[point]);
    for (std::size_t k = begin[point]; k < begin[point + 1]; ++k)
      file.print(" {}", print.label[facets[k].value]);
    file.write("\n");
  }
}

}  // namespace ndhull
