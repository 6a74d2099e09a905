// What `ndhull-bench sweep` measures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/measure_options.h"
#include "bench/run_plan.h"

namespace ndhull {

struct SweepOptions {
  std::vector<std::string> families{"sphere", "ball", "gaussian", "cube"};
  std::vector<std::string> files;
  std::string dimensions = "3-8";
  std::vector<std::size_t> counts{100, 1000};
  std::string option_sets = "exact,width 5%";
  std::vector<std::string> engines{"ndhull"};
  std::vector<std::uint64_t> seeds{1};
  std::vector<unsigned> threads{1};
  unsigned rounds = 3;
  bool unit_cube = false;
  MeasureOptions measuring;
};

/// All of them with all of them. Throws Error kUsage for a family, range or option set that there is not;
/// what read_points throws.
RunPlan sweep_plan(const SweepOptions& options);

}  // namespace ndhull
