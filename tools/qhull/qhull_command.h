// The commands `ndhull qhull` and `ndhull qhalf`.
#pragma once

#include <CLI/CLI.hpp>

namespace ndhull {

/// Adds the commands. The exit code of a run goes to `exit_code`.
void add_qhull_command(CLI::App& app, int& exit_code);
void add_qhalf_command(CLI::App& app, int& exit_code);

}  // namespace ndhull
