#include "bench/approximate_cases.h"

namespace ndhull {

std::vector<ApproximateCase> all_approximate_cases() {
  struct Line {
    const char* input;
    const char* options;
    double qhull_seconds;
    bool is_huge = false, is_hull_huge = false;
  };
  static constexpr Line kLines[] = {
      {"2000 s D5 t1", "W0.1 C0.01", 0.3},          {"1000 s D6 t1", "W0.1 C0.01", 1.3},
      {"500 s D7 t1", "W0.1 C0.01", 10.0},          {"300 s D8 t1", "W0.1 C0.01", 55.0},
      {"300 s D8 t1", "W0.05 C0.05", 62.0},         {"100000 s D6 t1", "W0.2", 24.0, false, true},
      {"100000 s D8 t1", "W0.3", 67.0, true, true}, {"diamonds, unit cube", "W0.01 C0.01", 51.7},
      {"abalone, unit cube", "W0.02 C0.02", 61.7},
  };
  std::vector<ApproximateCase> cases;
  for (const Line& line : kLines) {
    ApproximateCase approximate;
    approximate.input = named_bench_input(line.input);
    approximate.options = parse_option_set(line.options);
    approximate.input.qhull_seconds = line.qhull_seconds;
    approximate.is_huge = line.is_huge;
    approximate.is_hull_huge = line.is_hull_huge;
    cases.push_back(std::move(approximate));
  }
  return cases;
}

}  // namespace ndhull
