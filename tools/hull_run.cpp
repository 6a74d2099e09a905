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
#include "tools/hull_limits.h"
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

/// One run of one process, step by step.
class HullRun {
 public:
  /// `group`: null for one process.
  HullRun(const HullRequest& request, const ProcessGroup* group, Clock::time_point start)
      : request_(request),
        group_(group),
        start_(start),
        outputs_(outputs_of(request)),
        progress_(request.progress, request.quiet),
        arena_(arena_of(request.options.threads)) {
    check_outputs_differ(outputs_);
  }

  /// Returns the exit code.
  int run() {
    read();
    prepare();
    interrupt_.arm();
    hull_ = input_->compute(hull_options_);
    if (request_.verify.has_value() && !verify()) return kVerificationFailedExitCode;
    if (!hull_) return 0;  // the first process has it, and goes on alone
    if (request_.selection.is_set()) select();
    const bool is_summary = !use_standard_output(outputs_) && !request_.quiet;
    if (!request_.report_path.empty() || (is_summary && (outputs_.empty() || request_.outer_volume)))
      measure();
    input_->number_as_whole(*hull_);
    if (!request_.curve_path.empty()) trace_curve();  // before anything is written: it may throw
    write();
    if (is_summary) {
      OutputFile file("-");
      file.write(hull_summary(*hull_, context_));
      file.commit();
    }
    return interrupt_.requested() ? kInterruptedExitCode : 0;
  }

 private:
  void read() {
    progress_.show_phase("read");
    arena_.execute([&] {
      input_.emplace(request_.points_path, request_.columns, kept_file_bytes(request_.options.limits),
                     request_.shards_pattern, group_,
                     [&] { check_outputs_are_writable(outputs_, inputs_of(request_)); });
    });
    context_.read_seconds = seconds_since(start_);
  }

  /// What the hull and its report are made with.
  void prepare() {
    context_.input_path = request_.shards_pattern + request_.points_path;
    context_.options = request_.options;
    context_.program_options = program_options(request_);
    context_.facet_list = request_.facet_list;
    context_.options.threads = static_cast<unsigned>(arena_.max_concurrency());
    context_.options.stop = interrupt_.token();
    if (progress_.is_shown()) {
      context_.options.progress = [this](Progress now) {
        now.memory_bytes = resident_memory_bytes();
        progress_.show(now);
      };
    }
    hull_options_ = context_.options;
    Limits& limits = hull_options_.limits;
    limits = limits_left(limits, start_);
    // The hulls of a curve are built beside this one.
    if (!request_.curve_path.empty()) limits.max_memory_bytes -= limits.max_memory_bytes / 2;
    limits.share_afterwards = share_afterwards(request_);
    limits.bytes_afterwards = bytes_afterwards(request_, input_->dimension());
    // Both look at all simplices: of an approximate hull the complex is kept then, whatever it takes.
    if (!hull_options_.accuracy.is_exact())
      hull_options_.wants_simplices = request_.verify.has_value() || !request_.formats.empty();
  }

  /// False: a claim does not hold, and was named.
  bool verify() {
    progress_.show_phase("verify");
    const Clock::time_point begin = Clock::now();
    std::string failure;
    arena_.execute([&] {
      failure = input_->verify(hull_ ? &*hull_ : nullptr, *request_.verify, context_.options.threads,
                               verification_.emplace());
    });
    context_.verify_seconds = seconds_since(begin);
    context_.verification = &*verification_;
    if (failure.empty()) return true;
    progress_.clear();
    fmt::print(stderr, "ndhull: verify: {}\n", failure);
    return false;
  }

  void select() {
    progress_.show_phase("select");
    const Clock::time_point begin = Clock::now();
    const PointView points = input_->view();
    const WorkEnd end(seconds_for_measure(request_.options.limits, start_), context_.options.stop);
    arena_.execute([&] { selection_ = select_facets(*hull_, request_.selection, end, &points); });
    context_.select_seconds = seconds_since(begin);
    context_.selection = &*selection_;
    progress_.clear();
    if (!selection_->bounded) warn_of_open_selection(*selection_, *hull_);
  }

  /// What the outer planes enclose, and of a selection how far that reaches.
  void measure() {
    progress_.show_phase("outer volume");
    const Clock::time_point begin = Clock::now();
    arena_.execute([&] { outer_volume_ = outer_volume_of(request_, *hull_, context_, start_); });
    context_.outer_volume = &*outer_volume_;
    if (selection_ && selection_->bounded) {
      arena_.execute([&] {
        outer_distance_ = outer_distance(*hull_, input_->view(), selection_->facets,
                                         limits_for_measure(request_, *hull_, start_),
                                         context_.options.threads, context_.options.stop);
      });
      context_.outer_distance = &*outer_distance_;
    }
    context_.outer_volume_seconds = seconds_since(begin);
  }

  void trace_curve() {
    progress_.show_phase("curve");
    hull_options_.progress = nullptr;
    hull_options_.limits = limits_left(request_.options.limits, start_);
    curve_ =
        trade_curve(input_->view(), hull_options_, *hull_, seconds_since(start_) - context_.read_seconds);
  }

  void write() {
    progress_.show_phase("write");
    const Clock::time_point begin = Clock::now();
    write_results(request_, *hull_, input_->view(), context_.selection);
    context_.write_seconds = seconds_since(begin);
    context_.total_seconds = seconds_since(start_);
    context_.peak_memory_bytes = peak_memory_bytes();
    progress_.clear();
    if (!request_.report_path.empty()) write_report(request_.report_path, *hull_, context_);
    if (!request_.curve_path.empty())
      write_trade_curve(curve_paths(request_.curve_path), curve_,
                        request_.options.unit_cube ? "unit cube" : "input");
  }

  const HullRequest& request_;
  const ProcessGroup* group_;
  Clock::time_point start_;
  std::vector<NamedOutput> outputs_;
  Interrupt interrupt_;
  ProgressLine progress_;
  tbb::task_arena arena_;
  std::optional<HullInput> input_;
  HullOptions hull_options_;
  std::optional<Hull> hull_;
  ReportContext context_;  // with what follows
  std::optional<Verification> verification_;
  std::optional<FacetSelection> selection_;
  std::optional<OuterVolume> outer_volume_;
  std::optional<OuterDistance> outer_distance_;
  std::vector<TradePoint> curve_;
};

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
    const HullRequest own = group.is_first() ? request : silent(request);
    return HullRun(own, &group, start).run();
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
  return group == nullptr ? HullRun(request, nullptr, start).run() : run_in_group(request, *group, start);
}

}  // namespace ndhull
