// `ndhull-bench approximate`: approximate hulls of ndhull and Qhull. Equal options first; what Qhull reached
// then is what ndhull is asked for, facets first, then width; then ndhull's approximate hulls beside its
// exact one.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "bench/approximate.h"
#include "bench/approximate_cases.h"
#include "bench/approximate_tables.h"
#include "bench/child_process.h"
#include "bench/commands.h"
#include "bench/hull_run.h"
#include "bench/machine.h"
#include "bench/measure_options.h"
#include "bench/run_record.h"
#include "core/error.h"
#include "tools/command_line/byte_count.h"
#include "tools/view/point_extent.h"

namespace ndhull {
namespace {

/// Measures, writes down and says what was measured.
class Bench {
 public:
  explicit Bench(const ApproximateOptions& options)
      : options_(options),
        max_memory_bytes_(parse_byte_count(options.max_memory, "--max-memory")),
        done_(records_to_keep(options)),
        file_(options.json_path, options.resume) {
    if (!options.qhull_from.empty()) earlier_ = read_records(options.qhull_from);
  }

  const std::vector<RunRecord>& records() const { return records_; }

  void run_case(const ApproximateCase& approximate, bool with_targets) {
    const BenchInput input = approximate.input.load(options_.selection.data_folder);
    Repeats qhull = earlier_qhull(approximate);
    const bool is_measured_here = qhull.is_empty() && !options_.skip_qhull;
    for (unsigned round = 0; round < options_.rounds; ++round) {
      for (const bool turn_of_qhull : {round % 2 == 0, round % 2 == 1}) {
        if (!turn_of_qhull) {
          run_ndhull_case(input, approximate, approximate_task::kEqualOptions, approximate.options, round);
        } else if (is_measured_here && is_worth_another_run(qhull)) {
          add_repeat(run_qhull_case(input, approximate, round), qhull);
        }
      }
      if (!qhull.is_empty()) {
        run_ndhull_case(input, approximate, approximate_task::kEqualFacets,
                        parse_option_set(fmt::format("facets {}", qhull.last().facets)), round);
        run_ndhull_case(input, approximate, approximate_task::kEqualWidth,
                        parse_option_set(fmt::format("width {}", qhull.last().max_facet_width)), round);
      }
    }
    if (with_targets) run_targets(input, approximate);
  }

 private:
  static std::vector<RunRecord> records_to_keep(const ApproximateOptions& options) {
    if (options.resume && options.json_path.empty())
      throw Error(ErrorCode::kUsage, "--resume goes on with the file of --json: name it");
    const bool is_there = options.resume && std::filesystem::exists(options.json_path);
    return is_there ? read_records(options.json_path) : std::vector<RunRecord>{};
  }

  // Of an earlier call: then `record` becomes that, and nothing is to be measured.
  bool was_done(RunRecord& record) {
    for (const RunRecord& done : done_) {
      if (done.key == record.key && done.group == record.group && done.task == record.task &&
          done.round == record.round) {
        record = done;
        records_.push_back(record);
        return true;
      }
    }
    return false;
  }

  static bool is_worth_another_run(const Repeats& repeats) {
    return repeats.failure.empty() &&
           (repeats.is_empty() || repeats.last().wall_seconds <= BenchCase::kSlowSeconds);
  }

  /// In turns, whose order turns around, so that a slow spell of the machine is all of theirs; slow ones
  /// once. Thorough ones after that, once: their noise is small beside what they are compared with.
  void run_targets(const BenchInput& input, const ApproximateCase& approximate) {
    std::string texts;
    for (const char letter : options_.widths)
      texts += letter == ',' ? std::string(",width ") : std::string(1, letter);
    const std::vector<OptionSet> widths = parse_option_sets("width " + texts);
    std::vector<OptionSet> turns = widths;
    turns.insert(turns.begin(), parse_option_set("exact"));
    for (unsigned round = 0; round < options_.target_rounds; ++round) {
      std::vector<OptionSet> again;
      for (const OptionSet& target : turns) {
        run_ndhull_case(input, approximate, approximate_task::kTargets, target, round);
        if (records_.back().is_done() && records_.back().run.wall_seconds <= BenchCase::kSlowSeconds)
          again.push_back(target);
      }
      std::ranges::reverse(again);
      turns = std::move(again);
    }
    for (const OptionSet& width : widths)
      run_ndhull_case(input, approximate, approximate_task::kThorough,
                      parse_option_set(width.text + " thorough"), 0);
  }

  Repeats earlier_qhull(const ApproximateCase& approximate) {
    Repeats repeats;
    for (const RunRecord& record : earlier_) {
      if (record.key.engine != "qhull" || record.group != approximate.name()) continue;
      add_repeat(record, repeats);
      if (RunRecord kept = record; !was_done(kept)) keep(kept);
    }
    return repeats;
  }

  RunRecord new_record(const BenchInput& input, const ApproximateCase& approximate, const char* engine,
                       const char* task, const std::string& options, unsigned round) const {
    const bool is_target =
        std::string(task) == approximate_task::kTargets || std::string(task) == approximate_task::kThorough;
    return {.command = "approximate",
            .group = is_target ? approximate.input.name : approximate.name(),
            .task = task,
            .key = {approximate.input.name, engine, options, 1},
            .round = round,
            .points = {{"points", input.points.rows()}, {"dimension", input.points.dimension}},
            .end = {},
            .reason = {},
            .run = {}};
  }

