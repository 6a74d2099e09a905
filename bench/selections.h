// What `ndhull-bench selections` measures: how much a few outer planes enclose.
#pragma once

#include <string>
#include <vector>

#include "bench/measure_options.h"
#include "bench/run_plan.h"
#include "bench/table.h"

namespace ndhull {

struct SelectionsOptions {
  std::string only;  ///< part of an input's name; empty: all
  MeasureOptions measuring;
};

/// On ten inputs 20 facets, the largest (completed to a bounded region) and those chosen for volume; then
/// hulls with a target number of facets for the volume beside Qhull's approximate hulls with as many.
/// detail.outer_ratio: volume below the outer planes over that of the hull.
/// Throws Error kUsage when no input is chosen.
RunPlan selections_plan(const SelectionsOptions& options);

/// One table for each of the two; without their records they have no rows.
std::vector<Table> selections_tables(const std::vector<RunRecord>& records);

}  // namespace ndhull
