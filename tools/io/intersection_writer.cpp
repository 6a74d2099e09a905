#include "tools/io/intersection_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include "approx/report.h"
#include "approx/report_json.h"
#include "core/error.h"
#include "core/id_rows.h"
#include "tools/io/vertex_order.h"

namespace ndhull {
namespace {

void write_rows(OutputFile& file, const IdRows& rows, bool with_count) {
  file.print("{}\n", rows.begin.size() - 1);
  for (std::size_t row = 0; row + 1 < rows.begin.size(); ++row) {
    const auto ids = rows.row(row);
    if (with_count) file.print("{} ", ids.size());
    for (const std::uint32_t id : ids) file.print("{} ", id);
    file.write("\n");
  }
}

// "%6.16g " as C prints it, which is what Qhull prints. A third of the time of an intersection went into the
// numbers with a format string: std::to_chars takes half as long.
void append_number(std::string& line, double value) {
  constexpr std::size_t kWidth = 6;
  std::array<char, 40> text;
  text.fill(' ');
  char* const begin = text.data() + kWidth;
  const auto [end, error] =
      std::to_chars(begin, text.data() + text.size() - 1, value, std::chars_format::general, 16);
  const auto length = static_cast<std::size_t>(end - begin);
  const std::size_t padding = length < kWidth ? kWidth - length : 0;
  line.append(begin - padding, padding + length + 1);
}

void write_vertices(OutputFile& file, const HalfspaceIntersection& intersection) {
  file.print("{}\n{}\n", intersection.dimension, intersection.vertex_count());
  std::string line;
  for (std::size_t at = 0; at < intersection.vertices.size(); ++at) {
    append_number(line, intersection.vertices[at]);
    if ((at + 1) % intersection.dimension != 0) continue;
    line += '\n';
    file.write(line);
    line.clear();
  }
}

/// The vertices of a polygon once round, counterclockwise; empty where rounding makes it no polygon.
std::vector<std::uint32_t> polygon_of(const HalfspaceIntersection& intersection) {
  const auto count = static_cast<std::uint32_t>(intersection.vertex_count());
  const auto at = [&](std::uint32_t vertex, std::size_t k) { return intersection.vertices[2 * vertex + k]; };
  std::vector<std::uint32_t> path;
  double area = 0.0;
  for (std::uint32_t vertex = 0, last = count; path.size() < count;) {
    path.push_back(vertex);
    const auto neighbours = intersection.neighbours_of.row(vertex);
    if (neighbours.size() != 2) return {};
    const std::uint32_t next = neighbours[0] == last ? neighbours[1] : neighbours[0];
    area += (at(vertex, 0) - at(0, 0)) * (at(next, 1) - at(0, 1)) -
            (at(next, 0) - at(0, 0)) * (at(vertex, 1) - at(0, 1));
    last = vertex;
    vertex = next;
    if ((vertex == 0) != (path.size() == count)) return {};
  }
  if (area < 0.0) std::reverse(path.begin(), path.end());
  return path;
}

/// Halfspaces that are not redundant: ascending, those of a polygon counterclockwise from the first of them.
std::vector<std::uint32_t> ordered_halfspaces(const HalfspaceIntersection& intersection) {
  const std::vector<std::uint32_t>& ascending = intersection.non_redundant;
  if (intersection.dimension != 2 || intersection.rank != 2) return ascending;
  const std::vector<std::uint32_t> path = polygon_of(intersection);
  std::vector<std::uint32_t> ids;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto other = intersection.halfspaces_of.row(path[(k + 1) % path.size()]);
    for (const std::uint32_t id : intersection.halfspaces_of.row(path[k])) {
      if (std::find(other.begin(), other.end(), id) == other.end()) continue;
      if (std::binary_search(ascending.begin(), ascending.end(), id)) ids.push_back(id);
    }
  }
  if (!std::is_permutation(ids.begin(), ids.end(), ascending.begin(), ascending.end())) return ascending;
  std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
  return ids;
}

void write_non_redundant(OutputFile& file, const HalfspaceIntersection& intersection) {
  const std::vector<std::uint32_t> ids = ordered_halfspaces(intersection);
  file.print("{}\n", ids.size());
  for (const std::uint32_t id : ids) file.print("{}\n", id);
}

/// Row h of the transposed table: the vertices in halfspace h.
IdRows vertices_of_halfspaces(const HalfspaceIntersection& intersection) {
  const IdRows& halfspaces = intersection.halfspaces_of;
  IdRows rows;
  rows.begin.assign(intersection.halfspace_count + 1, 0);
  for (const std::uint32_t id : halfspaces.values) ++rows.begin[id + 1];
  for (std::size_t id = 0; id < intersection.halfspace_count; ++id) rows.begin[id + 1] += rows.begin[id];
  rows.values.resize(halfspaces.values.size());
  std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
  for (std::uint32_t vertex = 0; vertex + 1 < halfspaces.begin.size(); ++vertex) {
    for (const std::uint32_t id : halfspaces.row(vertex)) rows.values[next[id]++] = vertex;
  }
  return rows;
}

using RegionWriter = void (*)(OutputFile&, const HalfspaceIntersection&);

/// The rows of all vertices in an order of vertex_order.h.
template <class Order>
IdRows ordered(const HalfspaceIntersection& intersection, const Order& order) {
  IdRows rows;
  for (std::size_t vertex = 0; vertex < intersection.vertex_count(); ++vertex)
    rows.append(order(intersection, vertex));
  return rows;
}

struct RegionFormat {
  std::string_view name, meaning;
  RegionWriter write;
};

// In the order of help, where a meaning speaks of what stands before it.
constexpr RegionFormat kRegionFormats[] = {
    {"Fp", "vertices", write_vertices},
    {"Fv", "their halfspaces",
     [](OutputFile& file, const auto& region) { write_rows(file, region.halfspaces_of, true); }},
    {"Fn", "their neighbours",
     [](OutputFile& file, const auto& region) {
       write_rows(file, ordered(region, opposite_neighbours), true);
     }},
    {"Fx", "halfspaces that are not redundant", write_non_redundant},
    {"FN", "their vertices",
     [](OutputFile& file, const auto& region) { write_rows(file, vertices_of_halfspaces(region), true); }},
    {"i", "Fv without counts",
     [](OutputFile& file, const auto& region) {
       write_rows(file, ordered(region, oriented_halfspaces), false);
     }},
};

const RegionFormat& find_format(const std::string& name) {
  for (const RegionFormat& format : kRegionFormats) {
    if (format.name == name) return format;
  }
  intersection_formats().refuse(name);
}

std::string status_of(const HalfspaceIntersection& intersection) {
  std::string name(to_string(intersection.kind));
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

/// JSON has no infinity: null says that there is no largest ball.
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json row_of(std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); }

Json equations_of(const HalfspaceIntersection& intersection) {
  Json rows = Json::array();
  const std::size_t columns = intersection.dimension + 1;
  for (std::size_t at = 0; at < intersection.equations.size(); at += columns)
    rows.push_back(row_of({intersection.equations.data() + at, columns}));
  return rows;
}

Json proof_of(const HalfspaceIntersection& intersection) {
  Json terms = Json::array();
  for (const HalfspaceWeight& term : intersection.proof)
    terms.push_back({{"halfspace", term.halfspace}, {"weight", term.weight}});
  return {{"combination", std::move(terms)},
          {"gap", intersection.proof_gap},
          {"residual", intersection.proof_residual}};
}

Json vertices_of(const HalfspaceIntersection& intersection) {
  Json list = Json::array();
  for (std::size_t vertex = 0; vertex < intersection.vertex_count(); ++vertex) {
    const auto halfspaces = intersection.halfspaces_of.row(vertex);
    const auto neighbours = intersection.neighbours_of.row(vertex);
    list.push_back({{"point", row_of({intersection.vertices.data() + vertex * intersection.dimension,
                                      intersection.dimension})},
                    {"halfspaces", std::vector<std::uint32_t>(halfspaces.begin(), halfspaces.end())},
                    {"neighbors", std::vector<std::uint32_t>(neighbours.begin(), neighbours.end())}});
  }
  return list;
}

}  // namespace

