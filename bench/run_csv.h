// Measured runs as a table for spreadsheets: one line for each measurement, its repeats summed up.
#pragma once

#include <string>
#include <vector>

#include "bench/run_record.h"

namespace ndhull {

/// The measurements of `records`, in the order of their first runs. Repeats without a run that was done are
/// in it, with the reason. `records` of the same key but another command or task are the same measurement.
std::vector<std::pair<RunRecord, Repeats>> measurements_of(const std::vector<RunRecord>& records);

/// Peak memory beyond the points, for each facet of the simplicial hull. [bytes] 0 where it is not known.
double bytes_per_facet(const RunRecord& record);

/// [seconds] of the phase called `name`; 0 of engines that have no phases.
double phase_seconds(const HullRun& run, const std::string& name);

/// RFC 4180, a header line first. What an engine does not say is an empty field. Throws Error kFileWrite; the
/// file is written whole or not at all.
void write_csv(const std::vector<RunRecord>& records, const std::string& path);

}  // namespace ndhull
