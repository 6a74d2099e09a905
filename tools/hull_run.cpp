// Steps in order: read, growth .. merge (the library), verify, write. Nothing is opened for writing before
// the input is known to be good, and every file appears whole or not at all.
#include "tools/hull_run.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "approx/report.h"
#include "core/error.h"
#include "tools/hull_summary.h"
#include "tools/index_writer.h"
#include "tools/interrupt.h"
#include "tools/named_outputs.h"
#include "tools/output_file.h"
#include "tools/plane_writer.h"
#include "tools/point_reader.h"
#include "tools/progress_line.h"
#include "tools/qhull_formats.h"

namespace ndhull {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kVerificationFailedExitCode = 2;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<NamedOutput> outputs_of(const HullRequest& request) {
  std::vector<NamedOutput> outputs;
  if (!request.planes_path.empty()) outputs.push_back({"--planes", request.planes_path});
  if (!request.vertices_path.empty()) outputs.push_back({"--vertices", request.vertices_path});
  if (!request.formats.empty()) outputs.push_back({"--format", "-"});
  if (!request.report_path.empty()) outputs.push_back({"--report", request.report_path});
  return outputs;
}

std::vector<std::pair<std::string, OptionValue>> program_options(const HullRequest& request) {
  OptionValue verify, formats;
  if (request.verify.has_value()) {
    verify = std::string(*request.verify == VerifyMode::kExact ? "exact" : "floating");
  }
  if (!request.formats.empty()) formats = fmt::format("{}", fmt::join(request.formats, " "));
  return {{"planes", path_or_null(request.planes_path)},
          {"plane_kind", std::string(to_string(request.plane_kind))},
          {"vertices", path_or_null(request.vertices_path)},
          {"report", path_or_null(request.report_path)},
          {"facet_list", request.facet_list},
          {"format", formats},
          {"verify", verify},
          {"progress", request.progress},
          {"quiet", request.quiet}};
}

void write_results(const HullRequest& request, const Hull& hull, const PointView& points) {
  if (!request.planes_path.empty()) {
    const WrittenPlanes planes(hull, points, request.plane_kind);
    write_planes(request.planes_path, hull.facet_count(), hull.dimension,
                 [&planes, &hull](std::size_t index, double* row) {
                   planes.fill(FacetId{static_cast<std::uint32_t>(index)}, {row, hull.dimension + 1});
                 });
  }
  if (!request.vertices_path.empty()) write_indices(request.vertices_path, hull.vertices);
  if (!request.formats.empty()) {
    OutputFile file("-");
    write_qhull_formats(file, request.formats, QhullPrint(hull, points));
    file.commit();
  }
}

void write_report(const std::string& path, const Hull& hull, const ReportContext& context) {
  OutputFile file(path);
  write_hull_report(hull, context, [&file](std::string_view piece) { file.write(piece); });
  file.commit();
}

}  // namespace

int run_hull(const HullRequest& request) {
  const Clock::time_point start = Clock::now();
  const std::vector<NamedOutput> outputs = outputs_of(request);
  check_outputs_differ(outputs);
  Interrupt interrupt;
  ProgressLine progress(request.progress, request.quiet);
  tbb::task_arena arena(request.options.threads == 0 ? tbb::task_arena::automatic
                                                     : static_cast<int>(request.options.threads));

  progress.show_phase("read");
  const PointFile points = read_points(request.points_path);
  check_outputs_are_writable(outputs);
  ReportContext context{.input_path = request.points_path,
                        .options = request.options,
                        .program_options = program_options(request),
                        .facet_list = request.facet_list};
  context.options.threads = static_cast<unsigned>(arena.max_concurrency());
  context.options.stop = interrupt.token();
  if (progress.is_shown()) {
    context.options.progress = [&progress](const Progress& now) { progress.show(now); };
  }
  context.read_seconds = seconds_since(start);

  interrupt.arm();
  const Hull hull = convex_hull(points.view(), context.options);

  std::optional<Verification> verification;
  if (request.verify.has_value()) {
    progress.show_phase("verify");
    const Clock::time_point verify_start = Clock::now();
    arena.execute([&] { verification = verify_hull(points.view(), hull, *request.verify); });
    context.verify_seconds = seconds_since(verify_start);
    context.verification = &*verification;
    if (!verification->passed()) {
      progress.clear();
      fmt::print(stderr, "ndhull: verify: {}\n", verification->first_failure());
      return kVerificationFailedExitCode;
    }
  }

  progress.show_phase("write");
  const Clock::time_point write_start = Clock::now();
  write_results(request, hull, points.view());
  context.write_seconds = seconds_since(write_start);
  context.total_seconds = seconds_since(start);
  context.peak_memory_bytes = peak_memory_bytes();
  progress.clear();
  if (!request.report_path.empty()) write_report(request.report_path, hull, context);
  if (!request.has_output() && !request.quiet) {
    OutputFile file("-");
    file.write(hull_summary(hull, context));
    file.commit();
  }
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

}  // namespace ndhull
