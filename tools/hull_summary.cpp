#include "tools/hull_summary.h"

#include <fmt/format.h>

#include "approx/hull.h"
#include "approx/polytope/outer_volume.h"
#include "approx/selection/facet_selection.h"
#include "approx/selection/outer_distance.h"
#include "approx/verify/verify.h"
#include "tools/command_line/byte_count.h"
#include "tools/command_line/summary_text.h"

namespace ndhull {
namespace {

std::string describe_selection(const FacetSelection& selection, const OuterDistance* outer) {
  std::string text = fmt::format("selected  {} facets", grouped(selection.facets.size()));
  if (selection.added > 0) text += fmt::format(", {} of them to bound a region", grouped(selection.added));
  if (selection.is_cut_short) text += ", the choice cut short by a limit";
  if (!selection.bounded) return text + "; not bounded\n";
  if (outer == nullptr || !outer->distance) return text + "; bounded\n";
  return text + fmt::format("; bounded, nowhere further than {:.6g} from the hull\n", *outer->distance);
}

std::string describe_size(std::string_view name, double size, std::string_view unit) {
  if (!is_in_range(size)) return fmt::format("{:<10}beyond the range of doubles\n", name);
  return fmt::format("{:<10}{:.10g} {}\n", name, size, unit);
}

std::string describe_outer_volume(const OuterVolume& outer, const Hull& hull) {
  if (!outer.volume) return fmt::format("outer     no volume: {}\n", outer.reason);
  return fmt::format("outer     {:.10g} {}: below the outer planes\n", *outer.volume,
                     power_of_unit(hull.rank));
}

/// Of a target that was missed: by how much, and why.
std::string describe_miss(const Hull& hull, const HullOptions& options) {
  const double asked = hull.chosen.width_asked;
  if (!options.accuracy.width.is_set() || hull.max_facet_width <= asked) return "";
  return fmt::format("; {:.3g} was asked for{}", asked,
                     hull.status == HullStatus::kComplete ? ", which is less than rounding" : "");
}

}  // namespace

std::string hull_summary(const Hull& hull, const ReportContext& context) {
  const std::string_view unit = context.options.unit_cube ? "[unit cube]" : "[input]";
  std::string text = fmt::format("hull      {}: {} points in {}-d, {}\n", context.input_path,
                                 grouped(hull.point_count), hull.dimension, to_string(hull.status));
  if (hull.rank < hull.dimension) {
    text += fmt::format("rank      {}: the points lie in a {}-d subspace; what follows is their hull in it\n",
                        hull.rank, hull.rank);
  }
  if (hull.points_outside > 0) {
    text += fmt::format("outside   {} points are above some outer plane\n", grouped(hull.points_outside));
  }
  text += fmt::format("vertices  {}\n", grouped(hull.vertices.size()));
  text +=
      fmt::format("facets    {}: {} simplicial, {} merged; {} simplices\n", grouped(hull.facet_count()),
                  grouped(hull.simplicial_facet_count()),
                  grouped(hull.facet_count() - hull.simplicial_facet_count()), grouped(hull.simplex_count()));
  if (hull.chosen.objective != context.options.accuracy.objective) {
    text += "objective width: so few of the exact hull's planes bound no region, others do\n";
  }
  if (context.selection != nullptr) text += describe_selection(*context.selection, context.outer_distance);
  if (hull.rank > 0) {
    // The facets of a segment are its two ends, which are counted.
    text += describe_size("volume", hull.volume, power_of_unit(hull.rank));
    if (context.outer_volume != nullptr) text += describe_outer_volume(*context.outer_volume, hull);
    if (hull.rank > 1) text += describe_size("area", hull.area, power_of_unit(hull.rank - 1));
    text += fmt::format("width     {:.3g} {}: the widest facet, certified{}\n", hull.max_facet_width, unit,
                        describe_miss(hull, context.options));
    text += fmt::format("roundoff  {:.3g} {}\n", hull.roundoff, unit);
  }
  if (hull.status != HullStatus::kComplete) {
    text += fmt::format("gauge     {:.3g}: all points lie in the hull scaled by 1 + this\n",
                        hull.max_outside_gauge);
  }
  const HullStatistics& statistics = hull.statistics;
  text += fmt::format("time      {:.2f} s: read {:.2f}", context.total_seconds, context.read_seconds);
  for (std::size_t phase = 0; phase < statistics.seconds.size(); ++phase) {
    text += fmt::format(", {} {:.2f}", to_string(static_cast<Phase>(phase)), statistics.seconds[phase]);
  }
  if (context.verification != nullptr) text += fmt::format(", verify {:.2f}", context.verify_seconds);
  constexpr double kShown = 0.005;  // seconds; less is 0.00
  if (context.select_seconds >= kShown) text += fmt::format(", select {:.2f}", context.select_seconds);
  if (context.outer_volume_seconds >= kShown)
    text += fmt::format(", outer volume {:.2f}", context.outer_volume_seconds);
  text += fmt::format("\nmemory    {}\n", format_byte_count(context.peak_memory_bytes));
  if (context.verification != nullptr) {
    text += fmt::format("verified  {}\n",
                        context.verification->complete() ? "every claim" : "samples of the claims");
  }
  return text;
}

}  // namespace ndhull
