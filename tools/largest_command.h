// ndhull largest POINTS
#pragma once

#include <CLI/CLI.hpp>

namespace ndhull {

/// Adds the command. When it is chosen and parsed it runs, and sets `exit_code` as run_largest returns it.
void add_largest_command(CLI::App& app, int& exit_code);

}  // namespace ndhull
