// Ctrl-C: the first ends the run with what there is, the second at once.
#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

#include "tools/command_line/exit_code.h"  // IWYU pragma: export

namespace ndhull {

/// Takes SIGINT as long as it lives: a thread waits for it, so that no code is interrupted half way.
///
/// Before `arm`   there is nothing worth keeping: SIGINT ends the process with kInterruptedExitCode.
/// After `arm`    the first one requests a stop, the second ends the process at once.
/// Threads        construct before other threads are started: they inherit that the signal is blocked.
class Interrupt {
 public:
  Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  ~Interrupt();

  void arm() { is_armed_ = true; }
  std::stop_token token() const { return stop_.get_token(); }
  bool requested() const { return stop_.stop_requested(); }

 private:
  void wait_for_signals();

  std::stop_source stop_;
  std::atomic<bool> is_armed_ = false;
  std::atomic<bool> is_done_ = false;
  std::thread waiter_;
};

}  // namespace ndhull
