// `ndhull-bench all`: one command from nothing to the report.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>

#include "bench/approximate.h"
#include "bench/commands.h"
#include "bench/halfspaces.h"
#include "bench/joggle.h"
#include "bench/machine.h"
#include "bench/peers.h"
#include "bench/rays.h"
#include "bench/report_page.h"
#include "bench/result_folder.h"
#include "bench/run_csv.h"
#include "bench/scaling.h"
#include "bench/selections.h"
#include "bench/sweep.h"
#include "core/error.h"

namespace ndhull {
namespace {

struct AllOptions {
  std::string folder;
  std::string dimensions = "3-10";
  std::size_t count = 80;
  std::vector<std::size_t> scaling_counts{250, 500, 1000, 2000};
  std::string scaling_dimensions = "4-6";
  std::uint64_t joggle_runs = 500;
  double max_seconds = 20.0;
  std::vector<std::string> parts;  // of kPartNames; empty: all
  bool resume = false;
};

/// The parts in their order; each writes the file of its name.
constexpr const char* kPartNames[] = {"sweep",      "scaling",    "peers", "approximate",
                                      "halfspaces", "selections", "rays",  "joggle"};

std::string path_in(const AllOptions& options, const std::string& name) {
  return (std::filesystem::path(options.folder) / name).string();
}

MeasureOptions measuring(const AllOptions& options, const std::string& part, double max_repeated_seconds) {
  MeasureOptions measuring;
  measuring.json_path = path_in(options, part + ".jsonl");
  measuring.resume = options.resume;
  measuring.max_seconds = options.max_seconds;
  measuring.max_repeated_seconds = max_repeated_seconds;
  measuring.warm_ups = 0;
  return measuring;
}

std::vector<RunRecord> run_sweep(const AllOptions& options) {
  SweepOptions sweep;
  sweep.dimensions = options.dimensions;
  sweep.counts = {options.count};
  sweep.option_sets = "exact,width 5%,width 20%,W5% C1%";
  sweep.engines = {"ndhull", "qhull"};
  sweep.rounds = 2;
  sweep.measuring = measuring(options, "sweep", 3.0);
  sweep.measuring.csv_path = path_in(options, "sweep.csv");
  return measure_with(sweep_plan(sweep), sweep.measuring);
}

std::vector<RunRecord> run_scaling(const AllOptions& options) {
  ScalingOptions scaling;
  scaling.engines = {"ndhull", "qhull"};
  scaling.counts = options.scaling_counts;
  scaling.dimensions = options.scaling_dimensions;
  scaling.fixed_count = options.count;
  scaling.all_dimensions = options.dimensions;
  scaling.counts_only = true;  // sweep has the hulls
  scaling.seeds = {1};
  scaling.measuring = measuring(options, "scaling", 3.0);
  return measure_with(scaling_plan(scaling), scaling.measuring);
}

std::vector<RunRecord> run_peers(const AllOptions& options) {
  PeersOptions peers;
  peers.selection.data_folder = NDHULL_BENCH_DATA;
  peers.selection.only = "s D";  // the sphere sets, that the geometric mean is over
  peers.measuring = measuring(options, "peers", 20.0);
  return measure_with(peers_plan(peers), peers.measuring);
}

std::vector<RunRecord> run_approximate(const AllOptions& options) {
  ApproximateOptions approximate;
  approximate.selection.data_folder = NDHULL_BENCH_DATA;
  approximate.skip_huge = true;
  approximate.rounds = 1;
  approximate.max_seconds = std::max(120.0, options.max_seconds);  // Qhull takes up to a minute
  approximate.json_path = path_in(options, "approximate.jsonl");
  approximate.resume = options.resume;
  return measure_approximate(approximate);
}

std::vector<RunRecord> run_halfspaces(const AllOptions& options) {
  HalfspacesOptions halfspaces;
  halfspaces.rounds = 3;
  halfspaces.measuring = measuring(options, "halfspaces", 12.0);
  halfspaces.measuring.max_seconds = std::max(60.0, options.max_seconds);
  return measure_with(halfspaces_plan(halfspaces), halfspaces.measuring);
}

std::vector<RunRecord> run_selections(const AllOptions& options) {
  SelectionsOptions selections;
  selections.measuring = measuring(options, "selections", 3.0);
  return measure_with(selections_plan(selections), selections.measuring);
}

std::vector<RunRecord> run_rays(const AllOptions& options) {
  RaysOptions rays;
  rays.selection.data_folder = NDHULL_BENCH_DATA;
  rays.selection.only = "s D";
  rays.seeds = 3;
  rays.measuring = measuring(options, "rays", 3.0);
  return measure_with(rays_plan(rays), rays.measuring);
}

std::vector<RunRecord> run_joggle(const AllOptions& options) {
  JoggleBenchOptions joggle;
  joggle.runs = options.joggle_runs;
  joggle.measuring = measuring(options, "joggle", 3.0);
  return measure_with(joggle_plan(joggle), joggle.measuring);
}

using Part = std::function<std::vector<RunRecord>(const AllOptions&)>;

void run_all(const AllOptions& options) {
  const Part parts[] = {run_sweep,      run_scaling,    run_peers, run_approximate,
                        run_halfspaces, run_selections, run_rays,  run_joggle};
  const Stopwatch watch;
  std::filesystem::create_directories(options.folder);
  fmt::print("{}\n", machine_line(describe_machine()));
  std::vector<RunRecord> measured;
  for (std::size_t part = 0; part < std::size(parts); ++part) {
    const std::string name = kPartNames[part];
    const bool is_wanted = options.parts.empty() ||
                           std::find(options.parts.begin(), options.parts.end(), name) != options.parts.end();
    if (!is_wanted) continue;
    fmt::print("part {} of {}, {}, after {:.0f} s\n", part + 1, std::size(parts), name, watch.wall_seconds());
    std::fflush(stdout);
    for (RunRecord& record : parts[part](options)) measured.push_back(std::move(record));
  }
  const std::vector<RunRecord> records = read_result_folder(options.folder);
  write_report_page(records, path_in(options, "report.md"), true);
  write_report_page(records, path_in(options, "report.html"), false);
  fmt::print("{} after {:.0f} s\n", path_in(options, "report.html"), watch.wall_seconds());
  throw_if_ndhull_failed(measured);
}

}  // namespace

void add_all_command(CLI::App& app) {
  const auto options = std::make_shared<AllOptions>();
  CLI::App* command =
      app.add_subcommand("all", "every part, and the report of them: under 20 minutes on 2 cores");
  command->add_option("-o,--output", options->folder, "folder of the results and of the report")->required();
  command->add_option("--dimensions", options->dimensions, "of sweep and of the expected facets, like 3-10")
      ->capture_default_str();
  command->add_option("--points", options->count, "in each dimension")->capture_default_str();
  command
      ->add_option("--scaling-points", options->scaling_counts, "numbers of points that growth is fitted to")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--scaling-dimensions", options->scaling_dimensions, "of these sets")
      ->capture_default_str();
  command->add_option("--joggle-runs", options->joggle_runs, "joggles of each size")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--max-seconds", options->max_seconds,
                   "stop a run after this wall clock; `approximate` and `halfspaces` have one of their own")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option(
          "--parts", options->parts,
          "measure these, and report on all that the folder has: sweep, scaling, peers, approximate, "
          "halfspaces, selections, rays, joggle")
      ->delimiter(',')
      ->check(CLI::IsMember(std::set<std::string>(std::begin(kPartNames), std::end(kPartNames))));
  command->add_flag("--resume", options->resume, "keep what the folder has, and measure the rest");
  command->footer("Example: ndhull-bench all -o results   # then open results/report.html");
  command->callback([options] { run_all(*options); });
}

}  // namespace ndhull
