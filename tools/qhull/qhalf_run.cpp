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
#include "tools/command_line/named_outputs.h"
#include "tools/io/cdd_reader.h"
#include "tools/io/halfspace_numbers.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/intersection_writer.h"
#include "tools/io/output_file.h"
#include "tools/io/point_reader.h"
#include "tools/qhull/qhull_run.h"

namespace ndhull {
namespace {

/// Fd says that the input is cdd's; files that are say so themselves.
void check_cdd(const FileBytes& bytes, const std::string& path) {
  if (looks_like_cdd(text_source_of(bytes, display_name(path)))) return;
  throw Error(ErrorCode::kBadHeader,
              fmt::format("{}: found no line \"begin\", expected a cdd file as Fd says; leave Fd out",
                          display_name(path)));
}

void write_statistics(OutputFile& file, const HalfspaceIntersection& region) {
  std::size_t simple = 0;
  for (std::size_t vertex = 0; vertex < region.vertex_count(); ++vertex) {
    if (region.halfspaces_of.row(vertex).size() <= region.rank) ++simple;
  }
  const std::size_t halfspaces = region.non_redundant.size(), vertices = region.vertex_count();
  file.print("10 {} {} {} {} {} {} 0 {} 0 0\n", region.dimension, region.halfspace_count, halfspaces,
             vertices, halfspaces, vertices, vertices - simple);
  file.print("2 {:6.16g} {:6.16g}\n", region.max_residual, -region.max_residual);
}

std::string summary_of(const HalfspaceIntersection& region, const std::string& invocation, double seconds) {
  std::string text = fmt::format("\nHalfspace intersection by the convex hull of {} points in {}-d:\n\n",
                                 region.halfspace_count, region.dimension);
  text += fmt::format("  Number of halfspaces: {}\n", region.halfspace_count);
  text += fmt::format("  Number of non-redundant halfspaces: {}\n", region.non_redundant.size());
  text += fmt::format("  Number of intersection points: {}\n", region.vertex_count());
  text += fmt::format("\nStatistics for: {}\n\n", invocation);
  text += fmt::format("  CPU seconds to compute hull (after input): {:.4g}\n", seconds);
  text +=
      fmt::format("  Maximum distance of intersection point to halfspace: {:.2g}\n\n", region.max_residual);
  return text;
}

void print_all(const HalfspaceIntersection& region, const QhullCommand& command,
               const std::string& invocation, double seconds) {
  OutputFile file(command.output_path);
  for (const std::string& format : command.formats) {
    if (format == "Fs") {
      write_statistics(file, region);
    } else if (format == "FQ") {
      file.print("{}\n", invocation);
    } else {
      write_intersection_formats(file, {format}, region);
    }
  }
  const std::string summary = summary_of(region, invocation, seconds);
  const bool is_summary_all = command.formats.empty();
  if (is_summary_all || (command.has_summary && command.diagnostics_to_stdout)) {
    file.write(summary);
  } else if (command.has_summary) {
    std::fputs(summary.c_str(), stderr);
  }
  file.commit();
}

/// Is every vertex below every halfspace, up to what its own coordinates and its planes are rounded by?
bool is_below_all(const HalfspaceIntersection& region, const HalfspaceFile& file, unsigned threads) {
  const PointView vertices =
      PointView::row_major(region.vertices.data(), region.vertex_count(), region.dimension);
  const auto distances = distances_to_planes(vertices, file.rows, threads);
  const double rounding = 0x1p-51 * static_cast<double>(region.dimension);
  for (std::size_t vertex = 0; vertex < distances.size(); ++vertex) {
    double largest = 0.0;
    for (std::size_t k = 0; k < region.dimension; ++k) {
      largest = std::max(largest, std::abs(vertices.at(vertex, k)));
    }
    const double allowed = 2.0 * region.max_residual + rounding * largest;
    if (distances[vertex].distance <= allowed) continue;
    fmt::print(
        stderr,
        "ndhull: verify: intersection point {} is {:.3g} above halfspace {}, expected at most {:.3g}\n",
        vertex, distances[vertex].distance, file.row_of(distances[vertex].plane), allowed);
    return false;
  }
  return true;
}

}  // namespace

int run_qhalf(const QhullCommand& command, unsigned threads) {
  Interrupt interrupt;
  FileBytes bytes = FileBytes::read(command.input_path);
  const std::string invocation = invocation_of(bytes.view(), command);
  if (command.is_cdd) check_cdd(bytes, command.input_path);
  const HalfspaceFile file = parse_halfspaces(std::move(bytes), command.input_path);
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
  interrupt.arm();
  const Clock::time_point start = Clock::now();
  HalfspaceIntersection region =
      intersect_halfspaces(PointView::row_major(file.rows.data(), file.count, file.dimension + 1), options);
  number_as_in_file(region, file);
  const double seconds = seconds_since(start);
  if (region.kind != IntersectionKind::kBounded && region.kind != IntersectionKind::kLowerDimensional) {
    throw Error(ErrorCode::kBadHalfspace,
                fmt::format("{}: found an intersection that is {}, expected a bounded one; add or remove "
                            "halfspaces",
                            file.path, describe_without_vertices(region)));
  }
  if (command.verify && !is_below_all(region, file, threads)) return kVerificationFailedExitCode;
  print_all(region, command, invocation, seconds);
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

}  // namespace ndhull
