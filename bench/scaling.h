// What `ndhull-bench scaling` measures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/measure_options.h"
#include "bench/run_plan.h"

namespace ndhull {

struct ScalingOptions {
  std::vector<std::string> families{"sphere", "ball", "gaussian"};
  std::vector<std::string> engines{"ndhull"};
  std::vector<std::size_t> counts{250, 500, 1000, 2000, 4000};
  std::string dimensions = "4-6";
  std::size_t fixed_count = 100;
  std::string all_dimensions = "3-9";
  bool counts_only = false;  ///< of all_dimensions; the hulls themselves are measured elsewhere
  std::vector<unsigned> threads{0};
  std::vector<std::uint64_t> seeds{1, 2, 3};
  unsigned rounds = 1;
  MeasureOptions measuring;
};

/// Throws Error kUsage for a family or range that there is not.
RunPlan scaling_plan(const ScalingOptions& options);

}  // namespace ndhull
