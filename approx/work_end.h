// When a search that only makes a result better has to end with what it has.
#pragma once

#include <algorithm>
#include <chrono>
#include <stop_token>
#include <utility>

namespace ndhull {

/// A deadline and a request to stop. Cost  a look at the clock a call.
class WorkEnd {
 public:
  using Clock = std::chrono::steady_clock;

  WorkEnd() = default;  ///< never
  /// `max_seconds` after `start`, 0: without a limit; or when a stop is requested.
  WorkEnd(double max_seconds, std::stop_token stop, Clock::time_point start = Clock::now())
      : start_(start), max_seconds_(max_seconds), stop_(std::move(stop)) {}

  /// One of both.
  bool is_here() const { return stop_.stop_requested() || is_late(); }
  /// The deadline alone.
  bool is_late() const { return max_seconds_ > 0.0 && seconds() > max_seconds_; }
  bool has_deadline() const { return max_seconds_ > 0.0; }
  /// What is gone of the time that is allowed, 0 to 1; 0 without a deadline.
  double share_of_time() const { return has_deadline() ? std::min(1.0, seconds() / max_seconds_) : 0.0; }
  /// As in Limits: 0 without a limit, else more than 0.
  double seconds_left() const { return max_seconds_ > 0.0 ? std::max(max_seconds_ - seconds(), 1e-9) : 0.0; }
  const std::stop_token& stop() const { return stop_; }

 private:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Clock::time_point start_;
  double max_seconds_ = 0.0;
  std::stop_token stop_;
};

}  // namespace ndhull
