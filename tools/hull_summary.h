// A hull in ten lines for people.
#pragma once

#include <string>

#include "approx/hull.h"
#include "approx/report.h"

namespace ndhull {

/// What `ndhull hull` prints when nothing else is asked for: one fact a line, with its unit.
std::string hull_summary(const Hull& hull, const ReportContext& context);

}  // namespace ndhull
