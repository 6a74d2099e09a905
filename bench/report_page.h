// Sections of charts and tables as a page.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "bench/report_charts.h"

namespace ndhull {

/// One HTML document with its charts in it: no script, nothing to load. Throws what draw_svg throws.
std::string html_report(const std::vector<ReportSection>& sections, const std::set<std::string>& machines);

/// The tables alone.
std::string markdown_report(const std::vector<ReportSection>& sections,
                            const std::set<std::string>& machines);

/// Writes one of the two to `path` ("-": standard output), whole or not at all.
/// Throws Error kEmptyInput: no records; kFileWrite; what draw_svg throws.
void write_report_page(const std::vector<RunRecord>& records, const std::string& path, bool markdown);

}  // namespace ndhull
