// `ndhull-bench peers`. Each run is a child process; the engines take turns, and who starts changes with the
// round, so that a machine that warms up or throttles favours neither.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/child_process.h"
#include "bench/commands.h"
#include "bench/hull_run.h"
#include "bench/machine.h"
#include "bench/run_record.h"
#include "bench/sample.h"
#include "core/error.h"

namespace ndhull {
namespace {

struct PeersOptions {
  CaseSelection selection;
  std::string json_path;
  unsigned rounds = 3;
  double max_seconds = 600.0;
  bool skip_slow = false;
};

/// The runs of one engine on one input.
struct Runs {
  std::vector<HullRun> done;
  std::uint64_t peak_bytes = 0;  ///< largest of all runs
  std::string failure;           ///< of the first run that was not done; empty: none
  bool crashed = false;          ///< the failure is not the time limit

  double median_seconds() const {
    std::vector<double> seconds;
    for (const HullRun& run : done) seconds.push_back(run.wall_seconds);
    return median(seconds);
  }
};

/// One input, all rounds.
struct Comparison {
  const BenchCase* bench_case = nullptr;
  std::size_t points = 0, dimension = 0;
  Runs ndhull, qhull;
  std::vector<double> round_ratios;  ///< [ratio] Qhull's seconds over ndhull's, rounds where both were done

