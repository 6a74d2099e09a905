// `ndhull-bench sweep`: families x dimensions x numbers of points x options, both engines.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/measure_options.h"
#include "bench/run_csv.h"
#include "bench/run_plan.h"
#include "bench/sweep.h"
#include "core/error.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

// The same whatever the count: taken whole, once.
bool is_finite_family(const std::string& family) {
  return family == "cube-corners" || family == "lattice" || family == "cross-polytope";
}

void add_runs(std::size_t input, const SweepOptions& options, RunPlan& plan) {
  for (const OptionSet& set : parse_option_sets(options.option_sets)) {
    for (const std::string& engine : options.engines) {
      if (engine == "qhull" && !set.is_for_qhull()) continue;
      if ((engine == "cgal" || engine == "lrs") && !set.accuracy.is_exact()) continue;
      for (const unsigned threads : options.threads) {
        if (engine != "ndhull" && threads != options.threads.front()) continue;
        plan.runs.push_back({.input = input,
                             .command = "sweep",
                             .task = {},
                             .engine = engine,
                             .options = set,
                             .threads = engine == "ndhull" ? threads : 1,
                             .rounds = options.rounds});
      }
    }
  }
}

}  // namespace

RunPlan sweep_plan(const SweepOptions& options) {
  RunPlan plan;
  const auto add = [&](PlannedInput input) {
    input.unit_cube = options.unit_cube;
    plan.inputs.push_back(std::move(input));
    add_runs(plan.inputs.size() - 1, options, plan);
  };
  const std::vector<std::size_t> dimensions = parse_range(options.dimensions);
  for (const std::string& family : options.families) {
    std::vector<std::size_t> counts = options.counts;
    if (is_finite_family(family)) counts = {0};
    for (const std::size_t count : counts) {
      for (const std::size_t dimension : dimensions) {
        if (count != 0 && count <= dimension) continue;
        for (const std::uint64_t seed : options.seeds) {
          add(generated_input(family, dimension, count, seed));
          if (is_finite_family(family)) break;
        }
      }
    }
  }
  for (const std::string& path : options.files) add(file_input(path, options.unit_cube));
  return plan;
}

namespace {

void run_sweep(const SweepOptions& options) {
  const RunPlan plan = sweep_plan(options);
  const std::vector<RunRecord> records = measure_with(plan, options.measuring);
  fmt::print("{}\n{}", machine_line(describe_machine()), measurement_table("Sweep", records).as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

void add_sweep_command(CLI::App& app) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep", "families x dimensions x numbers of points x options, as JSON lines and CSV");
  const auto add_list = [&](const char* name, auto& values, const char* help) {
    command->add_option(name, values, help)->delimiter(',')->capture_default_str();
  };
  add_list("--families", options->families, "of `ndhull generate`; lattice and cube-corners are taken whole");
  add_list("--files", options->files, "files of points, beside the families");
  command->add_option("--dimensions", options->dimensions, "like 3-8 or 3,5,8")->capture_default_str();
  add_list("--points", options->counts, "numbers of points");
  command
      ->add_option("--options", options->option_sets,
                   "option sets parted by commas: exact, W0.1, W1% C0.5%, A0.95, width 5%, facets 500")
      ->capture_default_str();
  add_list("--engines", options->engines, engine_names());
  add_list("--seeds", options->seeds, "of the point sets");
  add_list("--threads", options->threads, "of ndhull; 0: all cores");
  command->add_option("--rounds", options->rounds, "runs of each measurement")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command->add_flag("--unit-cube", options->unit_cube, "widths after scaling the points to the unit cube");
  options->measuring.add_options(*command);
  command->footer(
      "Example: ndhull-bench sweep --families sphere,lens --dimensions 3-8 --points 200 --engines "
      "ndhull,qhull \\\n"
      "           --json sweep.jsonl --csv sweep.csv   # interrupted: the same again with --resume");
  command->callback([options] { run_sweep(*options); });
}

}  // namespace ndhull
