// Steps in order: read, growth .. merge (the library), verify, select, outer volume, write. Nothing is opened
// for writing before the input is known to be good, and every file appears whole or not at all.
#include "tools/hull_run.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "approx/polytope/outer_volume.h"
#include "approx/report.h"
#include "approx/selection/outer_distance.h"
#include "core/error.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"
#include "tools/command_line/exit_code.h"
#include "tools/command_line/interrupt.h"
#include "tools/command_line/machine_memory.h"
#include "tools/command_line/named_outputs.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/selection_options.h"
#include "tools/command_line/warnings.h"
#include "tools/hull_input.h"
#include "tools/hull_summary.h"
#include "tools/io/index_writer.h"
#include "tools/io/output_file.h"
#include "tools/io/plane_writer.h"
#include "tools/io/point_reader.h"
#include "tools/io/qhull_formats.h"
#include "tools/processes/process_group.h"
#include "tools/processes/shard_files.h"
#include "tools/trade_curve.h"

namespace ndhull {
namespace {

std::vector<NamedOutput> outputs_of(const HullRequest& request) {
  std::vector<NamedOutput> outputs;
  add_output(outputs, "--planes", request.planes_path, OutputKind::kPlanes);
  add_output(outputs, "--vertices", request.vertices_path, OutputKind::kNumbers);
  add_output(outputs, "--format", request.formats.empty() ? "" : "-");
  add_output(outputs, "--report", request.report_path);
  if (!request.curve_path.empty()) {
    const CurvePaths paths = curve_paths(request.curve_path);
    add_output(outputs, "--curve", paths.table);
    add_output(outputs, "--curve", paths.picture);
  }
  return outputs;
}

std::vector<std::string> inputs_of(const HullRequest& request) {
  return request.shards_pattern.empty() ? std::vector{request.points_path}
                                        : files_matching(request.shards_pattern);
}

template <class Number>
OptionValue value_or_null(const std::optional<Number>& value) {
  return value ? OptionValue(*value) : OptionValue();
}

std::vector<std::pair<std::string, OptionValue>> program_options(const HullRequest& request) {
  OptionValue verify, formats;
  const SelectionOptions& selection = request.selection;
  if (request.verify.has_value()) {
    verify = std::string(*request.verify == VerifyMode::kExact ? "exact" : "floating");
  }
  if (!request.formats.empty()) formats = fmt::format("{}", fmt::join(request.formats, " "));
  return {{"points_sharded", text_or_null(request.shards_pattern)},
          {"columns", text_or_null(request.columns.list())},
          {"largest", value_or_null(selection.largest)},
          {"select", std::string(to_string(selection.measure))},
          {"min_area", value_or_null(selection.min_area)},
          {"most_merged", value_or_null(selection.most_merged)},
          {"bounded", selection.bounded},
          {"outer_volume", request.outer_volume},
          {"planes", text_or_null(request.planes_path)},
          {"plane_kind", std::string(to_string(request.plane_kind))},
          {"equations", request.equations},
          {"vertices", text_or_null(request.vertices_path)},
          {"report", text_or_null(request.report_path)},
          {"facet_list", request.facet_list},
          {"curve", text_or_null(request.curve_path)},
          {"format", formats},
          {"verify", verify},
          {"progress", request.progress},
          {"quiet", request.quiet}};
}

/// One line on standard error.
void warn_of_open_selection(const FacetSelection& selection, const Hull& hull) {
  fmt::print(
      stderr,
      "ndhull: warning: the outer planes of the {} facets selected of {} bound no region: the direction "
      "({:.6g}) stays open; --bounded adds the few facets that close it\n",
      selection.facets.size(), hull.facet_count(), fmt::join(selection.open_direction, ", "));
}

/// `selection`: null for all facets.
void write_results(const HullRequest& request, const Hull& hull, const PointView& points,
                   const FacetSelection* selection) {
  if (!request.planes_path.empty()) {
    const WrittenPlanes planes(hull, points, request.plane_kind);
    std::vector<double> flat;
    if (request.equations)
      flat = subspace_planes(hull.subspace_equations, points, request.plane_kind);
    else if (hull.rank < hull.dimension)
      warn_of_open_subspace(hull.rank, hull.dimension);
    const std::size_t count = selection != nullptr ? selection->facets.size() : hull.facet_count();
    const std::size_t columns = hull.dimension + 1;
    write_planes(request.planes_path, count + flat.size() / columns, hull.dimension,
                 [&](std::size_t index, double* row) {
                   if (index >= count) {
                     std::copy_n(flat.data() + (index - count) * columns, columns, row);
                     return;
                   }
                   const FacetId facet = selection != nullptr ? selection->facets[index]
                                                              : FacetId{static_cast<std::uint32_t>(index)};
                   planes.fill(facet, {row, columns});
                 });
  }
  if (!request.vertices_path.empty()) write_indices(request.vertices_path, hull.vertices);
  if (!request.formats.empty()) {
    OutputFile file("-");
    std::optional<std::span<const FacetId>> printed;
    if (selection != nullptr) printed = selection->facets;
    QhullPrint print(hull, points, printed);
    if (hull.rank < hull.dimension && !request.quiet) warn_of_flat_volume(hull.rank, hull.dimension);
    print.invocation = fmt::format(
        "ndhull hull {}", request.shards_pattern.empty() ? request.points_path : request.shards_pattern);
    write_qhull_formats(file, request.formats, print);
    file.commit();
  }
}

/// [s] that are left of the limit since then; one that is used up leaves next to nothing, 0 is none.
double seconds_left(const Limits& limits, Clock::time_point start) {
  return limits.max_seconds > 0.0 ? std::max(limits.max_seconds - seconds_since(start), 1e-9) : 0.0;
}

/// What is left of the limits since then, or what the machine has.
Limits limits_left(Limits limits, Clock::time_point start) {
  limits.max_seconds = seconds_left(limits, start);
  limits.max_memory_bytes = limit_left(limits.max_memory_bytes, resident_memory_bytes());
  limits.machine_memory_bytes = memory_of_machine();
  return limits;
}

/// What is done with each facet of an exact hull once there are facets, for Limits::share_afterwards.
/// Measured in 5-d to 11-d.
double share_afterwards(const HullRequest& request) {
  constexpr double kText = 8.0, kBytes = 1.5, kBounding = 2.0, kSelecting = 0.5;
  if (!request.options.accuracy.is_exact()) return 0.0;
  double share = request.selection.bounded ? kBounding : request.selection.is_set() ? kSelecting : 0.0;
  if (request.selection.is_set()) return share;  // few are written
  if (!request.planes_path.empty()) share += request.planes_path.ends_with(".npy") ? kBytes : kText;
  if (request.facet_list) share += kText;
  return share + kText * static_cast<double>(request.formats.size());
}

/// [bytes] of each simplex, for Limits::bytes_afterwards: ids in order for --verify (complex_check.h), with the
/// ridges that are looked at meanwhile; normals once more for --bounded.
std::uint64_t bytes_afterwards(const HullRequest& request, std::size_t dimension) {
  std::uint64_t bytes = 0;
  if (request.verify) bytes = 5 * dimension + 5;
  if (request.selection.bounded && request.options.accuracy.is_exact()) bytes = 8 * dimension + 16;
  return bytes;
}

/// How large a mapped file may be to stay in memory: a small part of what is allowed.
std::size_t kept_file_bytes(const Limits& limits) {
  return limits.max_memory_bytes == 0 ? kKeptFileBytes
                                      : std::min<std::size_t>(kKeptFileBytes, limits.max_memory_bytes / 16);
}

/// [s] of what is left of the limit for one more number in the report, since the rest has to be written too;
/// 0: no limit.
double seconds_for_measure(const Limits& limits, Clock::time_point start) {
  constexpr double kShare = 0.8;
  return kShare * seconds_left(limits, start);
}

/// For what the outer polytope measures: little beside the hull, or what was asked for within all limits.
Limits limits_for_measure(const HullRequest& request, const Hull& hull, Clock::time_point start) {
  const Limits& limits = request.options.limits;
  Limits left{.max_facets = request.outer_volume ? 0 : affordable_simplices(hull, limits),
              .max_seconds = seconds_for_measure(limits, start)};
  const std::uint64_t bytes = resident_memory_bytes();
  if (limits.max_memory_bytes > 0)
    left.max_memory_bytes = limits.max_memory_bytes > bytes ? limits.max_memory_bytes - bytes : 1;
  return left;
}

/// Of the selection, else of all facets: where it costs little beside the hull, or was asked for.
OuterVolume outer_volume_of(const HullRequest& request, const Hull& hull, const ReportContext& context,
                            Clock::time_point start) {
  const bool is_complete = hull.status == HullStatus::kComplete || hull.status == HullStatus::kFacetLimit;
  if (!is_complete && !request.outer_volume) return {std::nullopt, "a limit ended growth"};
  std::span<const FacetId> facets;
  if (context.selection != nullptr) {
    if (!context.selection->bounded) return {std::nullopt, "the outer planes do not bound a region"};
    facets = context.selection->facets;
  }
  return outer_volume(hull, facets, limits_for_measure(request, hull, start), context.options.threads,
                      context.options.stop);
}

void write_report(const std::string& path, const Hull& hull, const ReportContext& context) {
  OutputFile file(path);
  write_hull_report(hull, context, [&file](std::string_view piece) { file.write(piece); });
  file.commit();
}

/// What a process computes that is not the first of several: nothing is printed or written.
HullRequest silent(const HullRequest& request) {
  HullRequest rest;
  rest.shards_pattern = request.shards_pattern;
  rest.options = request.options;
  rest.verify = request.verify;
  rest.quiet = true;
  return rest;
}

/// `group`: null for one process.
int run_process(const HullRequest& request, const ProcessGroup* group, Clock::time_point start) {
  const std::vector<NamedOutput> outputs = outputs_of(request);
  check_outputs_differ(outputs);
  Interrupt interrupt;
  ProgressLine progress(request.progress, request.quiet);
  tbb::task_arena arena = arena_of(request.options.threads);

  progress.show_phase("read");
  std::optional<HullInput> read;
  arena.execute([&] {
    read.emplace(request.points_path, request.columns, kept_file_bytes(request.options.limits),
                 request.shards_pattern, group,
                 [&] { check_outputs_are_writable(outputs, inputs_of(request)); });
  });
  HullInput& input = *read;
  ReportContext context{.input_path = request.shards_pattern + request.points_path,
                        .options = request.options,
                        .program_options = program_options(request),
                        .facet_list = request.facet_list};
  context.options.threads = static_cast<unsigned>(arena.max_concurrency());
  context.options.stop = interrupt.token();
  if (progress.is_shown()) {
    context.options.progress = [&progress](Progress now) {
      now.memory_bytes = resident_memory_bytes();
      progress.show(now);
    };
  }
  context.read_seconds = seconds_since(start);

  interrupt.arm();
  HullOptions hull_options = context.options;
  hull_options.limits = limits_left(hull_options.limits, start);
  // The hulls of a curve are built beside this one.
  if (!request.curve_path.empty())
    hull_options.limits.max_memory_bytes -= hull_options.limits.max_memory_bytes / 2;
  hull_options.limits.share_afterwards = share_afterwards(request);
  hull_options.limits.bytes_afterwards = bytes_afterwards(request, input.dimension());
  // Both look at all simplices: of an approximate hull the complex is kept then, whatever it takes.
  if (!hull_options.accuracy.is_exact())
    hull_options.wants_simplices = request.verify.has_value() || !request.formats.empty();
  std::optional<Hull> computed = input.compute(hull_options);

  std::optional<Verification> verification;
  if (request.verify.has_value()) {
    progress.show_phase("verify");
    const Clock::time_point verify_start = Clock::now();
    std::string failure;
    arena.execute([&] {
      failure = input.verify(computed ? &*computed : nullptr, *request.verify, context.options.threads,
                             verification.emplace());
    });
    context.verify_seconds = seconds_since(verify_start);
    context.verification = &*verification;
    if (!failure.empty()) {
      progress.clear();
      fmt::print(stderr, "ndhull: verify: {}\n", failure);
      return kVerificationFailedExitCode;
    }
  }
  if (!computed) return 0;  // the first process has it, and goes on alone
  Hull& hull = *computed;
  const PointView points = input.view();

  std::optional<FacetSelection> selection;
  if (request.selection.is_set()) {
    progress.show_phase("select");
    const Clock::time_point select_start = Clock::now();
    const WorkEnd end(seconds_for_measure(request.options.limits, start), context.options.stop);
    arena.execute([&] { selection = select_facets(hull, request.selection, end, &points); });
    context.select_seconds = seconds_since(select_start);
    context.selection = &*selection;
    progress.clear();
    if (!selection->bounded) warn_of_open_selection(*selection, hull);
  }
  std::optional<OuterVolume> outer;
  std::optional<OuterDistance> outer_reach;
  const bool is_summary = !use_standard_output(outputs) && !request.quiet;
  if (!request.report_path.empty() || (is_summary && outputs.empty())) {
    progress.show_phase("outer volume");
    const Clock::time_point volume_start = Clock::now();
    arena.execute([&] { outer = outer_volume_of(request, hull, context, start); });
    context.outer_volume = &*outer;
    if (selection && selection->bounded) {
      arena.execute([&] {
        outer_reach =
            outer_distance(hull, points, selection->facets, limits_for_measure(request, hull, start),
                           context.options.threads, context.options.stop);
      });
      context.outer_distance = &*outer_reach;
    }
    context.outer_volume_seconds = seconds_since(volume_start);
  }

  input.number_as_whole(hull);
  std::vector<TradePoint> curve;  // before anything is written: it may throw
  if (!request.curve_path.empty()) {
    progress.show_phase("curve");
    hull_options.progress = nullptr;
    hull_options.limits = limits_left(request.options.limits, start);
    curve = trade_curve(points, hull_options, hull, seconds_since(start) - context.read_seconds);
  }

  progress.show_phase("write");
  const Clock::time_point write_start = Clock::now();
  write_results(request, hull, points, context.selection);
  context.write_seconds = seconds_since(write_start);
  context.total_seconds = seconds_since(start);
  context.peak_memory_bytes = peak_memory_bytes();
  progress.clear();
  if (!request.report_path.empty()) write_report(request.report_path, hull, context);
  if (!request.curve_path.empty())
    write_trade_curve(curve_paths(request.curve_path), curve,
                      request.options.unit_cube ? "unit cube" : "input");
  if (is_summary) {
    OutputFile file("-");
    file.write(hull_summary(hull, context));
    file.commit();
  }
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

/// One of several processes.
int run_in_group(HullRequest request, const ProcessGroup& group, Clock::time_point start) {
  if (request.options.threads == 0) {
    const auto cores = static_cast<unsigned>(tbb::this_task_arena::max_concurrency());
    request.options.threads = std::max(1U, cores / static_cast<unsigned>(group.processes_on_machine()));
  }
  try {
    if (!request.formats.empty() || !request.curve_path.empty()) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("{}: found {} processes, expected one; start it without mpirun",
                              request.formats.empty() ? "--curve" : "--format", group.size()));
    }
    return run_process(group.is_first() ? request : silent(request), &group, start);
  } catch (const Error&) {
    if (group.is_first()) throw;
    return 0;  // the first process prints it for all, before mpirun ends them for its exit code
  }
}

}  // namespace

int run_hull(const HullRequest& request) {
  const Clock::time_point start = Clock::now();
  std::unique_ptr<ProcessGroup> group;
  if (!request.shards_pattern.empty()) group = join_processes();
  return group == nullptr ? run_process(request, nullptr, start) : run_in_group(request, *group, start);
}

}  // namespace ndhull
