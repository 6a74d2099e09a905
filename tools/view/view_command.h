// ndhull view REPORT|POINTS
#pragma once

#include <CLI/CLI.hpp>

namespace ndhull {

/// Adds the command. When it is chosen and parsed it writes the picture, and sets `exit_code` to 0, or to 130
/// when Ctrl-C ended growth and what there was has been drawn.
void add_view_command(CLI::App& app, int& exit_code);

}  // namespace ndhull
