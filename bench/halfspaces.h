// What `ndhull-bench halfspaces` measures: intersections of halfspaces by whole programs.
#pragma once

#include <string>
#include <vector>

#include "bench/measure_options.h"
#include "bench/run_plan.h"
#include "bench/table.h"

namespace ndhull {

struct HalfspacesOptions {
  std::string only;    ///< part of an input's name; empty: all
  std::string ndhull;  ///< path of the program; empty: the one beside ndhull-bench
  unsigned rounds = 5;
  MeasureOptions measuring;
};

/// `ndhull intersect` and Qhull's `qhalf`, in turns, on the same files: RunRecord::run has the vertices, and
/// the time, memory and processor time of the whole process.
/// Throws Error kUsage when no input is chosen.
RunPlan halfspaces_plan(const HalfspacesOptions& options);

/// Vertices and seconds of both, ratios with their spread; no rows without records of `halfspaces`.
Table halfspaces_table(const std::vector<RunRecord>& records);

}  // namespace ndhull
