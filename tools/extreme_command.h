// ndhull extreme POINTS
#pragma once

#include <CLI/CLI.hpp>

namespace ndhull {

/// Adds the command. When it is chosen and parsed it runs, and sets `exit_code` as run_extreme returns it.
void add_extreme_command(CLI::App& app, int& exit_code);

}  // namespace ndhull
