// Wall time of steps.
#pragma once

#include <chrono>

namespace ndhull {

using Clock = std::chrono::steady_clock;

/// [s]
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace ndhull
