// `ndhull-bench rays`: the largest facets by rays beside the whole hull; extreme points; sets whose hulls
// nobody builds. Times are of the calls of the library, all cores.
#include "bench/rays.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include "approx/hull.h"
#include "approx/rays/extreme_points.h"
#include "approx/rays/largest_facets.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/sample.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

constexpr const char* kRaysCommand = "rays";
constexpr const char* kCompareTask = "largest beside the hull";
constexpr const char* kBigTask = "without a hull";

/// Facets from which a hull of the list is worth sampling. Fewer are all found.
constexpr std::size_t kManyFacets = 10000;

/// The whole hull, then rays; the recall is counted by areas.
HullRun compare(const BenchInput& input, std::size_t count, std::uint64_t seed) {
  const PointView points = input.points.view();
  HullRun run;
  const Stopwatch hull_watch;
  std::vector<double> areas;
  {
    const Hull hull = convex_hull(points);
    areas.resize(hull.facet_count());
    for (std::uint32_t id = 0; id < areas.size(); ++id) areas[id] = hull.area_of(FacetId{id});
  }
  const double hull_seconds = hull_watch.wall_seconds();
  run.facets = areas.size();
  run.detail = {{"hull_seconds", hull_seconds}};
  if (areas.size() < kManyFacets) return run;
  std::sort(areas.begin(), areas.end(), std::greater<>());
  const Stopwatch watch;
  const LargestFacets found =
      largest_facets(points, {.count = count, .method = LargestMethod::kRays, .seed = seed});
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  // Areas of the two methods differ by rounding.
  const double least = areas[std::min(count, areas.size()) - 1] * (1.0 - 1e-9);
  const auto right = std::count_if(found.facets.begin(), found.facets.end(),
                                   [least](const LargestFacet& facet) { return facet.area >= least; });
  run.detail["recall"] = static_cast<double>(right) / static_cast<double>(count);
  run.detail["estimate"] = found.sample.recall.value_or(0.0);
  return run;
}

/// A set that is too big to build, and how many of its largest facets are looked for.
HullRun search(const BenchInput& input) {
  constexpr std::size_t kCount = 100;
  HullRun run;
  const Stopwatch watch;
  const LargestFacets found = largest_facets(input.points.view(), {.count = kCount});
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.peak_bytes = peak_resident_bytes();
  run.facets = found.facets.size();
  run.detail = {{"result", fmt::format("areas {} to {}, {} rays, {}", short_number(found.facets.front().area),
                                       short_number(found.facets.back().area), found.sample.rays,
                                       to_string(found.status))}};
  return run;
}

HullRun find_vertices(const BenchInput& input) {
  HullRun run;
  const Stopwatch watch;
  const ExtremePoints found = extreme_points(input.points.view());
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.peak_bytes = peak_resident_bytes();
  run.vertices = found.vertices.size();
  run.detail = {{"result", grouped_number(run.vertices) + " vertices"}};
  return run;
}

