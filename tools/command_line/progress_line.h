// Progress of a run on standard error.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "approx/hull.h"

namespace ndhull {

/// Shows how far a run is: one line that is rewritten on a terminal, plain lines otherwise.
///
/// Rate      at most five a second; the first call, and the first of each phase, is always shown.
/// Lifetime  the destructor, and `clear`, leave a terminal's line empty for what follows.
class ProgressLine {
 public:
  /// Shows nothing unless standard error is a terminal or `is_forced`; never with `is_quiet`.
  ProgressLine(bool is_forced, bool is_quiet);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { clear(); }

  bool is_shown() const { return is_shown_; }
  void show(const Progress& progress);
  /// A phase of the program itself, like "read".
  void show_phase(std::string_view phase);
  void clear();

 private:
  bool is_due(std::string_view phase);
  void print(std::string text);

  using Clock = std::chrono::steady_clock;
  bool is_shown_;
  bool is_terminal_;
  bool line_is_open_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_;
  std::string last_phase_;
  Progress before_;  // shown last, or somewhat earlier
};

/// What two looks at a run tell together; 0: not known.
struct ProgressRates {
  double simplices_per_second = 0.0;  ///< more of them
  double seconds_left = 0.0;          ///< when points go on being settled as fast: a guess
};
ProgressRates rates_between(const Progress& before, const Progress& now);

/// One line, mostly below 100 columns: phase, points still outside, simplices and how many more a second, how
/// far outside the furthest point is, elapsed and left, memory.
std::string describe(const Progress& progress, const ProgressRates& rates = {});

}  // namespace ndhull
