// The largest facets in ten lines for people.
#pragma once

#include <string>

#include "approx/largest_report.h"
#include "approx/rays/largest_facets.h"

namespace ndhull {

/// What `ndhull largest` prints when nothing else goes to standard output: one fact a line, with its unit.
std::string largest_summary(const LargestFacets& found, const LargestReportContext& context);

}  // namespace ndhull
