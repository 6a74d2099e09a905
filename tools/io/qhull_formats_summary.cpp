// The summary (s, FA) in Qhull's words, which scripts look for. The distances are certified.
#include <fmt/format.h>

#include "tools/io/qhull_formats.h"

namespace ndhull {
namespace {

std::string counts_text(const QhullPrint& print, bool counts_attached) {
  const Hull& hull = print.hull;
  const std::size_t merged = hull.facet_count() - hull.simplicial_facet_count();
  std::string text = fmt::format("\nConvex hull of {} points in {}-d:\n\n", hull.point_count, hull.dimension);
  if (hull.rank < hull.dimension) text += fmt::format("  Affine dimension of the points: {}\n", hull.rank);
  if (hull.status != HullStatus::kComplete)
    text += fmt::format("  Ended early: {}\n", to_string(hull.status));
  text += fmt::format("  Number of vertices: {}\n", hull.vertices.size());
  if (counts_attached) text += fmt::format("  Number of coplanar points: {}\n", print.attached.size());
  text += fmt::format("  Number of facets: {}\n", hull.facet_count());
  if (merged > 0) text += fmt::format("  Number of non-simplicial facets: {}\n", merged);
  if (print.facets.size() != hull.facet_count()) {
    text += fmt::format("  Number of good facets: {}\n", print.facets.size());
  }
  return text;
}

std::string work_text(const QhullPrint& print, double seconds) {
  const Hull& hull = print.hull;
  std::string text = fmt::format("\nStatistics for: {}\n\n", print.invocation);
  text += fmt::format("  Number of points processed: {}\n", hull.statistics.insertions + hull.rank + 1);
  text += fmt::format("  Number of hyperplanes created: {}\n", hull.statistics.created_simplices);
  const std::size_t merged = hull.simplex_count() - hull.facet_count();
  if (merged > 0) text += fmt::format("  Number of merged facets: {}\n", merged);
  return text + fmt::format("  CPU seconds to compute hull (after input): {:.4g}\n", seconds);
}

}  // namespace

std::string qhull_summary(const QhullPrint& print, const QhullSummaryParts& parts) {
  const Hull& hull = print.hull;
  std::string text = counts_text(print, parts.counts_attached) + work_text(print, parts.seconds) + parts.run;
  if (parts.with_area) {
    text +=
        fmt::format("  Total facet area:   {:.8g}\n  Total volume:       {:.8g}\n", hull.area, hull.volume);
  }
  const InputOffsets offsets = input_offsets(hull);
  text += fmt::format("  Maximum distance of point above facet: {:.2g}\n", offsets.outer);
  text += fmt::format("  Maximum distance of vertex below facet: {:.2g}\n", offsets.inner);
  if (hull.points_outside > 0)
    text += fmt::format("  Points above an outer plane: {}\n", hull.points_outside);
  return text + "\n";
}

}  // namespace ndhull
