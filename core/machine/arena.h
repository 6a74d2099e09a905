// The threads of one call.
#pragma once

#include <tbb/task_arena.h>

#include <algorithm>

namespace ndhull {

/// Each of them is a thread of the system; far more than any machine has cores.
inline constexpr unsigned kMostThreads = 1024;

/// Where the loops of a call that may use so many threads are shared out; 0: all cores. More than
/// kMostThreads are as many as that.
inline tbb::task_arena arena_of(unsigned threads) {
  return tbb::task_arena(threads == 0 ? tbb::task_arena::automatic
                                      : static_cast<int>(std::min(threads, kMostThreads)));
}

}  // namespace ndhull
