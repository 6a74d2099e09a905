// Steps in order: read, intersect (the library), check, print.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "approx/planes/contains.h"
#include "approx/polytope/halfspace_intersection.h"
#include "core/error.h"
#include "core/machine/stopwatch.h"
#include "tools/command_line/exit_code.h"
#include "tools/command_line/interrupt.h"
#include "tools/command_line/machine_memory.h"
#include "tools/command_line/named_outputs.h"
#include "tools/command_line/warnings.h"
#include "tools/io/cdd_reader.h"
#include "tools/io/halfspace_numbers.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/intersection_writer.h"
#include "tools/io/output_file.h"
#include "tools/io/point_reader.h"
#include "tools/io/qhull_formats.h"
#include "tools/qhull/open_intersection.h"
#include "tools/qhull/qhull_run.h"

namespace ndhull {
namespace {

std::size_t simple_vertices(const HalfspaceIntersection& region) {
  std::size_t simple = 0;
  for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex) {
    if (region.halfspaces_of.row(vertex).size() <= region.rank) ++simple;
  }
  return simple;
}

void write_statistics(OutputFile& file, const HalfspaceIntersection& region) {
  const std::size_t halfspaces = region.non_redundant.size(), vertices = region.vertex_count();
  file.print("10 {} {} {} {} {} {} 0 {} 0 0\n", region.dimension, region.halfspace_count, halfspaces,
             vertices, halfspaces, vertices, vertices - simple_vertices(region));
  file.print("2 {:6.16g} {:6.16g}\n", region.max_residual, -region.max_residual);
}

/// What the summary says of either kind of intersection.
struct RegionCounts {
  std::size_t dimension, halfspaces, non_redundant, points, non_simplicial, open_points;
  double max_residual;
};

std::string summary_of(const RegionCounts& counts, const std::string& invocation, double seconds) {
  std::string text = fmt::format("\nHalfspace intersection by the convex hull of {} points in {}-d:\n\n",
                                 counts.halfspaces, counts.dimension);
  text += fmt::format("  Number of halfspaces: {}\n", counts.halfspaces);
  text += fmt::format("  Number of non-redundant halfspaces: {}\n", counts.non_redundant);
  text += fmt::format("  Number of intersection points: {}\n", counts.points);
  if (counts.non_simplicial > 0)
    text += fmt::format("  Number of non-simplicial intersection points: {}\n", counts.non_simplicial);
  if (counts.open_points > 0) text += fmt::format("  Number of these at infinity: {}\n", counts.open_points);
  text += fmt::format("\nStatistics for: {}\n\n", invocation);
  text += fmt::format("  CPU seconds to compute hull (after input): {:.4g}\n", seconds);
  text +=
      fmt::format("  Maximum distance of intersection point to halfspace: {:.2g}\n\n", counts.max_residual);
  return text;
}

/// Prints the formats by `write_format`, and the summary where Qhull does: to the output where it is all
/// there is to print and nobody asked for it, else to standard error.
template <class WriteFormat>
void print_all(const QhullCommand& command, const std::string& summary, const WriteFormat& write_format) {
  OutputFile file(command.output_path);
  const bool is_result = command.formats.empty() && !command.has_summary;
  if (is_result || (command.has_summary && command.diagnostics_to_stdout)) {
    file.write(summary);
  } else if (command.has_summary) {
    std::fputs(summary.c_str(), stderr);
  }
  for (const std::string& format : command.formats) write_format(file, format);
  file.commit();
}

void print_region(const HalfspaceIntersection& region, const QhullCommand& command,
                  const std::string& invocation, double seconds) {
  const RegionCounts counts{.dimension = region.dimension,
                            .halfspaces = region.halfspace_count,
                            .non_redundant = region.non_redundant.size(),
                            .points = region.vertex_count(),
                            .non_simplicial = region.vertex_count() - simple_vertices(region),
                            .open_points = 0,
                            .max_residual = region.max_residual};
  print_all(command, summary_of(counts, invocation, seconds), [&](OutputFile& file, const auto& format) {
    if (format == "Fs") {
      write_statistics(file, region);
    } else if (format == "FQ") {
      file.print("{}\n", invocation);
    } else {
      write_intersection_formats(file, {format}, region);
    }
  });
}

/// All formats but the points are those of the dual hull.
void print_open(const OpenIntersection& open, const QhullCommand& command, const std::string& invocation,
                double seconds) {
  const Hull& dual = open.hull;
  QhullPrint print(dual, open.dual_view());
  print.invocation = invocation;
  const RegionCounts counts{.dimension = dual.dimension,
                            .halfspaces = dual.point_count,
                            .non_redundant = dual.vertices.size(),
                            .points = dual.facet_count(),
                            .non_simplicial = dual.facet_count() - dual.simplicial_facet_count(),
                            .open_points = open.open_facets,
                            .max_residual = open.max_residual};
  print_all(command, summary_of(counts, invocation, seconds), [&](OutputFile& file, const auto& format) {
    if (format != "Fp") return write_qhull_format(file, format, print);
    file.print("{}\n{}\n", dual.dimension, dual.facet_count());
    for (std::size_t at = 0; at < open.points.size(); at += dual.dimension)
      print_row(file, {open.points.data() + at, dual.dimension});
  });
  if (command.hides_warnings) return;
  fmt::print(stderr,
             "ndhull: warning: the intersection has no end: {} of {} intersection points are at infinity and "
             "printed as {}\n",
             open.open_facets, dual.facet_count(), kNoIntersectionPoint);
}

/// Is every vertex below every halfspace, up to what its own coordinates and its planes are rounded by?
bool is_below_all(const std::vector<double>& points, double max_residual, const HalfspaceFile& file,
                  unsigned threads) {
  const std::size_t dimension = file.dimension;
  const PointView vertices = PointView::row_major(points.data(), points.size() / dimension, dimension);
  const auto distances = distances_to_planes(vertices, file.rows, threads);
  const double rounding = 0x1p-51 * static_cast<double>(dimension);
  for (std::size_t vertex = 0; vertex < distances.size(); ++vertex) {
    double largest = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      largest = std::max(largest, std::abs(vertices.at(vertex, k)));
    }
    const double allowed = 2.0 * max_residual + rounding * largest;
    if (distances[vertex].distance <= allowed || vertices.at(vertex, 0) == kNoIntersectionPoint) continue;
    fmt::print(
        stderr,
        "ndhull: verify: intersection point {} is {:.3g} above halfspace {}, expected at most {:.3g}\n",
        vertex, distances[vertex].distance, file.row_of(distances[vertex].plane), allowed);
    return false;
  }
  return true;
}

