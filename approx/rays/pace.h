// How much is done between two looks at the clock.
#pragma once

#include <algorithm>
#include <cstddef>

#include "approx/work_end.h"

namespace ndhull {

/// Things that take any time: few at once until it is known that they are short, where there is a deadline.
class Pace {
 public:
  /// At most so many at once.
  explicit Pace(std::size_t most) : most_(most) {}

  /// Of so many that are left: all of them without a deadline.
  std::size_t at_once(std::size_t left, const WorkEnd& end) const {
    return end.has_deadline() ? std::min(now_, left) : left;
  }
  /// Calls work, and sees what part of all the time it takes.
  template <class Work>
  void look_at(const WorkEnd& end, const Work& work) {
    constexpr double kShort = 1.0 / 64.0, kLong = 1.0 / 16.0;
    const double before = end.share_of_time();
    work();
    const double share = end.share_of_time() - before;
    if (share < kShort) now_ = std::min(2 * now_, most_);
    if (share > kLong) now_ = std::max<std::size_t>(1, now_ / 2);
  }

 private:
  std::size_t most_, now_ = 1;
};

}  // namespace ndhull
