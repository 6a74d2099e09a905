#include "tools/qhull/qhull_summary.h"

#include <fmt/format.h>

#include "approx/report.h"

namespace ndhull {
namespace {

void add_counts(std::string& text, const QhullPrint& print, const QhullCommand& command) {
  const Hull& hull = print.hull;
  const std::size_t merged = hull.facet_count() - hull.simplicial_facet_count();
  text += fmt::format("\nConvex hull of {} points in {}-d:\n\n", hull.point_count, hull.dimension);
  if (hull.rank < hull.dimension) text += fmt::format("  Affine dimension of the points: {}\n", hull.rank);
  if (hull.status != HullStatus::kComplete)
    text += fmt::format("  Ended early: {}\n", to_string(hull.status));
  text += fmt::format("  Number of vertices: {}\n", hull.vertices.size());
  if (command.keep_coplanar || command.keep_interior)
    text += fmt::format("  Number of coplanar points: {}\n", print.attached.size());
  text += fmt::format("  Number of facets: {}\n", hull.facet_count());
  if (merged > 0) text += fmt::format("  Number of non-simplicial facets: {}\n", merged);
  if (print.facets.size() != hull.facet_count()) {
    text += fmt::format("  Number of good facets: {}\n", print.facets.size());
  }
}

void add_work(std::string& text, const QhullPrint& print, const QhullCommand& command,
              const QhullRunFacts& facts) {
  const Hull& hull = print.hull;
  text += fmt::format("\nStatistics for: {}\n\n", print.invocation);
  text += fmt::format("  Number of points processed: {}\n", hull.statistics.insertions + hull.rank + 1);
  text += fmt::format("  Number of hyperplanes created: {}\n", hull.statistics.created_simplices);
  const std::size_t merged = hull.simplex_count() - hull.facet_count();
  if (merged > 0) text += fmt::format("  Number of merged facets: {}\n", merged);
  text += fmt::format("  CPU seconds to compute hull (after input): {:.4g}\n", facts.hull_seconds);
  if (facts.joggle) {
    text += fmt::format("  Input joggled by: {:.2g}", *facts.joggle);
    if (facts.joggle_retries > 0) text += fmt::format(", after {} retries", facts.joggle_retries);
    text += '\n';
  }
  if (command.reruns > 0) {
    text +=
        fmt::format("  Percentage of runs with precision errors: {:.1f}\n",
                    100.0 * static_cast<double>(facts.problem_runs) / static_cast<double>(command.reruns));
  }
}

}  // namespace

std::string summary_text(const QhullPrint& print, const QhullCommand& command, const QhullRunFacts& facts) {
  const Hull& hull = print.hull;
  std::string text;
  add_counts(text, print, command);
  add_work(text, print, command, facts);
  if (command.has_size) {
    text +=
        fmt::format("  Total facet area:   {:.8g}\n  Total volume:       {:.8g}\n", hull.area, hull.volume);
  }
  text += fmt::format("  Maximum distance of point above facet: {:.2g}\n", hull.max_outer_offset);
  text += fmt::format("  Maximum distance of vertex below facet: {:.2g}\n", hull.min_inner_offset);
  if (hull.points_outside > 0)
    text += fmt::format("  Points above an outer plane: {}\n", hull.points_outside);
  return text + "\n";
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
