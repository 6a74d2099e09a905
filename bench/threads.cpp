// `ndhull-bench threads`: one thread alone, several threads, and as many processes of one thread at the same
// time. What those processes lose to each other is what the cores share: cache, memory, clock. That is a
// yardstick and no bound: several threads have one hull in the cache, the processes one each.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/child_process.h"
#include "bench/commands.h"
#include "bench/hull_run.h"
#include "bench/machine.h"
#include "bench/measure_options.h"
#include "bench/sample.h"
#include "bench/table.h"
#include "core/error.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

struct ThreadsOptions {
  std::string only;
  unsigned rounds = 5;
  unsigned threads = 0;
  double max_seconds = 120.0;
};

struct ThreadsCase {
  std::string name;
  std::function<BenchInput()> load;
};

std::vector<ThreadsCase> threads_cases() {
  std::vector<ThreadsCase> cases;
  for (const char* name : {"300 s D8 t1", "1000 D8", "150 s D9 t1"})
    cases.push_back({name, [name] {
                       const BenchCase found = named_bench_input(name);
                       return found.load("");
                     }});
  cases.push_back(
      {"1,000,000 gaussian points in 6-d", [] {
         return BenchInput{
             generate_points({.family = PointFamily::kGaussian, .dimension = 6, .count = 1'000'000}), {}};
       }});
  return cases;
}

/// Seconds of each round.
struct Rounds {
  std::vector<double> alone, threads, together;
};

/// The mean of the processes' seconds. Throws EngineFailed when one of them did not end well.
double seconds_of(const BenchInput& input, unsigned threads, std::size_t processes, double max_seconds) {
  HullOptions options;
  options.threads = threads;
  double sum = 0.0;
  for (const ChildResult& result : run_in_children(
           [&] { return nlohmann::json(run_ndhull(input, options).wall_seconds); }, processes, max_seconds)) {
    if (!result.done()) {
      fmt::print(stderr, "ndhull-bench: ndhull: {}\n", result.reason);
      throw EngineFailed();
    }
    sum += result.values.get<double>();
  }
  return sum / static_cast<double>(processes);
}

Rounds measure(const BenchInput& input, const ThreadsOptions& options, unsigned threads) {
  Rounds rounds;
  for (unsigned round = 0; round < options.rounds; ++round) {
    rounds.alone.push_back(seconds_of(input, 1, 1, options.max_seconds));
    rounds.threads.push_back(seconds_of(input, threads, 1, options.max_seconds));
    rounds.together.push_back(seconds_of(input, 1, threads, options.max_seconds));
  }
  return rounds;
}

/// The ratio of the medians, and the smallest and the largest of one round.
std::string ratio_cell(const std::vector<double>& over, const std::vector<double>& under, double factor) {
  double low = HUGE_VAL, high = 0.0;
  for (std::size_t round = 0; round < over.size(); ++round) {
    const double ratio = factor * over[round] / under[round];
    low = std::min(low, ratio);
    high = std::max(high, ratio);
  }
  return fmt::format("{:.2f} ({:.2f} .. {:.2f})", factor * median(over) / median(under), low, high);
}

void run_threads(const ThreadsOptions& options) {
  const unsigned threads = options.threads == 0 ? available_threads() : options.threads;
  Table table{
      .title = "Several threads beside one",
      .note = fmt::format(
          "Seconds of exact hulls, medians of {} rounds in turns: one thread alone; {} threads; {} processes "
          "of "
          "one thread at the same time, each. `machine` is what these processes get done in the time of one "
          "alone: what the cores share costs them the rest; each has a hull of its own in the cache. In "
          "brackets single rounds.",
          options.rounds, threads, threads),
      .columns = {"input", "1 thread", fmt::format("{} threads", threads), "speed-up",
                  fmt::format("{} at once", threads), "machine"},
      .rows = {}};
  for (const ThreadsCase& one : threads_cases()) {
    if (one.name.find(options.only) == std::string::npos) continue;
    const BenchInput input = one.load();
    const Rounds rounds = measure(input, options, threads);
    table.rows.push_back(
        {one.name, fmt::format("{:.3f}", median(rounds.alone)), fmt::format("{:.3f}", median(rounds.threads)),
         ratio_cell(rounds.alone, rounds.threads, 1.0), fmt::format("{:.3f}", median(rounds.together)),
         ratio_cell(rounds.alone, rounds.together, threads)});
  }
  if (table.rows.empty()) {
    throw Error(ErrorCode::kUsage, fmt::format("no input has \"{}\" in its name", options.only));
  }
  fmt::print("{}\n{}", machine_line(describe_machine()), table.as_text());
}

}  // namespace

void add_threads_command(CLI::App& app) {
  const auto options = std::make_shared<ThreadsOptions>();
  CLI::App* command =
      app.add_subcommand("threads", "several threads beside one, and beside as many processes at once");
  command->add_option("--only", options->only, "only the inputs whose name contains this");
  command->add_option("--rounds", options->rounds, "runs of each")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "0: all cores")->capture_default_str();
  command->add_option("--max-seconds", options->max_seconds, "stop a run after this wall clock; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->footer("Example: ndhull-bench threads --only D8");
  command->callback([options] { run_threads(*options); });
}

}  // namespace ndhull
