// ndhull hull POINTS
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/hull_run.h"

namespace ndhull {

/// Adds the command. When it is chosen and parsed it runs, and sets `exit_code` as run_hull returns it.
void add_hull_command(CLI::App& app, int& exit_code);

/// `--verify exact` as `--verify=exact`, and `--verify` alone as `--verify=floating`: the word after it would
/// otherwise be taken for its value, or the value for POINTS. Arguments of other commands stay as they are.
std::vector<std::string> join_verify_mode(const std::vector<std::string>& arguments);

}  // namespace ndhull