FormatList intersection_formats() {
  FormatList list{.names = {}, .example = "Fp Fv"};
  for (const RegionFormat& format : kRegionFormats) list.names.push_back(format.name);
  return list;
}

std::string describe_intersection_formats() {
  std::string text;
  for (const RegionFormat& format : kRegionFormats)
    text += fmt::format("{}{} ({})", text.empty() ? "" : " ", format.name, format.meaning);
  return text;
}

void write_intersection_formats(OutputFile& file, const std::vector<std::string>& formats,
                                const HalfspaceIntersection& intersection) {
  for (const std::string& name : formats) find_format(name);
  for (const std::string& name : formats) find_format(name).write(file, intersection);
}

std::string describe_without_vertices(const HalfspaceIntersection& intersection) {
  if (intersection.kind == IntersectionKind::kEmpty) {
    std::string names;
    for (const HalfspaceWeight& term : intersection.proof)
      names += fmt::format("{}{}", names.empty() ? "" : ", ", term.halfspace);
    return fmt::format("empty: every point is {:.6g} or more outside one of the halfspaces {}",
                       intersection.proof_gap, names);
  }
  return fmt::format("unbounded along ({:.6g})", fmt::join(intersection.direction, ", "));
}

std::string intersection_summary(const HalfspaceIntersection& intersection, const std::string& path) {
  std::string text =
      fmt::format("halfspaces  {}: {} in {}-d\n", path, intersection.halfspace_count, intersection.dimension);
  const bool has_vertices = intersection.kind == IntersectionKind::kBounded ||
                            intersection.kind == IntersectionKind::kLowerDimensional;
  text += fmt::format("status      {}\n",
                      has_vertices ? status_of(intersection) : describe_without_vertices(intersection));
  if (intersection.kind == IntersectionKind::kEmpty) return text;
  if (intersection.status != HullStatus::kComplete) {
    text += fmt::format("limit       {}: the intersection is inside what follows\n",
                        to_string(intersection.status));
  }
  if (intersection.rank < intersection.dimension) {
    text += fmt::format("rank        {}: the region lies in the planes of {} halfspaces\n", intersection.rank,
                        intersection.equalities.size());
  }
  if (!has_vertices) return text;
  text += fmt::format("vertices    {}\n", intersection.vertex_count());
  text += fmt::format("bounding    {} halfspaces are not redundant\n", intersection.non_redundant.size());
  if (intersection.volume) {
    text += fmt::format("volume      {:.10g}\n", *intersection.volume);
  } else if (intersection.measure_status != HullStatus::kComplete) {
    text += fmt::format("volume      none: {}\n", to_string(intersection.measure_status));
  }
  if (intersection.area) text += fmt::format("area        {:.10g}\n", *intersection.area);
  text += fmt::format("residual    {:.3g}: the furthest vertex from a plane it is on\n",
                      intersection.max_residual);
  return text;
}

