// One command a file; this one turns words into calls and exceptions into exit codes.
#pragma once

namespace ndhull {

/// Runs the command that the words ask for. Returns the exit code: 1 bad usage or input, 2 slower than
/// before, 3 an engine failed.
int run_bench(int argc, const char* const* argv);

}  // namespace ndhull
