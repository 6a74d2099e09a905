// The threads of one call.
#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

namespace ndhull {

/// Each of them is a thread of the system; far more than any machine has cores.
inline constexpr unsigned kMostThreads = 1024;

/// Where the loops of a call that may use so many threads are shared out; 0: all cores. More than
/// kMostThreads are as many as that.
inline tbb::task_arena arena_of(unsigned threads) {
  return tbb::task_arena(threads == 0 ? tbb::task_arena::automatic
                                      : static_cast<int>(std::min(threads, kMostThreads)));
}

/// What is made when it is first asked for, by whichever thread. Isolated: a thread that waits inside must not
/// begin other work of the caller's, which may ask again.
template <class Make>
void call_once_isolated(std::once_flag& is_made, const Make& make) {
  std::call_once(is_made, [&] { tbb::this_task_arena::isolate(make); });
}

}  // namespace ndhull
