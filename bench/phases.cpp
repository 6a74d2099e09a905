// `ndhull-bench phases`: the clocks that convex_hull keeps itself.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/child_process.h"
#include "bench/commands.h"
#include "bench/hull_run.h"
#include "bench/machine.h"
#include "bench/sample.h"

namespace ndhull {
namespace {

struct PhasesOptions {
  CaseSelection selection;
  unsigned rounds = 3;
  unsigned threads = 1;
  double max_seconds = 600.0;
};

using Clock = std::pair<std::string, double>;  // name and seconds

/// The run of median length of one input, or why there is none.
struct PhasesRow {
  std::string name;
  std::string failure;
  double seconds = 0.0;
  std::vector<Clock> clocks;  ///< phases, then details, in the order of the engine
};

PhasesRow measure(const BenchCase& bench_case, const PhasesOptions& options) {
  PhasesRow row{.name = bench_case.name, .failure = {}, .seconds = 0.0, .clocks = {}};
  const BenchInput input = bench_case.load(options.selection.data_folder);
  HullOptions hull_options;
  hull_options.unit_cube = bench_case.unit_cube;
  hull_options.threads = options.threads;
  std::vector<HullRun> runs;
  for (unsigned round = 0; round < options.rounds; ++round) {
    const ChildResult result =
        run_in_child([&] { return nlohmann::json(run_ndhull(input, hull_options)); }, options.max_seconds);
    if (!result.done()) {
      row.failure = result.reason;
      return row;
    }
    runs.push_back(result.values.get<HullRun>());
  }
  // One run whole, not medians of each clock: its parts add up.
  std::sort(runs.begin(), runs.end(),
            [](const HullRun& a, const HullRun& b) { return a.wall_seconds < b.wall_seconds; });
  const HullRun& middle = runs[(runs.size() - 1) / 2];
  row.seconds = middle.wall_seconds;
  for (const char* list : {"phase_seconds", "detail_seconds"}) {
    for (const nlohmann::json& clock : middle.detail.at(list)) row.clocks.push_back(clock.get<Clock>());
  }
  return row;
}

void print_table(const std::vector<PhasesRow>& rows) {
  std::vector<std::string> names;
  for (const PhasesRow& row : rows) {
    for (const Clock& clock : row.clocks) {
      if (std::find(names.begin(), names.end(), clock.first) == names.end()) names.push_back(clock.first);
    }
  }
  fmt::print("{:<20} {:>9}", "input", "total");
  for (const std::string& name : names) fmt::print(" {:>{}}", name, std::max<std::size_t>(name.size(), 9));
  fmt::print("\n");
  for (const PhasesRow& row : rows) {
    fmt::print("{:<20}", row.name);
    if (!row.failure.empty()) {
      fmt::print(" {}\n", row.failure);
      continue;
    }
    fmt::print(" {:>9.4f}", row.seconds);
    for (const std::string& name : names) {
      const auto clock = std::find_if(row.clocks.begin(), row.clocks.end(),
                                      [&](const Clock& candidate) { return candidate.first == name; });
      const std::string text = clock == row.clocks.end() ? "-" : fmt::format("{:.4f}", clock->second);
      fmt::print(" {:>{}}", text, std::max<std::size_t>(name.size(), 9));
    }
    fmt::print("\n");
  }
}

void run_phases(const PhasesOptions& options) {
  if (options.selection.print_list()) return;
  fmt::print("{}\nseconds of the run of median length of {}, {} thread(s)\n",
             machine_line(describe_machine()), options.rounds, options.threads);
  std::vector<PhasesRow> rows;
  for (const BenchCase& bench_case : options.selection.cases()) rows.push_back(measure(bench_case, options));
  print_table(rows);
  const auto has_failed = [](const PhasesRow& row) { return !row.failure.empty(); };
  if (std::any_of(rows.begin(), rows.end(), has_failed)) throw EngineFailed();
}

}  // namespace

void add_phases_command(CLI::App& app) {
  const auto options = std::make_shared<PhasesOptions>();
  CLI::App* command = app.add_subcommand("phases", "where the time of ndhull goes");
  options->selection.add_options(*command);
  command->add_option("--rounds", options->rounds, "runs on each input")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "0: all cores")->capture_default_str();
  command->add_option("--max-seconds", options->max_seconds, "stop a run after this wall clock; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->footer("Example: ndhull-bench phases --only \"D8 t1\"");
  command->callback([options] { run_phases(*options); });
}

}  // namespace ndhull
