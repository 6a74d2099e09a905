// `ndhull-bench all`: one command from nothing to the report.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "bench/approximate.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/report_page.h"
#include "bench/run_csv.h"
#include "bench/scaling.h"
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
  double max_seconds = 20.0;
  bool skip_approximate = false;
  bool resume = false;
};

std::string path_in(const AllOptions& options, const char* name) {
  return (std::filesystem::path(options.folder) / name).string();
}

MeasureOptions measuring(const AllOptions& options, const char* name) {
  MeasureOptions measuring;
  measuring.json_path = path_in(options, name);
  measuring.resume = options.resume;
  measuring.max_seconds = options.max_seconds;
  measuring.max_repeated_seconds = 3.0;
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
  sweep.measuring = measuring(options, "sweep.jsonl");
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
  scaling.measuring = measuring(options, "scaling.jsonl");
  return measure_with(scaling_plan(scaling), scaling.measuring);
}

void run_all(const AllOptions& options) {
  std::filesystem::create_directories(options.folder);
  fmt::print("{}\n", machine_line(describe_machine()));
  std::fflush(stdout);
  std::vector<RunRecord> records = run_sweep(options);
  const auto append = [&records](std::vector<RunRecord> more) {
    records.insert(records.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  append(run_scaling(options));
  if (!options.skip_approximate) {
    ApproximateOptions approximate;
    approximate.selection.data_folder = NDHULL_BENCH_DATA;
    approximate.skip_slow = true;
    approximate.rounds = 1;
    approximate.json_path = path_in(options, "approximate.jsonl");
    append(measure_approximate(approximate));
  }
  for (RunRecord& record : records) record.machine = describe_machine();
  write_report_page(records, path_in(options, "report.md"), true);
  write_report_page(records, path_in(options, "report.html"), false);
  fmt::print("{}\n", path_in(options, "report.html"));
  throw_if_ndhull_failed(records);
}

}  // namespace

void add_all_command(CLI::App& app) {
  const auto options = std::make_shared<AllOptions>();
  CLI::App* command = app.add_subcommand(
      "all", "sweep, scaling and approximate, and their report: under 20 minutes on 2 cores");
  command->add_option("-o,--output", options->folder, "folder of the results and of the report")->required();
  command->add_option("--dimensions", options->dimensions, "like 3-10")->capture_default_str();
  command->add_option("--points", options->count, "in each dimension")->capture_default_str();
  command
      ->add_option("--scaling-points", options->scaling_counts, "numbers of points that growth is fitted to")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--scaling-dimensions", options->scaling_dimensions, "of these sets")
      ->capture_default_str();
  command->add_option("--max-seconds", options->max_seconds, "stop a run after this wall clock")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--skip-approximate", options->skip_approximate, "leave out the inputs of `approximate`");
  command->add_flag("--resume", options->resume, "keep what the folder has of sweep and scaling");
  command->footer("Example: ndhull-bench all -o results   # then open results/report.html");
  command->callback([options] { run_all(*options); });
}

}  // namespace ndhull
