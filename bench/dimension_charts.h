// Charts over the dimension: for each family the number of points with which most was measured.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/chart.h"
#include "bench/run_record.h"
#include "bench/table.h"

namespace ndhull {

/// One measurement of generated points and its repeats.
struct DimensionRun {
  std::string family;
  std::size_t dimension = 0, points = 0;
  RunKey key;
  Repeats repeats;  ///< not empty, complete
};

/// Of each family the runs with that number of points; one thread, one seed; in ascending dimension.
std::vector<std::vector<DimensionRun>> runs_by_family(const std::vector<RunRecord>& records);

/// One chart a family: `figure` of each engine and option set against the dimension, logarithmic where it
/// spans a decade. Runs
/// without a figure are left out, lines with one point too.
std::vector<Chart> charts_over_dimension(
    const std::vector<std::vector<DimensionRun>>& families, const std::string& y_label,
    const std::function<std::optional<double>(const DimensionRun&)>& figure);

/// One chart, or none: the widest facets of exact hulls, which are at roundoff, a line for each family and
/// engine.
std::vector<Chart> exact_width_charts(const std::vector<std::vector<DimensionRun>>& families);

/// One bar chart a family: the phases of ndhull's exact hulls.
std::vector<BarChart> phase_charts(const std::vector<std::vector<DimensionRun>>& families);

/// Qhull's seconds over ndhull's with the spread over the rounds, families x dimensions, same options.
Table ratio_table(const std::vector<std::vector<DimensionRun>>& families);

}  // namespace ndhull
