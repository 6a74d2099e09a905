// Qhull formats about points: FV Fx FN p.
#include <algorithm>
#include <vector>

#include "tools/qhull_formats.h"

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
  file.print("{}\n{}\n", dimension, print.vertices.size());
  for (const PointId vertex : print.vertices) {
    for (std::size_t k = 0; k < dimension; ++k) file.print("{:6.16g} ", print.points.at(vertex.value, k));
    file.write("\n");
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

  file.print("{}\n", hull.point_count);
  for (std::size_t point = 0; point < hull.point_count; ++point) {
    const PointId id{static_cast<std::uint32_t>(point)};
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
