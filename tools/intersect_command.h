// The command `ndhull intersect`.
#pragma once

#include <CLI/CLI.hpp>

namespace ndhull {

/// Adds the command to `app`. Its callback sets `exit_code`, or throws Error.
void add_intersect_command(CLI::App& app, int& exit_code);

}  // namespace ndhull