  bool is_complete() const { return !ndhull.done.empty() && !qhull.done.empty(); }
  double time_ratio() const { return qhull.median_seconds() / ndhull.median_seconds(); }
  double memory_ratio() const {
    return static_cast<double>(qhull.peak_bytes) / static_cast<double>(ndhull.peak_bytes);
  }
};

nlohmann::json to_record(const ChildResult& result) {
  nlohmann::json record = result.done() ? result.values : nlohmann::json{{"reason", result.reason}};
  record["end"] = end_name(result.end);
  record["peak_bytes"] = result.peak_bytes;
  return record;
}

void add_run(const ChildResult& result, Runs& runs) {
  if (result.done()) {
    runs.done.push_back(result.values.get<HullRun>());
    runs.peak_bytes = std::max(runs.peak_bytes, result.peak_bytes);
  } else {
    runs.failure = result.reason;
    runs.crashed = result.end != ChildResult::End::kTimeLimit;
  }
}

bool is_worth_another_run(const Runs& runs) {
  return runs.failure.empty() &&
         (runs.done.empty() || runs.done.back().wall_seconds <= BenchCase::kSlowSeconds);
}

// Runs what is due in this round; returns the JSON line.
nlohmann::json run_round(unsigned round, const BenchInput& input, const PeersOptions& options,
                         Comparison& comparison) {
  const BenchCase& bench_case = *comparison.bench_case;
  const bool skip_qhull = bench_case.is_slow_for_qhull() && (options.skip_slow || round > 0);
  const bool due_ndhull = is_worth_another_run(comparison.ndhull);
  const bool due_qhull = !skip_qhull && is_worth_another_run(comparison.qhull);
  nlohmann::json line = {{"input", bench_case.name},
                         {"round", round},
                         {"points", comparison.points},
                         {"dimension", comparison.dimension}};
  HullOptions hull_options;
  hull_options.unit_cube = bench_case.unit_cube;
  hull_options.threads = 1;
  std::optional<ChildResult> ndhull, qhull;
  for (const bool turn_of_qhull : {round % 2 == 1, round % 2 == 0}) {
    if (turn_of_qhull && due_qhull) {
      qhull =
          run_in_child([&] { return nlohmann::json(run_qhull(input, bench_case.unit_cube ? "QbB" : "")); },
                       options.max_seconds);
      add_run(*qhull, comparison.qhull);
      line["qhull"] = to_record(*qhull);
    } else if (!turn_of_qhull && due_ndhull) {
      ndhull =
          run_in_child([&] { return nlohmann::json(run_ndhull(input, hull_options)); }, options.max_seconds);
      add_run(*ndhull, comparison.ndhull);
      line["ndhull"] = to_record(*ndhull);
    }
  }
  if (ndhull && qhull && ndhull->done() && qhull->done()) {
    const double ratio =
        comparison.qhull.done.back().wall_seconds / comparison.ndhull.done.back().wall_seconds;
    comparison.round_ratios.push_back(ratio);
    line["time_ratio"] = ratio;
    line["memory_ratio"] = static_cast<double>(qhull->peak_bytes) / static_cast<double>(ndhull->peak_bytes);
  }
  return line;
}

std::string columns_of(const Runs& runs) {
  if (runs.done.empty()) return fmt::format("{:>9} {:>8} {:>9} {:>8}", "-", "-", "-", "-");
  const HullRun& last = runs.done.back();
  return fmt::format("{:>9} {:>8.1e} {:>9.4f} {:>8.1f}", last.facets, last.max_facet_width,
                     runs.median_seconds(), static_cast<double>(runs.peak_bytes) / (1024.0 * 1024.0));
}

void print_header() {
  fmt::print("{:<20} {:>6} {:>3} | {:^37} | {:^37} | {}\n", "", "", "", "ndhull, 1 thread", "Qhull",
             "Qhull / ndhull");
  const std::string columns = fmt::format("{:>9} {:>8} {:>9} {:>8}", "facets", "width", "seconds", "MiB");
  fmt::print("{:<20} {:>6} {:>3} | {} | {} | {:>7} {:>17} {:>7}\n", "input", "n", "d", columns, columns,
             "time", "(min .. max)", "memory");
}

void print_row(const Comparison& comparison, bool skipped_qhull) {
  fmt::print("{:<20} {:>6} {:>3} | {} | {} |", comparison.bench_case->name, comparison.points,
             comparison.dimension, columns_of(comparison.ndhull), columns_of(comparison.qhull));
  if (comparison.is_complete()) {
    const auto [low, high] =
        std::minmax_element(comparison.round_ratios.begin(), comparison.round_ratios.end());
    const std::string spread =
        comparison.round_ratios.size() < 2 ? "" : fmt::format("({:.2f} .. {:.2f})", *low, *high);
    fmt::print(" {:>7.2f} {:>17} {:>7.2f}", comparison.time_ratio(), spread, comparison.memory_ratio());
  }
  if (skipped_qhull) fmt::print(" Qhull left out");
  if (!comparison.ndhull.failure.empty()) fmt::print(" ndhull: {}", comparison.ndhull.failure);
  if (!comparison.qhull.failure.empty()) fmt::print(" Qhull: {}", comparison.qhull.failure);
  fmt::print("\n");
  std::fflush(stdout);
}

void print_sphere_means(const std::vector<Comparison>& comparisons) {
  std::vector<double> time_ratios, memory_ratios;
  for (const Comparison& comparison : comparisons) {
    if (!comparison.bench_case->is_sphere_set || !comparison.is_complete()) continue;
    time_ratios.push_back(comparison.time_ratio());
    memory_ratios.push_back(comparison.memory_ratio());
  }
  if (time_ratios.empty()) return;
  fmt::print("geometric mean over {} sphere sets (of 6): time {:.2f}, memory {:.2f}\n", time_ratios.size(),
             geometric_mean(time_ratios), geometric_mean(memory_ratios));
}

void run_peers(const PeersOptions& options) {
  if (options.selection.print_list()) return;
  const std::vector<BenchCase> cases = options.selection.cases();
  std::ofstream json_file;
  if (!options.json_path.empty()) json_file.open(options.json_path);
  const nlohmann::json machine = describe_machine();
  fmt::print("{}\n", machine_line(machine));
  fmt::print("medians of {} rounds, one run of Qhull where it takes over {} s\n", options.rounds,
             BenchCase::kSlowSeconds);
  fmt::print(
      "width: of the widest facet, outer minus inner plane; MiB: peak of the process with the points\n");
  print_header();

  std::vector<Comparison> comparisons;
  for (const BenchCase& bench_case : cases) {
    const BenchInput input = bench_case.load(options.selection.data_folder);
    Comparison& comparison = comparisons.emplace_back();
    comparison.bench_case = &bench_case;
    comparison.points = input.points.rows();
    comparison.dimension = input.points.dimension;
    for (unsigned round = 0; round < options.rounds; ++round) {
      nlohmann::json line = run_round(round, input, options, comparison);
      line["machine"] = machine;
      // At once: what was measured stays when a long bench is interrupted.
      if (!options.json_path.empty() && !(json_file << line.dump() << std::endl)) {
        throw Error(ErrorCode::kFileWrite, options.json_path + ": cannot be written");
      }
    }
    print_row(comparison, options.skip_slow && bench_case.is_slow_for_qhull());
  }
  print_sphere_means(comparisons);
  const auto has_crash = [](const Comparison& comparison) { return comparison.ndhull.crashed; };
  if (std::any_of(comparisons.begin(), comparisons.end(), has_crash)) throw EngineFailed();
}

}  // namespace

void add_peers_command(CLI::App& app) {
  const auto options = std::make_shared<PeersOptions>();
  CLI::App* command = app.add_subcommand("peers", "time and memory of ndhull and Qhull, side by side");
  options->selection.add_options(*command);
  command->add_option("--rounds", options->rounds, "runs of each engine on each input; slow ones have one")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  command->add_option("--max-seconds", options->max_seconds, "stop a run after this wall clock; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag(
      "--skip-slow", options->skip_slow,
      fmt::format("leave out Qhull where it is known to take more than {} s", BenchCase::kSlowSeconds));
  command->add_option("--json", options->json_path, "one line of JSON for each pair of runs");
  command->footer("Example: ndhull-bench peers --only \"D8 t1\" --rounds 5 --json peers.jsonl");
  command->callback([options] { run_peers(*options); });
}

}  // namespace ndhull
