// The command `ndhull contains`.
#pragma once

#include <CLI/CLI.hpp>

namespace ndhull {

/// Adds the command to `app`. Its callback throws Error.
void add_contains_command(CLI::App& app);

}  // namespace ndhull
