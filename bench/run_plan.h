// What is to be measured, in order, and measuring it: shared by the commands that make many runs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/option_set.h"
#include "bench/run_record.h"

namespace ndhull {

/// Points by name; loaded when their first run is due, dropped after their last.
struct PlannedInput {
  std::string name;
  nlohmann::json
      points;  ///< RunRecord::points: points and dimension, with family and seed where they have them
  bool unit_cube = false;
  std::function<BenchInput()> load;
};

/// One run, and how often it is repeated.
struct PlannedRun {
  std::size_t input = 0;   ///< index into RunPlan::inputs
  std::string command;     ///< RunRecord::command
  std::string task;        ///< RunRecord::task
  std::string group = {};  ///< RunRecord::group
  std::string engine;      ///< of engine_names
  OptionSet options;
  unsigned threads = 1;
  unsigned rounds = 1;
  /// In place of a hull by the engine; empty: none. Runs in a child.
  std::function<HullRun(const BenchInput&)> work = {};
};

/// Runs of one input stand together; they take turns, and the order turns around with each round.
struct RunPlan {
  std::vector<PlannedInput> inputs;
  std::vector<PlannedRun> runs;
};

struct RunLimits {
  double max_seconds = 60.0;           ///< wall clock of one run; 0: none
  std::uint64_t max_memory_bytes = 0;  ///< ndhull's tables, Qhull's address space; 0: none
  double max_repeated_seconds = 10.0;  ///< a run that takes longer is not repeated
  unsigned warm_ups = 0;               ///< runs of each, before its first, that are not recorded
  bool show_progress = true;           ///< lines on standard error
};

/// Measures what `earlier` does not have, in child processes, and writes each run to `file` at once.
///
/// Returns   the records of the plan, those of `earlier` first; runs of other plans are left out.
/// Limits    a run beyond a limit is a record that says so. Larger sets of the same family (no fewer points,
///           no fewer dimensions) are then not tried: their end is "skipped", with the reason.
/// Throws    Error kUsage when the plan names an engine that there is not; what RecordFile::write throws.
/// Progress  one line a run: its number, what it is, what came out, an estimate of the seconds left from what
///           similar runs took.
std::vector<RunRecord> measure(const RunPlan& plan, const RunLimits& limits,
                               const std::vector<RunRecord>& earlier, RecordFile& file);

/// What an engine may be called: "ndhull, qhull, cgal, lrs".
const char* engine_names();

/// Input `family` of the list of `ndhull generate`, with `count` points; families with a whole of their own
/// (cube-corners, lattice, cross-polytope) are taken whole where `count` is 0. Name: "sphere 5-d, 1000, seed
/// 1".
PlannedInput generated_input(const std::string& family, std::size_t dimension, std::size_t count,
                             std::uint64_t seed);
/// An input of the list of exact hulls.
PlannedInput case_input(const BenchCase& bench_case, const std::string& data_folder);
/// Input from a file of points. Throws as read_points.
PlannedInput file_input(const std::string& path, bool unit_cube);

}  // namespace ndhull
