// What a run made and how, as JSON: #include <ndhull/report.h>, call ndhull::hull_report_json.
#pragma once

#include "approx/report.h"  // IWYU pragma: export
