// ndhull verify POINTS PLANES
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "approx/planes/plane_check.h"
#include "tools/io/column_choice.h"

namespace ndhull {

/// Reads both files and tests every point against every plane; see check_planes.
/// Throws   Error as read_planes_and_points does.
PlaneCheck verify_files(const std::string& points_path, const std::string& planes_path, unsigned threads,
                        const ColumnChoice& columns = {});

/// The two lines the command prints: the worst point, plane and distance, and how many pairs are above.
std::string describe(const PlaneCheck& check);

/// Adds the command. When it is chosen and parsed it prints to standard output and sets `exit_code`: 0 every
/// point is below every plane, 2 one is above.
void add_verify_command(CLI::App& app, int& exit_code);

}  // namespace ndhull
