// Steps in order: read, scale, hull (the library), check, select, attach points, print.
#include "tools/qhull/qhull_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <utility>

#include "approx/joggle.h"
#include "approx/verify/verify.h"
#include "core/error.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"
#include "tools/command_line/exit_code.h"
#include "tools/command_line/interrupt.h"
#include "tools/command_line/machine_memory.h"
#include "tools/command_line/named_outputs.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/warnings.h"
#include "tools/io/attached_points.h"
#include "tools/io/output_file.h"
#include "tools/io/point_reader.h"
#include "tools/io/qhull_formats.h"
#include "tools/io/text_source.h"
#include "tools/qhull/qhull_scaling.h"
#include "tools/qhull/qhull_selection.h"
#include "tools/qhull/qhull_summary.h"

namespace ndhull {
namespace {

HullOptions hull_options(const QhullCommand& command, unsigned threads) {
  HullOptions options;
  options.accuracy.outside_width.value = command.outside_width.value_or(0.0);
  options.accuracy.centrum_radius.value = command.centrum_radius;
  options.accuracy.max_cosine = command.max_cosine;
  options.triangulate = command.triangulate || !command.is_merged;
  options.threads = threads;
  return options;
}

/// A line on standard error each time `every` more simplices are there.
class FacetCounter {
 public:
  explicit FacetCounter(std::uint64_t every) : every_(every) {}
  void operator()(const Progress& progress) {
    if (progress.simplices < next_) return;
    next_ = progress.simplices + every_;
    fmt::print(stderr, "{}\n", describe(progress));
  }

