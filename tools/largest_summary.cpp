#include "tools/largest_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "tools/command_line/byte_count.h"
#include "tools/command_line/summary_text.h"

namespace ndhull {
namespace {

std::string describe_sample(const LargestFacets& found) {
  const RaySample& sample = found.sample;
  const auto by_ray = std::count_if(found.facets.begin(),
                                    found.facets.begin() + static_cast<std::ptrdiff_t>(found.largest_count),
                                    [](const LargestFacet& facet) { return facet.hits > 0; });
  std::string text = fmt::format("found     {} hit by rays, {} by climbing only\n", by_ray,
                                 found.largest_count - static_cast<std::size_t>(by_ray));
  text += fmt::format("rays      {} hit {} facets, climbs led to {}; directions uniform in {} units\n",
                      grouped(sample.rays), grouped(sample.facets_hit), grouped(sample.facets_found),
                      sample.directions);
  if (sample.open_rays > 0) text += fmt::format("open      {} rays\n", grouped(sample.open_rays));
  text +=
      fmt::format("unseen    with {:g} % confidence no facet without a hit has over {:.2g} % of directions; ",
                  100.0 * sample.confidence, 100.0 * sample.unseen_share);
  text += sample.recall.has_value() ? fmt::format("estimated recall {:.2f}\n", *sample.recall)
                                    : std::string("no facet was found\n");
  return text;
}

}  // namespace

std::string largest_summary(const LargestFacets& found, const LargestReportContext& context) {
  std::string text = fmt::format("largest   {}: {} points in {}-d\n", context.input_path,
                                 grouped(found.point_count), found.dimension);
  if (found.rank < found.dimension) {
    text += fmt::format(
        "rank      {}: the points lie in a {}-d subspace; the facets are those of their hull in it\n",
        found.rank, found.rank);
  }
  text += fmt::format("facets    {} by {}, {}\n", grouped(found.largest_count),
                      found.method == LargestMethod::kHull ? "the whole hull" : "rays and climbs",
                      to_string(found.status));
  if (found.largest_count > 0) {
    if (found.rank > 1) {  // the facets of a segment are its two ends, which are counted
      text += fmt::format("areas     {:.6g} to {:.6g} {}\n", found.facets.front().area,
                          found.facets[found.largest_count - 1].area, power_of_unit(found.rank - 1));
      const auto parts = std::ranges::count(std::span(found.facets).first(found.largest_count), false,
                                            &LargestFacet::area_is_whole);
      if (parts > 0)
        text += fmt::format(
            "parts     of {} facets the area is that of a part: too many points, or too little time\n",
            grouped(static_cast<std::uint64_t>(parts)));
    }
    double width = 0.0;
    for (const LargestFacet& facet : found.facets) {
      width = std::max(width, facet.outer_offset - facet.inner_offset);
    }
    text += fmt::format("width     {:.3g} [input]: the widest facet, certified\n", width);
  }
  if (found.is_bounded.has_value()) {
    text += fmt::format("bounded   {}", *found.is_bounded ? "yes" : "no");
    const std::size_t added = found.facets.size() - found.largest_count;
    if (added > 0) text += fmt::format(", with {} further facets", grouped(added));
    text += '\n';
  }
  if (found.sample.rays > 0) text += describe_sample(found);
  text +=
      fmt::format("time      {:.2f} s: read {:.2f}, search {:.2f}, certify {:.2f}\n", context.total_seconds,
                  context.read_seconds, found.search_seconds, found.certify_seconds);
  text += fmt::format("memory    {}\n", format_byte_count(context.peak_memory_bytes));
  if (context.verification != nullptr) text += "verified  every outer plane\n";
  return text;
}

}  // namespace ndhull
