// What `ndhull-bench approximate` measures.
#pragma once

#include <string>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/run_record.h"

namespace ndhull {

struct ApproximateOptions {
  CaseSelection selection;
  std::string json_path;
  std::string qhull_from;
  std::string widths = "1%,2%,5%,10%,20%";
  std::string max_memory = "4G";
  unsigned rounds = 3;
  unsigned target_rounds = 9;  ///< of exact hulls and those of `widths`, some tenths of a second each
  double max_seconds = 600.0;
  bool skip_qhull = false;
  bool skip_slow = false;
  bool skip_targets = false;
  bool skip_huge = false;  ///< of 100,000 points: without exact hulls and targets, and none in 8-d
  bool resume = false;     ///< keep what json_path has
};

/// Measures the chosen inputs, with a line on standard output for each run. Throws Error kUsage when no input
/// is chosen; what RecordFile and read_records throw.
std::vector<RunRecord> measure_approximate(const ApproximateOptions& options);

}  // namespace ndhull