struct BigSet {
  std::size_t count, dimension;
  const char* options;
  HullRun (*work)(const BenchInput&);
};
constexpr BigSet kBigSets[] = {{100'000, 12, "largest 100", search},
                               {100'000, 20, "largest 100", search},
                               {1'000'000, 16, "largest 100", search},
                               {100'000, 10, "extreme", find_vertices},
                               {10'000, 100, "extreme", find_vertices}};

void add_run(const char* task, const std::string& text, std::function<HullRun(const BenchInput&)> work,
             RunPlan& plan) {
  plan.runs.push_back({.input = plan.inputs.size() - 1,
                       .command = kRaysCommand,
                       .task = task,
                       .engine = "ndhull",
                       .options = {.text = text, .accuracy = {}},
                       .threads = available_threads(),
                       .work = std::move(work)});
}

/// All seeds of one input.
struct RaySample {
  std::string input;
  std::uint64_t facets = 0;
  std::vector<double> hull_seconds, ray_seconds, recalls, estimates;
};

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

Table compare_table(const std::vector<RunRecord>& records) {
  std::vector<RaySample> samples;
  for (const RunRecord& record : records) {
    const bool is_ours = record.command == kRaysCommand && record.task == kCompareTask && record.is_done();
    if (!is_ours || !record.run.detail.contains("recall")) continue;
    if (samples.empty() || samples.back().input != record.key.input)
      samples.emplace_back().input = record.key.input;
    RaySample& sample = samples.back();
    sample.facets = record.run.facets;
    sample.hull_seconds.push_back(record.run.detail.at("hull_seconds").get<double>());
    sample.ray_seconds.push_back(record.run.wall_seconds);
    sample.recalls.push_back(record.run.detail.at("recall").get<double>());
    sample.estimates.push_back(record.run.detail.at("estimate").get<double>());
  }
  Table table{.title = "The largest facets by rays",
              .note =
                  "All cores. Seconds: medians over the seeds. Recall: the part of the largest facets of the "
                  "whole hull that rays found, and rays' own estimate of it, means over the seeds.",
              .columns = {"input", "facets", "seeds", "hull s", "rays s", "recall", "estimate"},
              .rows = {}};
  for (const RaySample& sample : samples) {
    table.rows.push_back(
        {sample.input, grouped_number(sample.facets), fmt::format("{}", sample.recalls.size()),
         short_number(median(sample.hull_seconds)), short_number(median(sample.ray_seconds)),
         fmt::format("{:.2f}", mean(sample.recalls)), fmt::format("{:.2f}", mean(sample.estimates))});
  }
  return table;
}

Table big_table(const std::vector<RunRecord>& records) {
  Table table{.title = "Sets whose hull nobody builds",
              .note = "All cores. MiB: peak of the process with the points.",
              .columns = {"input", "asked for", "result", "seconds", "MiB"},
              .rows = {},
              .left_columns = 3};
  for (const RunRecord& record : records) {
    if (record.command != kRaysCommand || record.task != kBigTask) continue;
    std::vector<std::string> row{record.key.input, record.key.options, record.reason, "-", "-"};
    if (record.is_done()) {
      row[2] = record.run.detail.at("result").get<std::string>();
      row[3] = short_number(record.run.wall_seconds);
      row[4] = fmt::format("{:.0f}", static_cast<double>(record.peak_bytes) / (1024.0 * 1024.0));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void run_rays(const RaysOptions& options) {
  if (options.selection.print_list()) return;
  const std::vector<RunRecord> records = measure_with(rays_plan(options), options.measuring);
  fmt::print("{}\n", machine_line(describe_machine()));
  for (const Table& table : rays_tables(records)) fmt::print("\n{}", table.as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

RunPlan rays_plan(const RaysOptions& options) {
  RunPlan plan;
  for (const BenchCase& bench_case : options.selection.cases()) {
    plan.inputs.push_back(case_input(bench_case, options.selection.data_folder));
    for (unsigned seed = 1; seed <= options.seeds; ++seed) {
      add_run(
          kCompareTask, fmt::format("{} largest, seed {}", options.count, seed),
          [count = options.count, seed](const BenchInput& input) { return compare(input, count, seed); },
          plan);
    }
  }
  if (options.skip_big) return plan;
  for (const BigSet& set : kBigSets) {
    plan.inputs.push_back(generated_input("gaussian", set.dimension, set.count, 1));
    add_run(kBigTask, set.options, set.work, plan);
  }
  return plan;
}

std::vector<Table> rays_tables(const std::vector<RunRecord>& records) {
  std::vector<Table> tables{compare_table(records), big_table(records)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

void add_rays_command(CLI::App& app) {
  const auto options = std::make_shared<RaysOptions>();
  options->measuring.warm_ups = 0;
  options->measuring.max_seconds = 600.0;
  CLI::App* const command =
      app.add_subcommand("rays", "the largest facets without the hull: time and recall; extreme points");
  options->selection.add_options(*command);
  command->add_option("--seeds", options->seeds, "runs of each input")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--count", options->count, "facets looked for")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_flag("--skip-big", options->skip_big, "without the sets whose hull is not built");
  options->measuring.add_options(*command);
  command->footer("Example: ndhull-bench rays --only \"s D\" --seeds 3 --json rays.jsonl   # half a minute");
  command->callback([options] { run_rays(*options); });
}

}  // namespace ndhull