 private:
  std::uint64_t every_;
  std::uint64_t next_ = 0;
};

struct Result {
  Hull hull;
  std::vector<double> joggled;  // what replaces the points; empty without a joggle
  QhullRunFacts facts;
};

Result compute(const PointView& points, const QhullCommand& command, const HullOptions& options) {
  Result result;
  const Clock::time_point start = Clock::now();
  if (command.joggle) {
    const JoggleOptions joggle{.size = *command.joggle, .seed = command.seed};
    JoggledHull joggled = joggled_hull(points, options, joggle);
    result.hull = std::move(joggled.hull);
    result.joggled = std::move(joggled.points);
    result.facts.joggle = joggled.size;
    result.facts.joggle_retries = joggled.retries;
    result.facts.problem_runs = count_precision_problems(points, options, joggle, command.reruns);
  } else {
    result.hull = convex_hull(points, options);
  }
  result.facts.hull_seconds = seconds_since(start);
  return result;
}

void warn_of_open_planes(const QhullSelection& selection, const Hull& hull) {
  fmt::print(stderr,
             "ndhull: warning: the outer planes of the {} facets kept of {} bound no region: the direction "
             "({:.6g}) stays open\n",
             selection.facets.size(), hull.facet_count(), fmt::join(selection.open_direction, ", "));
}

void warn_of_limits(const Hull& hull, const QhullCommand& command) {
  if (hull.rank < hull.dimension && !command.hides_warnings) warn_of_flat_volume(hull.rank, hull.dimension);
  if (hull.status != HullStatus::kMemoryLimit) return;
  fmt::print(stderr,
             "ndhull: warning: the machine's memory ended growth; the facets are those of {} vertices, and "
             "their outer planes hold for all points\n",
             hull.vertices.size());
}

/// Of the points as they were: planes of joggled ones are widened, and hold for them. If not, says why.
bool is_verified(const PointView& points, const Hull& hull, unsigned threads) {
  tbb::task_arena arena = arena_of(threads);
  const Verification verification =
      arena.execute([&] { return verify_hull(points, hull, VerifyMode::kFloating); });
  if (!verification.passed()) fmt::print(stderr, "ndhull: verify: {}\n", verification.first_failure());
  return verification.passed();
}

/// Points that are no vertices, to the facets that are printed and to others.
void attach(const PointView& points, const QhullCommand& command, unsigned threads, QhullPrint& print) {
  print.attached = attach_points(print.hull, points,
                                 {.coplanar = command.keep_coplanar,
                                  .interior = command.keep_interior,
                                  .depth = command.coplanar_depth.value_or(0.0)},
                                 threads);
  const auto elsewhere = std::stable_partition(
      print.attached.begin(), print.attached.end(),
      [&print](const AttachedPoint& point) { return print.label[point.facet.value] >= 0; });
  print.attached_elsewhere.assign(elsewhere, print.attached.end());
  print.attached.erase(elsewhere, print.attached.end());
}

void print_all(const QhullPrint& print, const QhullCommand& command, const QhullRunFacts& facts) {
  // Where nothing else is asked for, the summary is the result.
  const bool is_result = command.formats.empty() && !command.has_summary;
  const bool has_summary = command.has_summary || command.has_size || command.reruns > 0;
  OutputFile file(command.output_path);
  const auto say = [&](const std::string& text) {
    if (command.diagnostics_to_stdout) {
      file.write(text);
    } else {
      std::fputs(text.c_str(), stderr);
    }
  };
  if (command.lists_options) say(options_text(print.hull, command, facts));
  if (is_result) {
    file.write(summary_text(print, command, facts));
  } else if (has_summary) {
    say(summary_text(print, command, facts));
  }
  for (const std::string& format : command.formats) write_qhull_format(file, format, print);
  if (command.has_statistics) say(statistics_text(print.hull));
  file.commit();
}

}  // namespace

std::string invocation_of(std::string_view input, const QhullCommand& command) {
  const std::string_view line = input.substr(0, input.find('\n'));
  std::string_view comment;
  // The line of text above the numbers, or what stands behind the first of them. An array is no text.
  const bool is_text = !line.empty() && std::isprint(static_cast<unsigned char>(line.front())) != 0 &&
                       !begins_like_number(line.data(), line.data() + line.size());
  const std::size_t digits = line.find_first_not_of("0123456789");
  if (digits < line.size() && (digits > 0 || is_text)) {
    comment = line.substr(digits);
    comment.remove_prefix(std::min(comment.find_first_not_of(" \t\r"), comment.size()));
    while (!comment.empty() && (comment.back() == '\r' || comment.back() == ' ')) comment.remove_suffix(1);
    // Two numbers, or a table's first row, are no comment.
    if (!comment.empty() && comment.find_first_not_of("0123456789+-.,eE \t") == std::string_view::npos)
      comment = {};
  }
  const std::string_view program = command.program == QhullProgram::kQhalf ? "qhalf" : "qhull";
  return fmt::format("{} | {}{}{}", comment, program, command.text.empty() ? "" : " ", command.text);
}

int run_qhull(const QhullCommand& command, unsigned threads) {
  Interrupt interrupt;
  FileBytes bytes = FileBytes::read(command.input_path);
  const std::string invocation = invocation_of(bytes.view(), command);
  const PointFile file = command.is_cdd ? parse_cdd_points(bytes, command.input_path)
                                        : parse_points(std::move(bytes), command.input_path, {},
                                                       kKeptFileBytes, TextKind::kQhull);
  check_outputs_are_writable({{"TO", command.output_path}}, {command.input_path});
  PointSet scaled;
  PointView points = file.view();
  if (scales_points(command)) {
    scaled = scaled_points(points, command);
    points = scaled.view();
  }
  HullOptions options = hull_options(command, threads);
  options.stop = interrupt.token();
  options.limits.machine_memory_bytes = memory_of_machine();
  if (command.progress_facets > 0) options.progress = FacetCounter(command.progress_facets);
  interrupt.arm();
  const Result result = compute(points, command, options);
  warn_of_limits(result.hull, command);
  if (command.verify && !is_verified(points, result.hull, threads)) return kVerificationFailedExitCode;

  const PointView printed = result.joggled.empty()
                                ? points
                                : PointView::row_major(result.joggled.data(), points.rows, points.dimension);
  std::optional<QhullSelection> selection;
  if (selects_facets(command)) {
    selection = select_facets(result.hull, command);
    if (!selection->open_direction.empty() && !command.hides_warnings)
      warn_of_open_planes(*selection, result.hull);
  }
  std::optional<std::span<const FacetId>> facets;
  if (selection) facets = selection->facets;
  QhullPrint print(result.hull, printed, facets);
  attach(printed, command, threads, print);
  print.invocation = invocation;
  print.writes_cdd = command.writes_cdd;
  print_all(print, command, result.facts);
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

}  // namespace ndhull
