// The options that say which facets of a hull are wanted.
#pragma once

#include <CLI/CLI.hpp>
#include <string_view>

#include "approx/selection/facet_selection.h"

namespace ndhull {

/// Adds --largest, --select, --min-area, --most-merged and --bounded. `selection` must live until the command
/// line is parsed.
void add_selection_options(CLI::App& command, SelectionOptions& selection);

/// The word that --select takes for it.
std::string_view to_string(SelectionMeasure measure);

/// Throws Error kUsage for --bounded without a selection: all facets bound a region.
void check_selection(const SelectionOptions& selection);

}  // namespace ndhull
