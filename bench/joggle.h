// What `ndhull-bench joggle` measures: how often joggled input has a precision problem.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/chart.h"
#include "bench/measure_options.h"
#include "bench/run_plan.h"
#include "bench/table.h"

namespace ndhull {

struct JoggleBenchOptions {
  std::string only;  ///< part of an input's name; empty: all
  std::uint64_t runs = 1000;
  bool without_qhull = false;
  MeasureOptions measuring;
};

/// Every size of the two tables of Qhull's manual, by ndhull and by the program qhull: detail has `size`,
/// `share` of the joggles with a problem, and `manual_share`.
RunPlan joggle_plan(const JoggleBenchOptions& options);

/// One table an input, in the order of the manual; none without records of `joggle`.
std::vector<Table> joggle_tables(const std::vector<RunRecord>& records);

/// One chart an input, the share against the size.
std::vector<Chart> joggle_charts(const std::vector<RunRecord>& records);

}  // namespace ndhull
