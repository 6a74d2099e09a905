// What `ndhull qhull` does once its option string is read.
#pragma once

#include "tools/qhull/qhull_options.h"

namespace ndhull {

/// Reads points, scales them, computes their hull, joggled or not, selects facets and prints the formats that
/// the command asks for; without any the summary.
///
/// Returns  0; 2 when the hull did not pass Tv, which is said on standard error and nothing is written; 130
///          when Ctrl-C came: what there is was written.
/// Throws   Error as read_points, scaled_points, convex_hull, joggled_hull, select_facets and OutputFile do.
int run_qhull(const QhullCommand& command, unsigned threads);

/// The same for `ndhull qhalf`: reads halfspaces and prints their intersection.
///
/// Returns  0; 2 when a vertex is above a halfspace by more than its rounding and Tv was given.
/// Throws   Error as read_halfspaces, intersect_halfspaces and open_intersection do; kBadHalfspace when the
///          intersection is empty, or has no end and is flat or of halfspaces too few for a dual hull.
int run_qhalf(const QhullCommand& command, unsigned threads);

/// "rbox 10 D3 | qhull FQ": the comment behind the dimension in the input's first line, and the command.
std::string invocation_of(std::string_view input, const QhullCommand& command);

}  // namespace ndhull
