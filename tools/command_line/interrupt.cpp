#include "tools/command_line/interrupt.h"

#include <pthread.h>
#include <signal.h>

#include "tools/io/sudden_end.h"

namespace ndhull {
namespace {

sigset_t only_sigint() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGINT);
  return set;
}

}  // namespace

Interrupt::Interrupt() {
  // A shell without job control starts background commands with the signal ignored; sigwait needs it back.
  ::signal(SIGINT, SIG_DFL);
  const sigset_t set = only_sigint();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  waiter_ = std::thread([this] { wait_for_signals(); });
}

Interrupt::~Interrupt() {
  is_done_ = true;
  ::pthread_kill(waiter_.native_handle(), SIGINT);
  waiter_.join();
  const sigset_t set = only_sigint();
  ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void Interrupt::wait_for_signals() {
  const sigset_t set = only_sigint();
  for (int signal = 0; ::sigwait(&set, &signal) == 0;) {
    if (is_done_) return;
    if (!is_armed_ || stop_.stop_requested()) end_suddenly(kInterruptedExitCode);
    stop_.request_stop();
  }
}

}  // namespace ndhull
