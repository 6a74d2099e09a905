// What `ndhull largest` does once its command line is understood.
#pragma once

#include <string>
#include <vector>

#include "approx/planes/written_planes.h"
#include "approx/rays/largest_facets.h"
#include "tools/io/column_choice.h"

namespace ndhull {

/// The command line of `ndhull largest`. Paths are empty when the output is not wanted; "-" is standard
/// output.
struct LargestRequest {
  std::string points_path;
  ColumnChoice columns;
  LargestOptions options;
  std::string planes_path;
  PlaneKind plane_kind = PlaneKind::kOuter;
  bool equations = false;  ///< of flat data, planes for their subspace are written too
  std::string vertices_path;
  std::string report_path;
  bool facet_list = false;
  std::vector<std::string> formats;  ///< of Qhull, to standard output
  bool verify = false;
  bool progress = false;
  bool quiet = false;
};

/// Reads the points, finds their largest facets, verifies their outer planes if asked, and writes what was
/// asked for, the report last; where nothing else goes to standard output a summary does.
///
/// Returns  0; 2 when a point is above an outer plane as written, which is said on standard error and nothing
///          is written; 130 when Ctrl-C came: what there is was written.
/// Throws   Error as read_points, largest_facets and the writers do; kUsage, kFileWrite as run_hull.
int run_largest(const LargestRequest& request);

}  // namespace ndhull
