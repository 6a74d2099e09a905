// One command a file; this one turns words into calls and exceptions into exit codes.
#pragma once

#include <string>
#include <vector>

namespace ndhull {

/// Runs the command that the words behind the program's name ask for. Returns the exit code; what went wrong
/// is said on standard error in one line.
int run_program(const std::vector<std::string>& arguments);

}  // namespace ndhull