/// Nothing has a dual hull: the intersection is empty, or without end and flat or by too few halfspaces.
Error no_points(const HalfspaceIntersection& region, const std::string& path) {
  if (region.kind == IntersectionKind::kEmpty) {
    return {ErrorCode::kBadHalfspace,
            fmt::format("{}: found an intersection that is {}, expected points inside all halfspaces; remove "
                        "one of these",
                        path, describe_without_vertices(region))};
  }
  return {ErrorCode::kBadHalfspace,
          fmt::format("{}: found an intersection that is {}, of {} halfspaces whose dual points span fewer "
                      "than {} dimensions, expected {} or more in general position; add halfspaces far away",
                      path, describe_without_vertices(region), region.halfspace_count, region.dimension,
                      region.dimension + 1)};
}

}  // namespace

int run_qhalf(const QhullCommand& command, unsigned threads) {
  Interrupt interrupt;
  FileBytes bytes = FileBytes::read(command.input_path);
  const std::string invocation = invocation_of(bytes.view(), command);
  if (command.is_cdd) require_cdd(text_source_of(bytes, display_name(command.input_path)));
  const HalfspaceFile file = parse_halfspaces(std::move(bytes), command.input_path, TextKind::kQhull);
  file.require_possible();
  check_outputs_are_writable({{"TO", command.output_path}}, {command.input_path});
  IntersectionOptions options;
  options.interior_point = file.interior_point;
  if (!options.interior_point && !command.interior_point.empty()) {  // Qhull too prefers the input's
    options.interior_point = command.interior_point;
    // Coordinates that are not given are 0, as Qhull takes them.
    if (command.interior_point.size() < file.dimension) options.interior_point->resize(file.dimension, 0.0);
  }
  options.measure = false;
  options.threads = threads;
  options.stop = interrupt.token();
  options.limits.machine_memory_bytes = memory_of_machine();
  interrupt.arm();
  const Clock::time_point start = Clock::now();
  HalfspaceIntersection region =
      intersect_halfspaces(PointView::row_major(file.rows.data(), file.count, file.dimension + 1), options);
  const bool is_open = region.kind == IntersectionKind::kUnbounded && region.rank == file.dimension &&
                       file.count > region.rank;
  if (is_open) {
    HullOptions dual;
    dual.threads = threads;
    dual.stop = options.stop;
    dual.limits.machine_memory_bytes = options.limits.machine_memory_bytes;
    const OpenIntersection open = open_intersection(file, region.interior_point, dual);
    if (open.hull.rank < file.dimension) throw no_points(region, file.path);
    if (command.verify && !is_below_all(open.points, open.max_residual, file, threads))
      return kVerificationFailedExitCode;
    warn_of_missing_vertices(open.hull.status);
    print_open(open, command, invocation, seconds_since(start));
  } else {
    number_as_in_file(region, file);
    const double seconds = seconds_since(start);
    if (region.kind == IntersectionKind::kEmpty || region.kind == IntersectionKind::kUnbounded)
      throw no_points(region, file.path);
    if (command.verify && !is_below_all(region.vertices, region.max_residual, file, threads))
      return kVerificationFailedExitCode;
    warn_of_missing_vertices(region.status);
    print_region(region, command, invocation, seconds);
  }
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

}  // namespace ndhull
