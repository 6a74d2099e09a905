// Runs in place of one that did not come out as it should: from the beginning, with other options.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "approx/hull_run.h"
#include "core/machine/block_store.h"

namespace ndhull {

/// From the beginning.
Hull HullBuilder::again(const HullOptions& options, EarlierRun earlier) {
  growth_.reset();
  if (options.limits.max_memory_bytes > 0) give_back_free_pages();
  std::unique_ptr<WholeFacetSearch> search;
  if (options.accuracy.is_exact()) search = std::move(whole_facets_);  // of the same frame
  return HullBuilder(points_, options, start_, input_bytes_, earlier, std::move(search)).run();
}

/// The exact hull if it has no more facets than are asked for, or joined to that if they were found whole; else
/// what was asked for.
Hull HullBuilder::exact_first(const ResolvedAccuracy& lengths) {
  constexpr std::uint64_t kMostSimplices = 1'000'000;  // a second or two
  const bool may_join = options_.accuracy.effort == Effort::kQuick;
  Hull exact = with(Accuracy(), lengths, kMostSimplices, may_join ? options_.accuracy.facets : 0);
  const bool is_few = exact.facet_count() <= options_.accuracy.facets;
  if (exact.status == HullStatus::kComplete && is_few) return exact;
  return again(options_, {.has_run_out = earlier_.has_run_out, .has_tried_exact = true});
}

/// Less than what was asked for, which is what the report compares widths with.
Hull HullBuilder::with(const Accuracy& accuracy, const ResolvedAccuracy& lengths, std::uint64_t max_facets,
                       std::uint64_t joined_to) {
  HullOptions options = options_;
  options.accuracy = accuracy;
  options.limits.max_facets = max_facets;
  const bool limits_work = options.limits.max_facets != options_.limits.max_facets;
  Hull hull = again(options, {.limits_work = limits_work, .facets = joined_to});
  hull.chosen.width_asked = lengths.width_asked();
  return hull;
}

/// So few of the exact hull's planes bound no region; others do.
Hull HullBuilder::for_width_instead() {
  HullOptions options = options_;
  options.accuracy.objective = FacetObjective::kWidth;
  return again(options, earlier_);
}

/// Has a limit ended growth for a width, and are there facets far wider than points are outside? Points are far
/// above some simplices then, which slabs may hold. Where memory has ended growth, it all went into simplices.
bool HullBuilder::is_wide_for(double height, const ResolvedAccuracy& lengths) const {
  constexpr double kTimesAsWide = 2.0, kTimesAsLong = 4.0, kTimesAsWideInTime = 1.5, kShareLeft = 0.25;
  if (lengths.width <= 0.0 || options_.accuracy.facets > 0 || height <= 0.0 || options_.stop.stop_requested())
    return false;
  const double width = hull_.max_facet_width, left = growth_->seconds_left();
  if (hull_.status == HullStatus::kTimeLimit)
    return width > std::max(lengths.width, kTimesAsWideInTime * height) &&
           left > std::max(1.0, kShareLeft * options_.limits.max_seconds);
  return hull_.status == HullStatus::kMemoryLimit && !hull_.is_approximate &&
         width > std::max(lengths.width, kTimesAsWide * height) &&
         left > kTimesAsLong * seconds_since(start_);
}

/// Slabs as narrow as there is memory or time for, in place of what the limit has left. Where points are far
/// above simplices more facets are hardly narrower (wine, of 11-d points).
Hull HullBuilder::narrow_instead(const ResolvedAccuracy& lengths) {
  constexpr std::uint64_t kFacets = 500,
                          kMostBeside = 2'000'000;  // simplices that another hull has room beside
  const HullStatus status = hull_.status;
  std::optional<Hull> before;
  if (status == HullStatus::kTimeLimit && hull_.simplex_count() <= kMostBeside) before = std::move(hull_);
  hull_ = Hull();
  HullOptions options = options_;
  options.accuracy.width = Length();
  options.accuracy.facets = kFacets;
  if (options.limits.max_seconds > 0.0) {  // the search has what is left for all of its time
    options.limits.max_seconds = growth_->seconds_left();
    start_ = Clock::now();
  }
  whole_facets_.reset();
  Hull hull = again(options, {.has_tried_exact = true});
  if (before && before->max_facet_width <= hull.max_facet_width) return std::move(*before);
  hull.chosen.width_asked = lengths.width_asked();
  if (hull.status == HullStatus::kComplete) hull.status = status;
  return hull;
}

Hull HullBuilder::with_larger_shift() {
  HullOptions options = options_;
  options.shift *= 10.0;
  return again(options, earlier_);
}

}  // namespace ndhull
