#include "approx/exact_instead.h"

#include <algorithm>

namespace ndhull {
namespace {

/// Is a hull that is wider than was asked for to be compared with the exact one? For widths so small that
/// both take about as long.
bool is_missed(const ResolvedAccuracy& lengths, double max_facet_width) {
  constexpr double kSmall = 1e-6;
  return max_facet_width > lengths.width && lengths.width > 0.0 &&
         lengths.width <= kSmall * lengths.largest_extent;
}

}  // namespace

std::uint64_t most_exact_facets(const ResolvedAccuracy& lengths, const Accuracy& accuracy,
                                std::uint64_t facets) {
  constexpr std::uint64_t kFew = 1024;
  if (accuracy.is_exact() || accuracy.is_for_volume() || accuracy.merges_neighbours()) return 0;
  if (accuracy.facets > 0) return accuracy.facets;
  return lengths.width > 0.0 && facets <= kFew ? facets : 0;
}

std::optional<std::uint64_t> simplices_of_exact(const Hull& hull, bool may_be_few, const HullOptions& options,
                                                const ResolvedAccuracy& lengths) {
  constexpr std::uint64_t kTimesMore = 4, kSmall = 100'000;
  constexpr double kRounding = 4.0;
  const Accuracy& accuracy = options.accuracy;
  if (hull.status != HullStatus::kComplete || accuracy.is_exact() || accuracy.is_for_volume()) return {};
  if (is_missed(lengths, hull.max_facet_width)) return options.limits.max_facets;
  if (!may_be_few || options.limits.max_memory_bytes > 0 || options.limits.max_facets > 0) return {};
  // It is the best there can be already.
  if (hull.facet_count() == hull.rank + 1) return {};
  if (accuracy.facets > 0 && hull.max_facet_width <= kRounding * hull.roundoff) return {};
  return kSmall + kTimesMore * hull.simplex_count();
}

bool is_exact_better(const Hull& exact, const Hull& hull, const Accuracy& accuracy,
                     const ResolvedAccuracy& lengths) {
  if (exact.status != HullStatus::kComplete) return false;
  if (accuracy.facets > 0 && exact.facet_count() > accuracy.facets) return false;
  const bool keep_width =
      lengths.width > 0.0 && std::max(exact.max_facet_width, hull.max_facet_width) <= lengths.width;
  if (keep_width && exact.facet_count() != hull.facet_count())
    return exact.facet_count() < hull.facet_count();
  return exact.max_facet_width < hull.max_facet_width;
}

}  // namespace ndhull
