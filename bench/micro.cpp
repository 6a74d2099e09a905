// `ndhull-bench micro`: the phases of small hulls by Google Benchmark, which repeats them until their times
// are steady.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "approx/hull.h"
#include "bench/commands.h"
#include "bench/option_set.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

struct MicroOptions {
  std::string filter = ".";
  double min_seconds = 0.5;
};

struct MicroCase {
  std::size_t dimension, count;
  const char* options;
};
constexpr MicroCase kMicroCases[] = {
    {3, 1000, "exact"}, {5, 500, "exact"}, {8, 60, "exact"}, {5, 500, "width 10%"}, {5, 500, "W5% C0.5%"},
};

HullOptions hull_options(const MicroCase& micro) {
  HullOptions options;
  options.accuracy = parse_option_set(micro.options).accuracy;
  options.threads = 1;
  return options;
}

// Time: of the whole call. The phases are counters, in microseconds: timed each for itself, the short ones
// would be repeated for minutes.
void measure_hull(benchmark::State& state, const MicroCase& micro) {
  const PointSet points = generate_points({.dimension = micro.dimension, .count = micro.count});
  const HullOptions options = hull_options(micro);
  std::size_t facets = 0;
  for (auto _ : state) {
    const Hull hull = convex_hull(points.view(), options);
    for (std::size_t phase = 0; phase < hull.statistics.seconds.size(); ++phase) {
      state.counters[std::string(to_string(static_cast<Phase>(phase)))] +=
          1e6 * hull.statistics.seconds[phase];
    }
    facets = hull.facet_count();
  }
  for (auto& [phase, counter] : state.counters) counter.flags = benchmark::Counter::kAvgIterations;
  state.counters["facets"] = static_cast<double>(facets);
}

void run_micro(const MicroOptions& options) {
  for (const MicroCase& micro : kMicroCases) {
    const std::string name = fmt::format("sphere {}-d, {}, {}", micro.dimension, micro.count, micro.options);
    benchmark::RegisterBenchmark(name.c_str(), [micro](benchmark::State& state) {
      measure_hull(state, micro);
    })->Unit(benchmark::kMicrosecond);
  }
  // Its options come as words of a command line.
  std::vector<std::string> words{"ndhull-bench", "--benchmark_filter=" + options.filter,
                                 fmt::format("--benchmark_min_time={}", options.min_seconds)};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  auto count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}

}  // namespace

void add_micro_command(CLI::App& app) {
  const auto options = std::make_shared<MicroOptions>();
  CLI::App* command = app.add_subcommand("micro", "the phases of small hulls, by Google Benchmark");
  command->add_option("--filter", options->filter, "regular expression of the names")->capture_default_str();
  command->add_option("--min-seconds", options->min_seconds, "of each")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->footer("Example: ndhull-bench micro --filter 5-d");
  command->callback([options] { run_micro(*options); });
}

}  // namespace ndhull
