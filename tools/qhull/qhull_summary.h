// What Qhull's command line says beside its formats: the summary (s, FA), statistics (Ts), options (FO).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "approx/hull.h"
#include "tools/io/qhull_formats.h"
#include "tools/qhull/qhull_options.h"

namespace ndhull {

/// What is told of a run beside its hull.
struct QhullRunFacts {
  double hull_seconds = 0.0;
  std::optional<double> joggle;  ///< [distance]
  unsigned joggle_retries = 0;
  std::uint64_t problem_runs = 0;  ///< of command.reruns
};

/// The summary with what the options ask for (qhull_summary).
std::string summary_text(const QhullPrint& print, const QhullCommand& command, const QhullRunFacts& facts);

/// Numbers about growth, certificate and merging, one fact a line.
std::string statistics_text(const Hull& hull);

/// What the option string came to, one option a line.
std::string options_text(const Hull& hull, const QhullCommand& command, const QhullRunFacts& facts);

}  // namespace ndhull
