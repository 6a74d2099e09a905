#include "tools/largest_formats.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "core/plane_value.h"
#include "tools/io/qhull_formats.h"

namespace ndhull {
namespace {

void write_plane_rows(OutputFile& file, const LargestPrint& print, PlaneKind kind) {
  const std::size_t columns = print.found.dimension + 1;
  const std::vector<double> rows = plane_rows(print.found, print.largest, kind);
  file.print("{}\n{}\n", columns, print.found.facets.size());
  for (std::size_t at = 0; at < rows.size(); at += columns) print_row(file, {rows.data() + at, columns});
}

void write_vertex_rows(OutputFile& file, const LargestPrint& print) {
  const std::vector<PointId> ids = vertices_of(print.found);
  file.print("{}\n{}\n", print.found.dimension, ids.size());
  std::vector<double> row(print.found.dimension);
  for (const PointId id : ids) {
    print.points.copy_row(id.value, row.data());
    print_row(file, row);
  }
}

void write_mean_of_vertices(OutputFile& file, const LargestPrint& print) {
  const std::vector<PointId> ids = vertices_of(print.found);
  std::vector<double> mean(print.found.dimension, 0.0);
  for (const PointId id : ids) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += print.points.at(id.value, k);
  }
  for (double& sum : mean) sum /= static_cast<double>(ids.size());
  // Without facets there are no vertices: what is inside is known all the same.
  file.print("{} 1\n", print.found.dimension);
  print_row(file, ids.empty() ? print.found.interior_point : mean);
}

void write_format(OutputFile& file, std::string_view format, const LargestPrint& print) {
  const LargestFacets& found = print.found;
  if (format == "n") return write_plane_rows(file, print, PlaneKind::kMean);
  if (format == "Fo") return write_plane_rows(file, print, PlaneKind::kOuter);
  if (format == "Fi") return write_plane_rows(file, print, PlaneKind::kInner);
  if (format == "FV") return write_mean_of_vertices(file, print);
  if (format == "p") return write_vertex_rows(file, print);
  if (format == "s") return file.write(print.summary);
  if (format == "Fx") {
    const std::vector<PointId> ids = vertices_of(found);
    file.print("{}\n", ids.size());
    for (const PointId id : ids) file.print("{}\n", id.value);
    return;
  }
  if (format == "FC") file.print("{}\n", found.dimension);
  file.print("{}\n", found.facets.size());
  for (const LargestFacet& facet : found.facets) {
    if (format == "Fa") {
      file.print("{:6.16g} \n", facet.area);
    } else if (format == "FC") {
      print_row(file, centrum(print.points, facet.vertices, facet.normal, facet.offset));
    } else {
      file.print("{}", facet.vertices.size());
      for (const PointId id : facet.vertices) file.print(" {}", id.value);
      file.write("\n");
    }
  }
}

}  // namespace

FormatList largest_formats() {
  return {.names = {"n", "Fo", "Fi", "FV", "Fx", "Fv", "Fa", "FC", "p", "s"},
          .example = "Fa n",
          .of_whole_hull = hull_formats().names};
}

std::vector<PointId> vertices_of(const LargestFacets& found) {
  std::vector<PointId> vertices;
  for (const LargestFacet& facet : found.facets) {
    vertices.insert(vertices.end(), facet.vertices.begin(), facet.vertices.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<double> plane_rows(const LargestFacets& found, std::span<const double> largest, PlaneKind kind) {
  std::vector<double> rows;
  for (const LargestFacet& facet : found.facets) {
    rows.insert(rows.end(), facet.normal.begin(), facet.normal.end());
    CentredPlane plane{facet.normal, found.reference, facet.centred_offset, 0.0, 1.0};
    double offset = facet.offset;
    if (kind == PlaneKind::kOuter) {
      plane.claimed = facet.outer_offset;
      offset = written_offset(plane, largest, 1.0);
    } else if (kind == PlaneKind::kInner) {
      plane.claimed = facet.inner_offset;
      offset = written_offset(plane, largest, -1.0);
    }
    if (!std::isfinite(offset)) {
      throw Error(ErrorCode::kNotFinite,
                  "plane of a facet: found an offset beyond the range of doubles, expected a finite one; "
                  "divide the coordinates by a power of two");
    }
    rows.push_back(offset);
  }
  return rows;
}

void write_largest_formats(OutputFile& file, const std::vector<std::string>& formats,
                           const LargestPrint& print) {
  for (const std::string& format : formats) write_format(file, format, print);
}

}  // namespace ndhull
