// One table of names, and the formats that are a line or two. The tables of facets are in
// qhull_facet_formats.cpp, those of points in qhull_point_formats.cpp, and qhull_formats_summary.cpp has the
// summary.
#include "tools/io/qhull_formats.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace ndhull {
namespace {

using Writer = void (*)(OutputFile&, const QhullPrint&);

struct Format {
  std::string_view name;
  Writer write;            // null: part of the summary
  bool is_of_hull = true;  // ndhull hull has it, else ndhull qhull only
};

constexpr std::array<Format, 23> kFormats{{
    {"n", [](OutputFile& file, const QhullPrint& print) { write_planes_format(file, "n", print); }},
    {"Fo", [](OutputFile& file, const QhullPrint& print) { write_planes_format(file, "Fo", print); }},
    {"Fi", [](OutputFile& file, const QhullPrint& print) { write_planes_format(file, "Fi", print); }},
    {"FV", write_mean_vertex},
    {"Fx", write_extreme_points},
    {"Fv", write_facet_vertices},
    {"Fn", write_facet_neighbours},
    {"FN", write_vertex_facets},
    {"i", write_facet_simplices},
    {"o", write_off},
    {"p", write_vertex_coordinates},
    {"Fa", write_facet_areas},
    {"FA", nullptr},
    {"FS", write_size},
    {"Fs", write_statistics},
    {"FC", write_facet_centrums},
    {"s", nullptr},
    {"Fc", write_attached_points, false},
    {"Ft", write_triangulated_off, false},
    {"Fm", write_merge_counts, false},
    {"FI", write_facet_ids, false},
    {"FP", write_nearest_vertices, false},
    {"FQ", [](OutputFile& file, const QhullPrint& print) { file.print("{}\n", print.invocation); }, false},
}};

const Format& find_format(std::string_view name) {
  for (const Format& format : kFormats) {
    if (format.name == name) return format;
  }
  hull_formats().refuse(name);
}

std::vector<PointId> vertices_of(const Hull& hull, std::span<const FacetId> facets) {
  std::vector<PointId> vertices;
  for (const FacetId facet : facets) {
    const std::span<const PointId> more = hull.vertices_of(facet);
    vertices.insert(vertices.end(), more.begin(), more.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace

InputOffsets input_offsets(const Hull& hull) {
  // Without a unit cube the certified extremes are in input units already.
  if (hull.unit_cube_extents().empty()) return {hull.max_outer_offset, hull.min_inner_offset};
  InputOffsets offsets;
  for (std::size_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{static_cast<std::uint32_t>(row)};
    const double scale = hull.input_per_length_unit(facet);
    offsets.outer = std::max(offsets.outer, hull.outer_offset(facet) * scale);
    offsets.inner = std::min(offsets.inner, hull.inner_offset(facet) * scale);
  }
  return offsets;
}

QhullPrint::QhullPrint(const Hull& printed_hull, const PointView& printed_points,
                       std::optional<std::span<const FacetId>> selection)
    : hull(printed_hull), points(printed_points), order(printed_hull, printed_points) {
  const std::size_t count = hull.facet_count();
  label.resize(count);
  for (std::size_t row = 0; row < count; ++row) label[row] = -static_cast<std::int64_t>(row) - 1;
  if (selection.has_value()) {
    facets.assign(selection->begin(), selection->end());
    vertices = vertices_of(hull, facets);
  } else {
    facets.resize(count);
    for (std::size_t row = 0; row < count; ++row) facets[row] = FacetId{static_cast<std::uint32_t>(row)};
    vertices = hull.vertices;
  }
  for (std::size_t position = 0; position < facets.size(); ++position) {
    label[facets[position].value] = static_cast<std::int64_t>(position);
  }
}

FormatList hull_formats() {
  FormatList list{.names = {}, .example = "Fs n"};
  for (const Format& format : kFormats) {
    if (format.is_of_hull) list.names.push_back(format.name);
  }
  return list;
}

std::vector<std::string> split_qhull_formats(std::string_view list) {
  return split_formats(list, hull_formats());
}

void write_qhull_format(OutputFile& file, std::string_view format, const QhullPrint& print) {
  const Format& found = find_format(format);
  if (found.write != nullptr) found.write(file, print);
}

void write_qhull_formats(OutputFile& file, std::span<const std::string> formats, const QhullPrint& print) {
  const bool with_area = std::find(formats.begin(), formats.end(), "FA") != formats.end();
  bool has_summary = false;  // one for both, in the first's place
  for (const std::string& format : formats) {
    write_qhull_format(file, format, print);
    if ((format != "s" && format != "FA") || has_summary) continue;
    const auto& phases = print.hull.statistics.seconds;
    file.write(qhull_summary(
        print, {.with_area = with_area, .seconds = std::accumulate(phases.begin(), phases.end(), 0.0)}));
    has_summary = true;
  }
}

void write_size(OutputFile& file, const QhullPrint& print) {
  file.print("0\n2 {:6.16g} {:6.16g} \n", print.hull.area, print.hull.volume);
}

void write_statistics(OutputFile& file, const QhullPrint& print) {
  const Hull& hull = print.hull;
  const auto simplicial =
      static_cast<std::size_t>(std::count_if(print.facets.begin(), print.facets.end(),
                                             [&hull](FacetId facet) { return hull.is_simplicial(facet); }));
  const InputOffsets offsets = input_offsets(hull);
  // No vertices are deleted, no facets triangulated: two zeros.
  file.print("10 {} {} {} {} {} {} {} {} 0 0\n", hull.dimension, hull.point_count, hull.vertices.size(),
             hull.facet_count(), print.vertices.size(), print.facets.size(), print.attached.size(),
             print.facets.size() - simplicial);
  file.print("2 {:6.16g} {:6.16g}\n", offsets.outer, offsets.inner);
}

}  // namespace ndhull
