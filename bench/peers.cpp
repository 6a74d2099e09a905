// `ndhull-bench peers`. Each run is a child process; the engines take turns, and who starts changes with the
// round, so that a machine that warms up or throttles favours neither.
#include "bench/peers.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "bench/bench_cases.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/measure_options.h"
#include "bench/peers_table.h"
#include "bench/run_plan.h"

namespace ndhull {
namespace {

void run_peers(const PeersOptions& options) {
  if (options.selection.print_list()) return;
  const std::vector<RunRecord> records = measure_with(peers_plan(options), options.measuring);
  fmt::print("{}\n", machine_line(describe_machine()));
  for (const Table& table : peers_tables(records)) fmt::print("{}", table.as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

RunPlan peers_plan(const PeersOptions& options) {
  RunPlan plan;
  for (const BenchCase& bench_case : options.selection.cases()) {
    plan.inputs.push_back(case_input(bench_case, options.selection.data_folder));
    for (const std::string& engine : options.engines) {
      const bool is_slow = engine != "ndhull" && bench_case.is_slow_for_qhull();
      if (is_slow && options.skip_slow) continue;
      plan.runs.push_back({.input = plan.inputs.size() - 1,
                           .command = "peers",
                           .task = {},
                           .engine = engine,
                           .options = parse_option_set("exact"),
                           .rounds = is_slow ? 1 : options.rounds});
    }
  }
  return plan;
}

void add_peers_command(CLI::App& app) {
  const auto options = std::make_shared<PeersOptions>();
  options->measuring.max_seconds = 600.0;
  options->measuring.max_memory = "16G";
  options->measuring.max_repeated_seconds = BenchCase::kSlowSeconds;
  options->measuring.warm_ups = 0;
  CLI::App* command = app.add_subcommand("peers", "time and memory of ndhull and others, side by side");
  options->selection.add_options(*command);
  command->add_option("--engines", options->engines, engine_names())->delimiter(',')->capture_default_str();
  command->add_option("--rounds", options->rounds, "runs of each engine on each input; slow ones have one")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command->add_flag("--skip-slow", options->skip_slow,
                    fmt::format("leave out the others where Qhull is known to take more than {} s",
                                BenchCase::kSlowSeconds));
  options->measuring.add_options(*command);
  command->footer("Example: ndhull-bench peers --only \"D8 t1\" --rounds 5 --json peers.jsonl");
  command->callback([options] { run_peers(*options); });
}

}  // namespace ndhull
