// The tables of `ndhull-bench approximate`, from its records: also those of a file.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/run_record.h"
#include "bench/table.h"

namespace ndhull {

/// What a run is for (RunRecord::task). Runs of one group answer one case of the list.
namespace approximate_task {
inline constexpr const char* kEqualOptions = "equal options";  ///< both engines
inline constexpr const char* kEqualFacets = "equal facets";    ///< ndhull with Qhull's number of facets
inline constexpr const char* kEqualWidth = "equal width";      ///< ndhull with Qhull's widest facet
inline constexpr const char* kTargets = "targets";             ///< ndhull: exact, and widths in percent
inline constexpr const char* kThorough = "thorough";           ///< ndhull: the same widths, looked for longer
}  // namespace approximate_task

/// The runs of one case, engines apart.
struct ApproximateGroup {
  std::string name;
  nlohmann::json points;
  Repeats qhull, equal_options, equal_facets, equal_width;
  std::vector<std::pair<std::string, Repeats>> targets;   ///< by options, in the order of the file
  std::vector<std::pair<std::string, Repeats>> thorough;  ///< likewise

  const Repeats& target(const std::string& options) const;  ///< empty when there is none
};
std::vector<ApproximateGroup> approximate_groups(const std::vector<RunRecord>& records);

/// [distance] Highest outer plane to lowest vertex, of all facets together: what Qhull prints.
double width_of_all_facets(const HullRun& run);

/// Equal options, equal facets, equal width, approximate beside exact, thorough beside quick; a table without
/// rows is left out. Records of other commands are passed over.
std::vector<Table> approximate_tables(const std::vector<RunRecord>& records);

}  // namespace ndhull
