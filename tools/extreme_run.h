// What `ndhull extreme` does once its command line is understood.
#pragma once

#include <cstddef>
#include <string>

#include "approx/rays/extreme_points.h"
#include "tools/io/column_choice.h"

namespace ndhull {

/// The command line of `ndhull extreme`. Paths are empty when the output is not wanted; "-" is standard
/// output.
struct ExtremeRequest {
  std::string points_path;
  ColumnChoice columns;
  ExtremeOptions options;
  std::size_t keep = 0;  ///< 0: all vertices
  std::string vertices_path, planes_path, distances_path, report_path;
  bool verify = false;
  bool progress = false;
  bool quiet = false;
};

/// Reads the points, finds their vertices, chooses among them if asked, verifies, and writes what was asked
/// for, the report last; where nothing else goes to standard output a summary does.
///
/// Returns  0; 2 when a plane does not part its vertex from all other points, which is said on standard error
///          and nothing is written; 130 when Ctrl-C came: what there is was written.
/// Throws   Error as read_points, extreme_points and the writers do; kUsage, kFileWrite as run_hull.
int run_extreme(const ExtremeRequest& request);

}  // namespace ndhull
