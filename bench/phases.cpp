// `ndhull-bench phases`: the clocks that convex_hull keeps itself.
#include "bench/phases.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>

#include "bench/bench_cases.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/measure_options.h"
#include "bench/run_csv.h"
#include "bench/run_plan.h"

namespace ndhull {
namespace {

constexpr const char* kPhasesCommand = "phases";

struct PhasesOptions {
  CaseSelection selection;
  unsigned rounds = 3;
  unsigned threads = 1;
  MeasureOptions measuring;
};

using Clock = std::pair<std::string, double>;  // name and seconds

// Phases, then details, in the order of the engine.
std::vector<Clock> clocks_of(const HullRun& run) {
  std::vector<Clock> clocks;
  for (const char* list : {"phase_seconds", "detail_seconds"}) {
    for (const nlohmann::json& clock : run.detail.at(list)) clocks.push_back(clock.get<Clock>());
  }
  return clocks;
}

// One run whole, not medians of each clock: its parts add up.
const HullRun& middle_run(Repeats& repeats) {
  std::sort(repeats.done.begin(), repeats.done.end(),
            [](const RunRecord& a, const RunRecord& b) { return a.run.wall_seconds < b.run.wall_seconds; });
  return repeats.done[(repeats.done.size() - 1) / 2].run;
}

RunPlan phases_plan(const PhasesOptions& options) {
  RunPlan plan;
  for (const BenchCase& bench_case : options.selection.cases()) {
    plan.inputs.push_back(case_input(bench_case, options.selection.data_folder));
    plan.runs.push_back({.input = plan.inputs.size() - 1,
                         .command = kPhasesCommand,
                         .task = {},
                         .engine = "ndhull",
                         .options = parse_option_set("exact"),
                         .threads = options.threads == 0 ? available_threads() : options.threads,
                         .rounds = options.rounds});
  }
  return plan;
}

void run_phases(const PhasesOptions& options) {
  if (options.selection.print_list()) return;
  const std::vector<RunRecord> records = measure_with(phases_plan(options), options.measuring);
  fmt::print("{}\n{}", machine_line(describe_machine()), phases_table(records).as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

Table phases_table(const std::vector<RunRecord>& records) {
  Table table{.title = "Where the seconds go",
              .note = "ndhull, exact hulls: the run of median length, whole, and the clocks it keeps itself.",
              .columns = {"input", "threads", "total"},
              .rows = {}};
  std::vector<RunRecord> exact;
  std::copy_if(records.begin(), records.end(), std::back_inserter(exact), [](const RunRecord& record) {
    const bool is_ours = record.command == kPhasesCommand || record.command == "peers";
    return is_ours && record.key.engine == "ndhull" && record.key.options == "exact";
  });
  auto measurements = measurements_of(exact);
  std::vector<std::string> names;
  for (const auto& [record, repeats] : measurements) {
    if (repeats.is_empty()) continue;
    for (const auto& [name, seconds] : clocks_of(repeats.last())) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  table.columns.insert(table.columns.end(), names.begin(), names.end());
  for (auto& [record, repeats] : measurements) {
    std::vector<std::string> row{record.key.input, fmt::format("{}", record.key.threads)};
    if (repeats.is_empty()) {
      row.push_back(repeats.failure);
    } else {
      const HullRun& run = middle_run(repeats);
      const std::vector<Clock> clocks = clocks_of(run);
      row.push_back(fmt::format("{:.4f}", run.wall_seconds));
      for (const std::string& name : names) {
        const auto clock = std::find_if(clocks.begin(), clocks.end(),
                                        [&](const Clock& candidate) { return candidate.first == name; });
        row.push_back(clock == clocks.end() ? "-" : fmt::format("{:.4f}", clock->second));
      }
    }
    row.resize(table.columns.size(), "-");
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_phases_command(CLI::App& app) {
  const auto options = std::make_shared<PhasesOptions>();
  options->measuring.max_seconds = 600.0;
  options->measuring.max_memory = "16G";
  options->measuring.warm_ups = 0;
  CLI::App* command = app.add_subcommand("phases", "where the time of ndhull goes");
  options->selection.add_options(*command);
  command->add_option("--rounds", options->rounds, "runs on each input")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "0: all cores")->capture_default_str();
  options->measuring.add_options(*command);
  command->footer("Example: ndhull-bench phases --only \"D8 t1\"");
  command->callback([options] { run_phases(*options); });
}

}  // namespace ndhull