std::string intersection_report(const HalfspaceIntersection& intersection,
                                const IntersectionReportContext& context) {
  const bool is_empty = intersection.kind == IntersectionKind::kEmpty;
  Json report{{"ndhull", version()},
              {"input",
               {{"path", context.input_path},
                {"halfspaces", intersection.halfspace_count},
                {"dimension", intersection.dimension}}},
              {"status", status_of(intersection)},
              {"hull_status", to_string(intersection.status)},
              {"options",
               {{"interior_point",
                 context.options.interior_point ? Json(*context.options.interior_point) : Json(nullptr)},
                {"max_facets", limit(context.options.limits.max_facets)},
                {"max_seconds", limit(context.options.limits.max_seconds)},
                {"max_memory", limit(context.options.limits.max_memory_bytes)},
                {"threads", context.options.threads},
                {"seed", context.options.seed}}}};
  if (is_empty) {
    report["proof"] = proof_of(intersection);
  } else {
    report["rank"] = intersection.rank;
    report["interior_point"] = intersection.interior_point;
    report["inner_radius"] = finite_or_null(intersection.inner_radius);
    report["equations"] = equations_of(intersection);
    report["equalities"] = intersection.equalities;
  }
  if (intersection.kind == IntersectionKind::kUnbounded) {
    report["direction"] = intersection.direction;
    report["direction_margin"] = intersection.direction_margin;
  } else if (!is_empty) {
    report["vertices"] = intersection.vertex_count();
    report["non_redundant"] = intersection.non_redundant;
    report["volume"] = intersection.volume ? Json(*intersection.volume) : Json(nullptr);
    if (!intersection.volume && intersection.measure_status != HullStatus::kComplete)
      report["volume_reason"] = to_string(intersection.measure_status);
    report["area"] = intersection.area ? Json(*intersection.area) : Json(nullptr);
    report["max_residual"] = intersection.max_residual;
  }
  report["seconds"] = {{"read", context.read_seconds},
                       {"region", intersection.region_seconds},
                       {"dual_hull", intersection.dual_hull_seconds},
                       {"vertices", intersection.vertex_seconds},
                       {"measure", intersection.measure_seconds},
                       {"write", context.write_seconds},
                       {"total", context.total_seconds}};
  report["peak_memory_bytes"] = peak_memory_bytes();
  if (context.vertex_list) report["vertex_list"] = vertices_of(intersection);
  return report_text(report) + '\n';
}

}  // namespace ndhull
