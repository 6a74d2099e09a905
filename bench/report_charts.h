// Which charts and tables the records of measured runs give.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "bench/chart.h"
#include "bench/run_record.h"
#include "bench/table.h"

namespace ndhull {

/// One heading of the report: a sentence, charts, tables.
struct ReportSection {
  std::string title, text;
  std::vector<std::variant<Chart, BarChart>> charts;
  std::vector<Table> tables;
};

/// Runtime, facet width and bytes against the dimension, facets against width, phases, ratios of Qhull's time
/// to ndhull's, growth, approximate hulls, halfspaces, selections, largest facets, joggle, and all
/// measurements of hulls. Sections for which there are no runs are
/// left out.
std::vector<ReportSection> report_sections(const std::vector<RunRecord>& records);

}  // namespace ndhull
