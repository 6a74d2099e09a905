// The program ndhull.
#include <unistd.h>

#include <csignal>

#include "tools/command_line/exit_code.h"
#include "tools/program.h"

namespace {

/// NDHULL_CHECK prints the failed condition and aborts: an internal error like any other.
extern "C" void end_after_abort(int) { ::_exit(ndhull::kInternalErrorExitCode); }

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGABRT, end_after_abort);
  // A file that may not grow is an error of the write, said like that of a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  return ndhull::run_program({argv + 1, argv + argc});
}