  RunRecord run_qhull_case(const BenchInput& input, const ApproximateCase& approximate, unsigned round) {
    RunRecord record = new_record(input, approximate, "qhull", approximate_task::kEqualOptions,
                                  approximate.options.text, round);
    if (was_done(record)) return record;
    std::string words = approximate.input.unit_cube ? "QbB" : "";
    words += approximate.options.qhull_options(largest_extent(input.points.view()));
    set_result(run_in_child([&] { return nlohmann::json(run_qhull(input, words)); }, options_.max_seconds),
               record);
    keep(record);
    return record;
  }

  void run_ndhull_case(const BenchInput& input, const ApproximateCase& approximate, const char* task,
                       const OptionSet& set, unsigned round) {
    RunRecord record = new_record(input, approximate, "ndhull", task, set.text, round);
    if (was_done(record)) return;
    HullOptions options;
    options.accuracy = set.accuracy;
    options.unit_cube = approximate.input.unit_cube;
    options.threads = 1;
    options.limits.machine_memory_bytes = max_memory_bytes_;  // as the program: no limit of the user's
    set_result(run_in_child([&] { return nlohmann::json(run_ndhull(input, options)); }, options_.max_seconds),
               record);
    keep(record);
  }

  void keep(const RunRecord& record) {
    file_.write(record);
    records_.push_back(record);
    const HullRun& run = record.run;
    fmt::print("{:<34} {:<13} {:<7} {:<18} ", record.group, record.task, record.key.engine,
               record.key.options);
    if (record.is_done()) {
      fmt::print("{:>9} facets, width {:>7}, {:>8} s{}\n", run.facets, short_number(run.max_facet_width),
                 short_number(run.wall_seconds), record.is_complete() ? "" : ", " + record.status());
    } else {
      fmt::print("{}: {}\n", record.end, record.reason);
    }
    std::fflush(stdout);
  }

  const ApproximateOptions& options_;
  std::uint64_t max_memory_bytes_;
  std::vector<RunRecord> done_;  // of the file, before it is opened to go on
  RecordFile file_;
  std::vector<RunRecord> records_, earlier_;
};

std::vector<ApproximateCase> chosen_cases(const ApproximateOptions& options) {
  std::vector<ApproximateCase> cases = all_approximate_cases();
  std::erase_if(cases, [&](const ApproximateCase& approximate) {
    return !options.selection.is_chosen(approximate.name());
  });
  if (options.skip_slow) {
    std::erase_if(cases,
                  [](const ApproximateCase& approximate) { return approximate.input.is_slow_for_qhull(); });
  }
  if (options.skip_huge) {
    std::erase_if(cases, [](const ApproximateCase& approximate) { return approximate.is_huge; });
  }
  if (cases.empty()) options.selection.refuse();
  return cases;
}

void run_approximate(const ApproximateOptions& options) {
  if (options.selection.list) {
    for (const ApproximateCase& approximate : chosen_cases(options)) fmt::print("{}\n", approximate.name());
    return;
  }
  fmt::print(
      "{}\none thread; at most {} rounds, one run of Qhull where it takes over {} s; {} of hulls beside the "
      "exact one\n",
      machine_line(describe_machine()), options.rounds, BenchCase::kSlowSeconds, options.target_rounds);
  const std::vector<RunRecord> records = measure_approximate(options);
  for (const Table& table : approximate_tables(records)) fmt::print("\n{}", table.as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

std::vector<RunRecord> measure_approximate(const ApproximateOptions& options) {
  const std::vector<ApproximateCase> cases = chosen_cases(options);
  Bench bench(options);
  std::set<std::string> inputs_with_targets;
  for (const ApproximateCase& approximate : cases) {
    const bool is_new = inputs_with_targets.insert(approximate.input.name).second;
    const bool is_too_long = options.skip_huge && approximate.is_hull_huge;
    bench.run_case(approximate, is_new && !options.skip_targets && !is_too_long);
  }
  return bench.records();
}

void add_approximate_command(CLI::App& app) {
  const auto options = std::make_shared<ApproximateOptions>();
  CLI::App* command =
      app.add_subcommand("approximate", "approximate hulls of ndhull and Qhull, side by side");
  options->selection.add_options(*command);
  command->add_option("--rounds", options->rounds, "runs of each; of Qhull one where it is slow")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command
      ->add_option(
          "--target-rounds", options->target_rounds,
          fmt::format(
              "runs of the exact hull and of each of --widths, in turns; one where it takes over {} s",
              BenchCase::kSlowSeconds))
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command->add_flag("--skip-qhull", options->skip_qhull, "leave out Qhull, and what is compared with it");
  command->add_option(
      "--qhull-from", options->qhull_from,
      "take Qhull's runs from this file, that --json of an earlier run wrote on this machine");
  command->add_flag("--skip-slow", options->skip_slow,
                    fmt::format("leave out inputs on which Qhull takes over {} s", BenchCase::kSlowSeconds));
  command->add_flag("--skip-huge", options->skip_huge,
                    "of 100,000 points: leave out 8-d, and in 6-d approximate hulls beside exact ones");
  command->add_flag("--skip-targets", options->skip_targets, "leave out approximate hulls beside exact ones");
  command->add_option("--widths", options->widths, "of these approximate hulls")->capture_default_str();
  command->add_option("--max-seconds", options->max_seconds, "stop a run after this wall clock; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--max-memory", options->max_memory, "limit of ndhull's tables, like 4G")
      ->capture_default_str();
  command->add_option("--json", options->json_path, "one line of JSON for each run");
  command->add_flag("--resume", options->resume, "keep what --json has already, and measure the rest");
  command->footer(
      "Example: ndhull-bench approximate --only D5 --json approximate.jsonl\n"
      "         ndhull-bench approximate --qhull-from approximate.jsonl   # after a change of ndhull");
  command->callback([options] { run_approximate(*options); });
}

}  // namespace ndhull
