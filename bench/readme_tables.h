// The measured tables of READMEs, shorter than those of the report.
#pragma once

#include <string>
#include <vector>

#include "bench/run_record.h"

namespace ndhull {

/// The table called `name` as Markdown without a title, or with "machine" the lines that say where the
/// records were measured.
/// Throws Error kUsage: there is no such table, or there are no records for it; the message has the names.
std::string readme_table(const std::string& name, const std::vector<RunRecord>& records);

/// Replaces what stands between "<!-- table: NAME -->" and "<!-- end of table -->", each on a line of its
/// own, by the table of that name.
/// Throws Error kBadHeader, with `path` and the line: an opening line without its end; as readme_table.
std::string with_readme_tables(const std::string& text, const std::string& path,
                               const std::vector<RunRecord>& records);

}  // namespace ndhull
