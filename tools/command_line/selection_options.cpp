#include "tools/command_line/selection_options.h"

#include <string>

#include "core/error.h"
#include "tools/command_line/command_options.h"

namespace ndhull {

void add_selection_options(CLI::App& command, SelectionOptions& selection) {
  CLI::Option* const largest =
      command.add_option("--largest", selection.largest, "select the N facets of largest area")
          ->type_name("N")
          ->check(whole_number(1));
  add_word_option(
      command, "--select", selection.measure,
      {SelectionMeasure::kArea, SelectionMeasure::kVolume, SelectionMeasure::kDistance},
      "what --largest means: area (default); volume: the N facets whose outer planes together "
      "enclose little; distance: those whose outer planes meet nowhere far from the hull; both take N "
      "above the rank, since fewer bound no region")
      ->type_name("MEASURE")
      ->needs(largest);
  command.add_option("--min-area", selection.min_area, "select the facets of at least area A")
      ->type_name("A")
      ->check(positive_number());
  command
      .add_option("--most-merged", selection.most_merged,
                  "select the N facets that were merged of most simplices")
      ->type_name("N")
      ->check(whole_number(1));
  command.add_flag("--bounded", selection.bounded,
                   "add the fewest further facets that make the outer planes bound a region");
}

std::string_view to_string(SelectionMeasure measure) {
  switch (measure) {
    case SelectionMeasure::kArea: return "area";
    case SelectionMeasure::kVolume: return "volume";
    case SelectionMeasure::kDistance: return "distance";
  }
  return "unknown";
}

void check_selection(const SelectionOptions& selection) {
  if (!selection.bounded || selection.is_set()) return;
  throw Error(ErrorCode::kUsage,
              "--bounded: found no selection, expected --largest, --min-area or --most-merged; all facets "
              "together bound a region anyway");
}

}  // namespace ndhull
