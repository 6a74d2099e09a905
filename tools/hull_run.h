// What `ndhull hull` does once its command line is understood.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "approx/hull.h"
#include "approx/planes/written_planes.h"
#include "approx/selection/facet_selection.h"
#include "approx/verify/verify.h"
#include "tools/io/column_choice.h"

namespace ndhull {

/// The command line of `ndhull hull`. Paths are empty when the output is not wanted; "-" is standard output.
struct HullRequest {
  std::string points_path;
  ColumnChoice columns;        ///< of points_path
  std::string shards_pattern;  ///< instead: of files, shared out among the processes that mpirun started
  HullOptions options;
  SelectionOptions selection;
  bool outer_volume = false;  ///< for the report and the summary, whatever it costs
  std::string planes_path;
  PlaneKind plane_kind = PlaneKind::kOuter;
  bool equations = false;  ///< of flat data, planes for their subspace are written too
  std::string vertices_path;
  std::string report_path;
  bool facet_list = false;
  std::string curve_path;            ///< table and picture of facets against width
  std::vector<std::string> formats;  ///< to standard output, in this order
  std::optional<VerifyMode> verify;
  bool progress = false;
  bool quiet = false;
};

/// Reads the points, computes their hull, selects facets and verifies it if asked, and writes what was asked
/// for, the report last; where nothing else goes to standard output a summary does. A selection whose outer
/// planes do not bound a region is said on standard error.
///
/// Several processes: the first one writes and prints, the others return 0 or the exit code of an error that
/// it prints for all. One that fails on its own prints that and ends all.
///
/// Returns  0; 2 when a claim of the hull failed, which is said on standard error and nothing is written;
///          130 when Ctrl-C came: what there is was written.
/// Throws   Error as read_points, convex_hull and the writers do; kUsage when two outputs want standard
///          output or the same file, kFileWrite before anything is computed when an output cannot be written.
int run_hull(const HullRequest& request);

}  // namespace ndhull
