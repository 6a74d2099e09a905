// Steps in order: read, search and certify (the library), verify, write. Nothing is opened for writing before
// the input is known to be good, and every file appears whole or not at all.
#include "tools/largest_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "approx/largest_report.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"
#include "tools/command_line/exit_code.h"
#include "tools/command_line/interrupt.h"
#include "tools/command_line/machine_memory.h"
#include "tools/command_line/named_outputs.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/warnings.h"
#include "tools/io/index_writer.h"
#include "tools/io/output_file.h"
#include "tools/io/plane_writer.h"
#include "tools/io/point_reader.h"
#include "tools/largest_formats.h"
#include "tools/largest_summary.h"

namespace ndhull {
namespace {

std::vector<NamedOutput> outputs_of(const LargestRequest& request) {
  std::vector<NamedOutput> outputs;
  add_output(outputs, "--planes", request.planes_path, OutputKind::kPlanes);
  add_output(outputs, "--vertices", request.vertices_path, OutputKind::kNumbers);
  add_output(outputs, "--report", request.report_path);
  add_output(outputs, "--format", request.formats.empty() ? "" : "-");
  return outputs;
}

std::vector<std::pair<std::string, OptionValue>> program_options(const LargestRequest& request) {
  return {{"columns", text_or_null(request.columns.list())},
          {"planes", text_or_null(request.planes_path)},
          {"plane_kind", std::string(to_string(request.plane_kind))},
          {"equations", request.equations},
          {"vertices", text_or_null(request.vertices_path)},
          {"report", text_or_null(request.report_path)},
          {"facet_list", request.facet_list},
          {"format", text_or_null(fmt::format("{}", fmt::join(request.formats, " ")))},
          {"verify", request.verify},
          {"progress", request.progress},
          {"quiet", request.quiet}};
}

void write_results(const LargestRequest& request, const LargestFacets& found, const PointView& points,
                   std::span<const double> largest) {
  if (!request.planes_path.empty()) {
    std::vector<double> rows = plane_rows(found, largest, request.plane_kind);
    if (request.equations) {
      const std::vector<double> flat = subspace_planes(found.subspace_equations, points, request.plane_kind);
      rows.insert(rows.end(), flat.begin(), flat.end());
    } else if (found.rank < found.dimension) {
      warn_of_open_subspace(found.rank, found.dimension);
    }
    const std::size_t columns = found.dimension + 1;
    write_planes(request.planes_path, rows.size() / columns, found.dimension,
                 [&rows, columns](std::size_t index, double* row) {
                   std::copy_n(rows.data() + index * columns, columns, row);
                 });
  }
  if (!request.vertices_path.empty()) {
    write_indices(request.vertices_path, vertices_of(found));
  }
}

/// What says how long all else took.
void write_texts(const LargestRequest& request, const LargestFacets& found, const PointView& points,
                 const std::vector<double>& largest, const LargestReportContext& context) {
  if (!request.formats.empty()) {
    OutputFile file("-");
    write_largest_formats(file, request.formats, {found, points, largest, largest_summary(found, context)});
    file.commit();
  }
  if (!request.report_path.empty()) write_text(request.report_path, largest_report_json(found, context));
  if (!use_standard_output(outputs_of(request)) && !request.quiet)
    write_text("-", largest_summary(found, context));
}

void warn_of_point_above(const PlaneCheck& verification) {
  fmt::print(stderr, "ndhull: verify: point {} is {:.17g} above outer plane {}\n",
             verification.worst_point.value, verification.worst_distance, verification.worst_plane);
}

}  // namespace

int run_largest(const LargestRequest& request) {
  const Clock::time_point start = Clock::now();
  const std::vector<NamedOutput> outputs = outputs_of(request);
  check_outputs_differ(outputs);
  Interrupt interrupt;
  ProgressLine progress(request.progress, request.quiet);

  progress.show_phase("read");
  tbb::task_arena arena = arena_of(request.options.threads);
  const PointFile points = arena.execute([&] { return read_points(request.points_path, request.columns); });
  check_outputs_are_writable(outputs, {request.points_path});
  LargestReportContext context{.input_path = request.points_path,
                               .options = request.options,
                               .program_options = program_options(request),
                               .facet_list = request.facet_list};
  context.options.threads = static_cast<unsigned>(arena.max_concurrency());
  context.options.stop = interrupt.token();
  context.options.machine_memory_bytes = memory_of_machine();
  if (progress.is_shown()) {
    context.options.progress = [&progress](std::string_view words) { progress.show_phase(words); };
  }
  context.read_seconds = seconds_since(start);

  interrupt.arm();
  const LargestFacets found = largest_facets(points.view(), context.options);

  const std::vector<double> largest = largest_coordinates(points.view());
  std::optional<PlaneCheck> verification;
  if (request.verify) {
    progress.show_phase("verify");
    const Clock::time_point verify_start = Clock::now();
    verification =
        check_planes(points.view(), plane_rows(found, largest, PlaneKind::kOuter), request.options.threads);
    context.verify_seconds = seconds_since(verify_start);
    context.verification = &*verification;
    if (verification->above > 0) {
      progress.clear();
      warn_of_point_above(*verification);
      return kVerificationFailedExitCode;
    }
  }

  progress.show_phase("write");
  const Clock::time_point write_start = Clock::now();
  write_results(request, found, points.view(), largest);
  context.write_seconds = seconds_since(write_start);
  context.total_seconds = seconds_since(start);
  context.peak_memory_bytes = peak_memory_bytes();
  progress.clear();
  write_texts(request, found, points.view(), largest, context);
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

}  // namespace ndhull
