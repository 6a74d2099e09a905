#include "approx/trade/count_approximation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "approx/facets/exact_facets.h"
#include "approx/trade/count_limits.h"

namespace ndhull {
namespace {

constexpr int kMostRounds = 24;
/// Turns in which the narrowest facets are balanced.
constexpr std::uint64_t kMostTurns = 24;
/// Simplices that are worth growing for a target number, whatever is outside.
constexpr std::uint64_t kWorthGrowing = 250'000;
/// Simplices for each facet of a target number, at first and at most.
constexpr std::uint64_t kSimplicesPerFacetFirst = 16, kSimplicesPerFacet = 96;
/// One in so many is grown beyond that for slabs as thin as they are thought to become.
constexpr std::uint64_t kFewMore = 8;
/// Part of the width that points left out may be outside without growth going on to most_worth_growing,
/// and where slabs turned out narrower than growth was meant for.
constexpr double kNearSlab = 0.75, kTooNearSlab = 0.85;
/// Growth goes on where slabs turn out narrower than this part of what it was meant for.
constexpr double kCoarse = 0.75;
/// Simplices of a hull that takes hardly any time to be grown to the end.
constexpr std::uint64_t kSmallHull = 50'000;
/// By how much the logarithm of the number may fall short: while the hull goes on growing, and before facets
/// are balanced, of coverings that take long and of others.
constexpr double kSlackWhileGrowing = 0.2, kSlackOfLong = 0.1, kSlackBeforeBalance = 0.05;
/// The same for a first width, and the least part of it that is left without the points left out.
constexpr double kRoughly = 0.5, kLeastOfGuess = 0.4;
/// Part of their width that slabs have when they are balanced, about.
constexpr double kBalanced = 0.8;
/// Simplices from which on coverings that overlap take long.
constexpr std::uint64_t kTakesLong = 100'000;
/// Of facets that hold so many simplices it is worth choosing among slabs that overlap.
constexpr std::uint64_t kLarge = 400;
/// A first width, in parts of how far outside the furthest point is, and at least of the extent.
constexpr double kAboveFurthest = 1.1, kFirstWidth = 0.1;

}  // namespace

CountApproximation::CountApproximation(const ApproximationTask& task)
    : Approximation(task), count_(task.accuracy.facets), has_tried_exact_(task.earlier.has_tried_exact) {
  finds_determinants_ = false;
}

ApproximateFacets CountApproximation::run() {
  ApproximateFacets found;
  const double seconds_at_first = growth_.seconds_left();
  SlabGuess guess = is_outside_width_given() ? SlabGuess{} : guess_slab();
  found.wants_exact_first = !is_outside_width_given() && may_be_few_exact_facets();
  if (found.wants_exact_first) return found;
  foresee_coverings(seconds_at_first);
  begin_growth(guess);
  if (growth_.is_found_otherwise()) return found;
  if (is_whole() && count_exact_facets(growth_.work(), growth_.coordinates()) <= count_) return found;
  const bool is_short_of_memory = keep_within_memory();
  search_.narrowest = Covering{};  // of the coarse hull
  if (!is_outside_width_given()) search_held(guess.coarse, true);
  if (!search_.has_any()) search_slabs(guess.slab);
  hull_.chosen.outside_width = outside_width_;
  make_space(true);
  probe_widths();
  balance_facets(Covering(search_.narrowest), search_.slab, kMostTurns);
  take_in_widening();
  if (is_thorough()) look_for_narrower();
  hull_.chosen.slab_width = search_.slab;
  found.clusters = facets_of(search_.narrowest);
  if (is_short_of_memory && hull_.status == HullStatus::kComplete) hull_.status = HullStatus::kMemoryLimit;
  return found;
}

/// Asks for fewer facets where memory is too short for as many as were asked for. True: it is.
bool CountApproximation::keep_within_memory() {
  const auto most = std::max<std::uint64_t>(frame_.rank + 1, growth_.most_facets());
  if (count_ <= most) return false;
  count_ = most;
  return true;
}

/// Of a coarse hull: is it worth its time to grow the exact one before anything else is looked for?
bool CountApproximation::may_be_few_exact_facets() {
  return growth_.furthest_height() > 0.0 && !growth_.is_limited() && !has_tried_exact_ &&
         !growth_.options().limits.has_any() && is_degenerate() &&
         may_be_few_facets(growth_.work(), growth_.coordinates(), count_);
}

/// Is the hull the exact one? Nothing that was left out is outside by more than rounding.
bool CountApproximation::is_whole() {
  return growth_.furthest_height() == 0.0 && !growth_.is_limited() &&
         hull_.max_outside_gauge <= 4.0 * growth_.work().options.shift;
}

/// From a coarse hull. Its slabs hold the points left out as well: those of the hull that is wanted are
/// thinner by about their height.
CountApproximation::SlabGuess CountApproximation::guess_slab() {
  const std::uint64_t rows = std::max<std::uint64_t>(20'000, kSimplicesPerFacetFirst * count_);
  if (growth_.grow_to(0.0, rows, HUGE_VAL) || growth_.is_limited()) return {};
  make_space(false);
  const double start =
      std::max(kFirstWidth * lengths_.largest_extent, kAboveFurthest * growth_.furthest_height());
  if (cover_count(kPlainCover, start, kRoughly).planes.empty()) return {start, start};
  const double coarse = hull_.chosen.slab_width;
  return {coarse, std::max(coarse - growth_.furthest_height(), kLeastOfGuess * coarse)};
}

/// With a time limit: growth ends where the coverings that follow would take longer than what is left, by
/// what those of the coarse hull took.
void CountApproximation::foresee_coverings(double seconds_at_first) {
  constexpr double kCoverings = 12.0;  // and what looks at their facets
  const double left = growth_.seconds_left();
  if (left == HUGE_VAL || search_.covered == 0) return;
  const double seconds_per_simplex = (seconds_at_first - left) / static_cast<double>(search_.covered);
  const double rows = std::max(0.0, left) / (kCoverings * seconds_per_simplex);
  affordable_rows_ = std::max<std::uint64_t>(live_count(), static_cast<std::uint64_t>(std::min(rows, 1e18)));
}

/// Growth for slabs that are only guessed so far, which may become clearer on the way.
void CountApproximation::begin_growth(SlabGuess& guess) {
  outside_width_ = is_outside_width_given() ? lengths_.outside_width
                                            : kShareForGrowth * (is_thorough() ? guess.slab : guess.coarse);
  if (guess.coarse == 0.0)
    guess.coarse = guess.slab = std::max(kFirstWidth * lengths_.largest_extent, 2.0 * outside_width_);
  grow(guess);
  // Slabs that do not hold the points left out take long to be found.
  if (hull_.status == HullStatus::kTimeLimit)
    guess.slab = std::max(guess.slab, kAboveFurthest * growth_.furthest_height());
  // A few facets that share all points, as a grid's, are found when all points are in.
  const bool may_grow_whole = !is_outside_width_given() && !growth_.is_limited() && !is_whole();
  if (may_grow_whole && live_count() <= kSmallHull && is_degenerate()) {
    outside_width_ = 0.0;
    take_in_outside(outside_width_);
    grow(guess);
  }
}

/// Growth for so many facets.
void CountApproximation::grow(const SlabGuess& guess) {
  const std::uint64_t most = std::min(std::max(kWorthGrowing, kSimplicesPerFacet * count_), affordable_rows_);
  const std::uint64_t most_far = std::min(most_worth_growing(count_), affordable_rows_);
  const auto has_paused = [&](std::uint64_t enough, double height) {
    return !growth_.grow_to(outside_width_, enough, height) && !growth_.is_limited();
  };
  const auto are_far = [&](double slab) { return growth_.furthest_height() > kNearSlab * slab; };
  bool is_paused = !growth_.is_limited() && has_paused(is_outside_width_given() ? 0 : most, HUGE_VAL);
  if (is_paused && are_far(guess.slab) && !growth_.is_late())
    is_paused = has_paused(std::min(most + most / kFewMore, affordable_rows_), HUGE_VAL);
  const double slab = is_thorough() ? guess.slab : guess.coarse;
  for (std::uint64_t enough = most; is_paused && enough < most_far && are_far(slab) && !growth_.is_late();) {
    enough += kWorthGrowing / 4;
    is_paused = has_paused(enough, HUGE_VAL);
  }
  // What is further outside makes facets wider, whatever the slabs.
  const std::uint64_t most_further = std::min(most_where_far(count_), affordable_rows_);
  const auto are_further = [&] { return growth_.furthest_height() > guess.coarse; };
  for (std::uint64_t enough = most; is_paused && live_count() < most_further && are_further();) {
    enough = std::min(most_further, std::max(enough, live_count()) + kWorthGrowing / 4);
    is_paused = has_paused(enough, HUGE_VAL);
  }
  locate_left_out(outside_width_);
}

/// Is it worth growing further for slabs that turned out so narrow?
bool CountApproximation::is_coarse_for(double slab) {
  const double height = growth_.furthest_height();
  if (height == 0.0)  // it had ended
    return outside_width_ > flat() && kShareForGrowth * slab < kCoarse * outside_width_;
  return height > kTooNearSlab * slab &&
         live_count() < std::min(most_worth_growing(count_), affordable_rows_);
}

/// Slabs of the least width, from a first one on, while the hull grows for what they turn out to be, and once
/// more with more effort.
///
/// A simplex with a point left out too far above it is too wide alone, whatever the slabs are: such points are
/// taken in, in rounds, as for a target width. Each round starts from the slabs of the one before it.
void CountApproximation::search_slabs(double width) {
  CoverEffort effort = kPlainCover;
  bool is_better_search = false, is_from_wide = false;
  for (int round = 1; !search_.has_any() || !growth_.is_late(); ++round) {
    make_space(true);
    const bool takes_long = effort.choices > 1 && live_count() > kTakesLong;
    const double slack = !is_better_search ? kSlackWhileGrowing
                         : takes_long      ? kSlackOfLong
                                           : kSlackBeforeBalance;
    const Covering covering = cover_count(effort, width, slack);
    if (covering.planes.empty()) {
      if (search_.has_any() || is_from_wide) return;
      width = std::max(width, kFirstWidth * lengths_.largest_extent);
      is_from_wide = true;
      continue;
    }
    width = hull_.chosen.slab_width;
    const bool is_enough = search_.covered > most_covered(count_) || round == kMostRounds;
    const bool is_settled = take_in_offenders(covering, width, !is_enough);
    if (!is_settled && !is_enough) continue;
    if (is_enough || is_better_search || width <= flat()) return;
    is_better_search = true;
    const double more = static_cast<double>(count_) / static_cast<double>(covering.planes.size());
    if (live_count() > kMostProbed && live_count() < kLarge * count_) {
      if (std::log(more) < kSlackBeforeBalance) return;
    } else {
      effort = kHarderCover;  // it needs fewer facets: a smaller width will do
      width *= 0.97;
    }
    width *= std::pow(more, -1.0 / search_.power);
  }
}

/// Takes in what makes the facets of a covering by slabs of this width wider, and grows on where the slabs
/// turned out narrower than growth was meant for. True: nothing has changed, or would.
bool CountApproximation::take_in_offenders(const Covering& covering, double slab, bool may_grow) {
  const TrueWidths widths = true_widths(covering);
  const std::size_t known = extra_.size();
  const Offenders offenders = add_offenders(covering, widths, std::max(slab, flat()));
  may_grow = may_grow && !growth_.is_limited() && !growth_.is_late();
  const double meant = kBalanced * slab;
  const bool is_coarse = may_grow && !is_outside_width_given() && is_coarse_for(meant);
  const GrowthWork& work = growth_.work();
  const std::uint64_t insertions = work.counters.insertions, rows = work.complex.row_count;
  if (is_coarse && growth_.furthest_height() == 0.0) {
    outside_width_ = growth_.work().options.outside_width = kShareForGrowth * meant;
    growth_.repair();
  }
  if (is_coarse || (may_grow && !offenders.above_simplices.empty())) {
    growth_.put_back(offenders.above_simplices);
    grow({slab, slab});
  }
  // An insertion that was taken back may leave rows too.
  if (work.counters.insertions > insertions || work.complex.row_count > rows) {
    search_.narrowest = Covering{};
    return false;
  }
  return widths.widest() <= std::max(1.002 * slab, flat()) || extra_.size() == known;
}

}  // namespace ndhull
