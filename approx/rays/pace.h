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
  /// Calls work, which does so many, and sees what part of all the time that takes.
  template <class Work>
  void look_at(std::size_t count, const WorkEnd& end, const Work& work) {
    constexpr double kShort = 1.0 / 64.0, kLong = 1.0 / 16.0;
    const double before = end.share_of_time();
    work();
    const double after = end.share_of_time(), share = after - before;
    if (count >= now_ && share < kShort && after < 1.0) now_ = std::min(2 * now_, most_);
    if (share > kLong) now_ = std::max<std::size_t>(1, now_ / 2);
  }

 private:
  std::size_t most_, now_ = 1;
};

}  // namespace ndhull
