// What `ndhull-bench rays` measures: the largest facets without the hull.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/measure_options.h"
#include "bench/run_plan.h"
#include "bench/table.h"

namespace ndhull {

struct RaysOptions {
  CaseSelection selection;
  unsigned seeds = 10;
  std::size_t count = 20;
  bool skip_big = false;
  MeasureOptions measuring;
};

/// Of each input the whole hull and the largest facets by rays, a run for each seed; then sets whose hull
/// nobody builds, and extreme points. All cores.
/// Throws Error kUsage when no input is chosen.
RunPlan rays_plan(const RaysOptions& options);

/// One table for each of the two; none without records of `rays`.
std::vector<Table> rays_tables(const std::vector<RunRecord>& records);

}  // namespace ndhull
