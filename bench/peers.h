// What `ndhull-bench peers` measures: exact hulls by several engines.
#pragma once

#include <string>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/measure_options.h"
#include "bench/run_plan.h"

namespace ndhull {

struct PeersOptions {
  CaseSelection selection;
  std::vector<std::string> engines{"ndhull", "qhull"};
  unsigned rounds = 3;
  bool skip_slow = false;
  MeasureOptions measuring;
};

/// The chosen inputs by all engines, one thread. Throws Error kUsage when no input is chosen.
RunPlan peers_plan(const PeersOptions& options);

}  // namespace ndhull
