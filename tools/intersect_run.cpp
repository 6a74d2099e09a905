// Steps in order: read, intersect (the library), write. Nothing is opened for writing before the input is
// known to be good, and every file appears whole or not at all.
#include "tools/intersect_run.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/machine/stopwatch.h"
#include "tools/command_line/interrupt.h"
#include "tools/command_line/machine_memory.h"
#include "tools/command_line/named_outputs.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/warnings.h"
#include "tools/io/halfspace_numbers.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/intersection_writer.h"
#include "tools/io/output_file.h"
#include "tools/io/point_writer.h"

namespace ndhull {
namespace {

std::vector<NamedOutput> outputs_of(const IntersectRequest& request) {
  std::vector<NamedOutput> outputs;
  add_output(outputs, "--vertices", request.vertices_path, OutputKind::kPoints);
  add_output(outputs, "--format", request.formats.empty() ? "" : "-");
  add_output(outputs, "--report", request.report_path);
  return outputs;
}

/// What no halfspaces leave.
HalfspaceIntersection whole_space(std::size_t dimension) {
  HalfspaceIntersection space;
  space.kind = IntersectionKind::kUnbounded;
  space.dimension = space.rank = dimension;
  space.interior_point.assign(dimension, 0.0);
  space.inner_radius = std::numeric_limits<double>::infinity();
  space.direction.assign(dimension, 0.0);
  space.direction[0] = 1.0;
  return space;
}

/// A row that holds nowhere proves it alone.
HalfspaceIntersection nothing(const HalfspaceFile& file) {
  HalfspaceIntersection empty;
  empty.kind = IntersectionKind::kEmpty;
  empty.dimension = file.dimension;
  empty.halfspace_count = file.file_row_count;
  empty.proof.push_back({file.impossible->row, file.impossible->offset > 0.0 ? 1.0 : -1.0});
  empty.proof_gap = std::abs(file.impossible->offset);
  return empty;
}

/// What is thrown of the halfspaces names their file.
HalfspaceIntersection intersect_file(const HalfspaceFile& file, const IntersectionOptions& options) {
  if (file.impossible) return nothing(file);
  if (file.count == 0) {
    HalfspaceIntersection space = whole_space(file.dimension);
    space.halfspace_count = file.file_row_count;
    return space;
  }
  try {
    HalfspaceIntersection intersection =
        intersect_halfspaces(PointView::row_major(file.rows.data(), file.count, file.dimension + 1), options);
    number_as_in_file(intersection, file);
    return intersection;
  } catch (const Error& error) {
    throw Error(error.code(), file.path + ": " + error.what());
  }
}

void write_vertices(const IntersectRequest& request, const HalfspaceIntersection& intersection) {
  if (!request.vertices_path.empty()) {
    PointWriter writer(request.vertices_path,
                       {.rows = intersection.vertex_count(), .dimension = intersection.dimension});
    writer.write(PointView::row_major(intersection.vertices.data(), intersection.vertex_count(),
                                      intersection.dimension));
    writer.commit();
  }
  if (!request.formats.empty()) {
    OutputFile file("-");
    write_intersection_formats(file, request.formats, intersection);
    file.commit();
  }
}

}  // namespace

int run_intersect(const IntersectRequest& request) {
  const Clock::time_point start = Clock::now();
  const std::vector<NamedOutput> outputs = outputs_of(request);
  check_outputs_differ(outputs);
  Interrupt interrupt;
  ProgressLine progress(request.progress, request.quiet);
  progress.show_phase("read");
  const HalfspaceFile file = read_halfspaces(request.halfspaces_path);
  check_outputs_are_writable(outputs, {request.halfspaces_path});
  IntersectionReportContext context{.input_path = request.halfspaces_path, .options = request.options};
  context.vertex_list = request.vertex_list;
  if (!context.options.interior_point) context.options.interior_point = file.interior_point;
  context.options.stop = interrupt.token();
  context.options.limits.machine_memory_bytes = memory_of_machine();
  const bool wants_vertices = !request.vertices_path.empty() || !request.formats.empty();
  context.options.measure = !request.report_path.empty() || !wants_vertices;
  if (progress.is_shown()) {
    context.options.progress = [&progress](const Progress& now) { progress.show(now); };
  }
  context.read_seconds = seconds_since(start);

  interrupt.arm();
  const HalfspaceIntersection intersection = intersect_file(file, context.options);
  progress.clear();

  const bool has_vertices = intersection.kind == IntersectionKind::kBounded ||
                            intersection.kind == IntersectionKind::kLowerDimensional;
  const Clock::time_point write_start = Clock::now();
  if (has_vertices) write_vertices(request, intersection);
  context.write_seconds = seconds_since(write_start);
  context.total_seconds = seconds_since(start);
  if (!request.report_path.empty())
    write_text(request.report_path, intersection_report(intersection, context));
  if (wants_vertices && !has_vertices) {
    throw Error(ErrorCode::kBadHalfspace,
                fmt::format("{}: found an intersection that is {}, expected vertices to write; add or remove "
                            "halfspaces, or ask for --report only",
                            file.path, describe_without_vertices(intersection)));
  }
  if (!request.quiet && !use_standard_output(outputs)) {
    write_text("-", intersection_summary(intersection, request.halfspaces_path));
  } else if (!request.quiet && has_vertices) {
    warn_of_missing_vertices(intersection.status);
  }
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

}  // namespace ndhull
