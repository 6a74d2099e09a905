// The inputs on which approximate hulls are compared, each with the options that both engines understand.
#pragma once

#include <string>
#include <vector>

#include "bench/bench_cases.h"
#include "bench/option_set.h"

namespace ndhull {

struct ApproximateCase {
  BenchCase input;
  OptionSet options;          ///< W and C, in the unit cube where the input has that
  bool is_huge = false;       ///< takes minutes
  bool is_hull_huge = false;  ///< the exact hull and narrow targets take minutes, these options do not
  std::string name() const { return input.name + ", " + options.text; }
};

/// All, in the order of the tables.
std::vector<ApproximateCase> all_approximate_cases();

}  // namespace ndhull
