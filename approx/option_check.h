// Options that contradict each other, or that say nothing.
#pragma once

#include "approx/hull.h"

namespace ndhull {

/// How messages spell an option: as a field, width_cap, or as the program's, --width-cap.
enum class OptionSpelling { kField, kProgram };

/// Throws Error kUsage for what a hull cannot honour: a length, cosine or shift that is no number in its
/// range, two targets, merging beside a target, a cap without merging, more effort without a target width,
/// facets that are to be simplices and merged.
void check_options(const HullOptions& options, OptionSpelling spelling = OptionSpelling::kField);

}  // namespace ndhull
