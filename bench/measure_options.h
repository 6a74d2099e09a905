// The options and the steps that commands of many runs share: limits, files, going on where a run was
// interrupted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/run_plan.h"
#include "bench/table.h"

namespace CLI {
class App;
}

namespace ndhull {

struct MeasureOptions {
  std::string json_path, csv_path;
  bool resume = false;
  double max_seconds = 60.0;
  std::string max_memory = "4G";
  double max_repeated_seconds = 10.0;  ///< RunLimits'
  unsigned warm_ups = 1;
  bool quiet = false;

  void add_options(CLI::App& command);
};

/// Measures the plan under the options and writes their files. Throws Error kUsage for --resume without
/// --json; what `measure`, `read_records` and `write_csv` throw.
std::vector<RunRecord> measure_with(const RunPlan& plan, const MeasureOptions& options);

/// One row for each measurement: facets, width, seconds with their spread, memory.
Table measurement_table(const std::string& title, const std::vector<RunRecord>& records);

/// Throws EngineFailed when ndhull ended with an error or a signal.
void throw_if_ndhull_failed(const std::vector<RunRecord>& records);

/// Cores that this process may use, at least 1.
unsigned available_threads();

/// "3-8" or "3,5,7-9": the numbers. Throws Error kUsage.
std::vector<std::size_t> parse_range(const std::string& text);

}  // namespace ndhull
