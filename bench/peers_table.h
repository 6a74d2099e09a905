// The tables of `ndhull-bench peers`, from its records: also those of a file.
#pragma once

#include <vector>

#include "bench/run_record.h"
#include "bench/table.h"

namespace ndhull {

/// ndhull and Qhull; then every other engine beside ndhull. Without records of `peers`, none.
std::vector<Table> peers_tables(const std::vector<RunRecord>& records);

}  // namespace ndhull
