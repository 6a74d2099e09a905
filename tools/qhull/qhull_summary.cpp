#include "tools/qhull/qhull_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "approx/report.h"

namespace ndhull {
namespace {

/// The options with which Qhull looks at areas, and sums them up.
bool looks_at_areas(const QhullCommand& command) {
  const auto is_of_areas = [](const std::string& format) { return format == "Fa" || format == "FS"; };
  return command.has_size || command.selection.largest || command.selection.min_area ||
         std::ranges::any_of(command.formats, is_of_areas);
}

}  // namespace

std::string summary_text(const QhullPrint& print, const QhullCommand& command, const QhullRunFacts& facts) {
  QhullSummaryParts parts{.with_area = looks_at_areas(command),
                          .counts_attached = command.keep_coplanar || command.keep_interior,
                          .seconds = facts.hull_seconds};
  if (facts.joggle) {
    parts.run += fmt::format("  Input joggled by: {:.2g}", *facts.joggle);
    if (facts.joggle_retries > 0) parts.run += fmt::format(", after {} retries", facts.joggle_retries);
    parts.run += '\n';
  }
  if (command.reruns > 0) {
    parts.run +=
        fmt::format("  Percentage of runs with precision errors: {:.1f}\n",
                    100.0 * static_cast<double>(facts.problem_runs) / static_cast<double>(command.reruns));
  }
  return qhull_summary(print, parts);
}

std::string statistics_text(const Hull& hull) {
  const HullStatistics& statistics = hull.statistics;
  std::string text = fmt::format("growth    {} insertions, {} simplices made, {} left\n",
                                 statistics.insertions, statistics.created_simplices, hull.simplex_count());
  text += fmt::format("precision {} points shifted, {} insertions undone, {} repair rounds\n",
                      statistics.shifted_points, statistics.rejected_insertions, statistics.repair_rounds);
  text += fmt::format("merging   {} merges, {} refused; {} facets of {} simplices\n", hull.chosen.merges,
                      hull.chosen.refused_merges, hull.facet_count(), hull.simplex_count());
  text += fmt::format("widths    outer {:.3g}, inner {:.3g}, widest facet {:.3g}, roundoff {:.3g}\n",
                      hull.max_outer_offset, hull.min_inner_offset, hull.max_facet_width, hull.roundoff);
  text += "seconds  ";
  for (std::size_t phase = 0; phase < statistics.seconds.size(); ++phase) {
    text += fmt::format(" {} {:.3g}", to_string(static_cast<Phase>(phase)), statistics.seconds[phase]);
  }
  return text + "\n";
}

std::string options_text(const Hull& hull, const QhullCommand& command, const QhullRunFacts& facts) {
  std::string text = fmt::format("Options of ndhull {}: {}\n", version(), command.text);
  text += fmt::format("  outside-width {:.3g}\n", hull.chosen.outside_width);
  text += fmt::format("  centrum-radius {:.3g}\n", command.centrum_radius);
  if (command.max_cosine <= 1.0) text += fmt::format("  max-cosine {:.6g}\n", command.max_cosine);
  if (hull.chosen.width_cap > 0.0) text += fmt::format("  width-cap {:.3g}\n", hull.chosen.width_cap);
  if (facts.joggle) text += fmt::format("  joggle {:.3g}\n", *facts.joggle);
  text += fmt::format("  roundoff {:.2g}\n", hull.roundoff);
  return text;
}

}  // namespace ndhull
