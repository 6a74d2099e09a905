// `ndhull-bench scaling`: how time and memory grow with the points, the dimension, the facets and the
// threads.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/commands.h"
#include "bench/expected_facets.h"
#include "bench/machine.h"
#include "bench/measure_options.h"
#include "bench/run_plan.h"
#include "bench/scaling.h"
#include "bench/scaling_tables.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

/// Hulls of seeds 1, 2, ... until the mean's standard error is below 0.5 %, but no more than 2000 and no more
/// work than some seconds: the same number of seeds on every machine.
HullRun count_facets(GenerateOptions generate) {
  constexpr std::uint64_t kMostSeeds = 2000, kMostCreated = 6'000'000;
  // Of fewer counts the standard error itself is too uncertain to stop by.
  constexpr double kFewestSeeds = 30.0, kWantedError = 0.005;
  HullOptions options;
  options.threads = 1;
  HullRun run;
  const Stopwatch watch;
  double sum = 0.0, squares = 0.0, count = 0.0, mean = 0.0, error = 0.0;
  std::uint64_t created = 0;
  for (generate.seed = 1; generate.seed <= kMostSeeds; ++generate.seed) {
    const PointSet points = generate_points(generate);
    const Hull hull = convex_hull(points.view(), options);
    const auto facets = static_cast<double>(hull.facet_count());
    created += hull.statistics.created_simplices;
    sum += facets;
    squares += facets * facets;
    count += 1.0;
    mean = sum / count;
    if (count < 2.0) continue;
    error = std::sqrt(std::max(0.0, squares / count - mean * mean) / (count - 1.0));
    if (created > kMostCreated || (count >= kFewestSeeds && error < kWantedError * mean)) break;
  }
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.facets = static_cast<std::uint64_t>(std::llround(mean));
  run.detail = {
      {"seeds", static_cast<std::uint64_t>(count)},
      {"mean_facets", mean},
      {"standard_error", error},
      {"created_simplices", created},
      {"expected_facets", expected_facet_count(generate.family, generate.dimension, generate.count)}};
  return run;
}

/// The largest number of points, up to `most`, of which a hull is expected to have few enough facets to make
/// many: near the simplex in high dimensions.
std::size_t count_for_many_seeds(PointFamily family, std::size_t dimension, std::size_t most) {
  constexpr double kMostFacets = 20'000.0;
  std::size_t low = dimension + 1, high = most;
  while (low < high) {
    const std::size_t middle = low + (high - low + 1) / 2;
    if (expected_facet_count(family, dimension, middle) <= kMostFacets) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

class ScalingPlan {
 public:
  explicit ScalingPlan(const ScalingOptions& options) : options_(options) {
    for (const std::string& family : options.families) {
      for (const std::size_t dimension : parse_range(options.dimensions)) {
        for (const std::size_t count : options.counts) add(family, dimension, count);
      }
      for (const std::size_t dimension : parse_range(options.all_dimensions)) {
        if (!options.counts_only) add(family, dimension, options.fixed_count);
        add_counts(family, dimension, options.fixed_count);
      }
    }
  }
  RunPlan take() { return std::move(plan_); }

 private:
  // Hulls in one child, until their mean is known well.
  void add_counts(const std::string& family, std::size_t dimension, std::size_t most) {
    if (most <= dimension || !has_expected_facet_count(point_family(family))) return;
    const std::size_t count = count_for_many_seeds(point_family(family), dimension, most);
    plan_.inputs.push_back({.name = fmt::format("{} {}-d, {}, many seeds", family, dimension, count),
                            .points = {{"family", family}, {"dimension", dimension}, {"points", count}},
                            .load = [] { return BenchInput{}; }});
    PlannedRun run{.input = plan_.inputs.size() - 1,
                   .command = "scaling",
                   .task = kCountsTask,
                   .engine = "ndhull",
                   .options = parse_option_set("exact")};
    run.work = [family, dimension, count](const BenchInput&) {
      return count_facets({.family = point_family(family), .dimension = dimension, .count = count});
    };
    plan_.runs.push_back(std::move(run));
  }

  void add(const std::string& family, std::size_t dimension, std::size_t count) {
    if (count <= dimension) return;
    for (const std::uint64_t seed : options_.seeds) {
      plan_.inputs.push_back(generated_input(family, dimension, count, seed));
      for (const std::string& engine : options_.engines) add_run(engine, 1);
      // Threads are compared on the largest sets.
      const bool is_largest = count == options_.counts.back() && seed == options_.seeds.front();
      if (!is_largest) continue;
      for (const unsigned threads : options_.threads) {
        if (threads != 1) add_run("ndhull", threads == 0 ? available_threads() : threads);
      }
    }
  }

  void add_run(const std::string& engine, unsigned threads) {
    plan_.runs.push_back({.input = plan_.inputs.size() - 1,
                          .command = "scaling",
                          .task = {},
                          .engine = engine,
                          .options = parse_option_set("exact"),
                          .threads = threads,
                          .rounds = options_.rounds});
  }

  const ScalingOptions& options_;
  RunPlan plan_;
};

}  // namespace

RunPlan scaling_plan(const ScalingOptions& options) { return ScalingPlan(options).take(); }

namespace {

void run_scaling(const ScalingOptions& options) {
  const std::vector<RunRecord> records = measure_with(scaling_plan(options), options.measuring);
  fmt::print("{}\n", machine_line(describe_machine()));
  for (const Table& table : scaling_tables(records)) fmt::print("\n{}", table.as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

void add_scaling_command(CLI::App& app) {
  const auto options = std::make_shared<ScalingOptions>();
  CLI::App* command = app.add_subcommand(
      "scaling", "how time and memory grow, fitted, beside the expected numbers of facets");
  const auto add_list = [&](const char* name, auto& values, const char* help) {
    command->add_option(name, values, help)->delimiter(',')->capture_default_str();
  };
  add_list("--families", options->families,
           "of `ndhull generate`; sphere, ball and gaussian have expected counts");
  add_list("--points", options->counts, "numbers of points, ascending, at each of --dimensions");
  command->add_option("--dimensions", options->dimensions, "for --points, like 4-6")->capture_default_str();
  command->add_option("--fixed-points", options->fixed_count, "number of points for --all-dimensions")
      ->capture_default_str();
  command->add_option("--all-dimensions", options->all_dimensions, "for --fixed-points")
      ->capture_default_str();
  add_list("--engines", options->engines, "ndhull, qhull");
  add_list("--seeds", options->seeds, "of the point sets; counts and times are means over them");
  add_list("--threads", options->threads, "tried on the largest sets beside one; 0: all cores");
  command->add_option("--rounds", options->rounds, "runs of each")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  options->measuring.add_options(*command);
  command->footer(
      "Example: ndhull-bench scaling --families sphere --engines ndhull,qhull --json scaling.jsonl");
  command->callback([options] { run_scaling(*options); });
}

}  // namespace ndhull
