// Where on the segment between two planes a third one has both facets' vertices in its slab.
#pragma once

#include <algorithm>

namespace ndhull {

/// The places u on the segment at which all vertices so far are in the slab.
class Interval {
 public:
  /// By how much a vertex is too deep at u = 0 and at u = 1: its depth less the width, in any unit that both
  /// have in common. None left: begin is above end, and length() below 0.
  void take(double excess_first, double excess_last) {
    if (excess_first > 0.0) {
      begin_ = std::max(begin_, excess_last < 0.0 ? excess_first / (excess_first - excess_last) : 2.0);
    } else if (excess_last > 0.0) {
      end_ = std::min(end_, -excess_first / (excess_last - excess_first));
    }
  }
  bool is_empty() const { return begin_ > end_; }
  double length() const { return end_ - begin_; }
  double middle() const { return 0.5 * (begin_ + end_); }

 private:
  double begin_ = 0.0, end_ = 1.0;
};

}  // namespace ndhull
