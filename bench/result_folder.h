// A folder of results: the JSON lines of several commands.
#pragma once

#include <string>
#include <vector>

#include "bench/run_record.h"

namespace ndhull {

/// The records of all *.jsonl files of the folder, files in the order of their names.
/// Throws Error kFileMissing when there is no such folder, or no such file in it; what read_records throws.
std::vector<RunRecord> read_result_folder(const std::string& folder);

}  // namespace ndhull
