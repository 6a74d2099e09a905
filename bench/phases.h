// The tables of `ndhull-bench phases`: where the time of ndhull goes.
#pragma once

#include <vector>

#include "bench/run_record.h"
#include "bench/table.h"

namespace ndhull {

/// The clocks that convex_hull keeps itself, of the run of median length of each input: exact hulls on one
/// thread by `phases` and `peers`. No rows without such records.
Table phases_table(const std::vector<RunRecord>& records);

}  // namespace ndhull
