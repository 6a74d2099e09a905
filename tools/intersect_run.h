// What `ndhull intersect` does once its command line is understood.
#pragma once

#include <string>
#include <vector>

#include "approx/polytope/halfspace_intersection.h"

namespace ndhull {

/// The command line of `ndhull intersect`. Paths are empty when the output is not wanted; "-" is standard
/// output.
struct IntersectRequest {
  std::string halfspaces_path;
  IntersectionOptions options;
  std::string vertices_path;
  std::string report_path;
  bool vertex_list = false;
  std::vector<std::string> formats;  ///< to standard output, in this order
  bool progress = false;
  bool quiet = false;
};

/// Reads the halfspaces, intersects them and writes what was asked for, the report last; where standard
/// output is free prints a summary.
///
/// Returns  0; 130 when Ctrl-C came: what there is was written.
/// Throws   Error as read_halfspaces, intersect_halfspaces and the writers do; kUsage when two outputs want
///          the same place; kBadHalfspace when vertices were asked for and the intersection is empty or not
///          bounded (a report has then been written).
int run_intersect(const IntersectRequest& request);

}  // namespace ndhull
