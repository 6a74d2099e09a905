// A target number of facets: the part of approx/trade/approximation.h that looks for the least width.
#include <algorithm>
#include <array>
#include <cmath>

#include "approx/facets/exact_facets.h"
#include "approx/trade/approximation.h"
#include "approx/trade/count_limits.h"
#include "approx/trade/facet_balance.h"
#include "approx/trade/region_closing.h"

namespace ndhull {
namespace {

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
constexpr int kMostRounds = 24, kMostCoverings = 16, kMostCoveringsLate = 4;
/// A covering is given up when it would have so many times the facets that are wanted: one by slabs that are
/// far too thin takes seconds where points are left out far above them.
constexpr std::uint64_t kFarTooMany = 8;
/// Simplices of a hull that takes hardly any time to be grown to the end.
constexpr std::uint64_t kSmallHull = 50'000;
/// Coverings of the search, and what takes off the last tenth.
constexpr CoverEffort kPlain{.final_fit_steps = 0};
constexpr CoverEffort kHarder{.choices = 2, .refits = 2};
/// By how much the logarithm of the number may fall short: while the hull goes on growing, and before facets
/// are balanced, of coverings that take long and of others.
constexpr double kSlackWhileGrowing = 0.2, kSlackOfLong = 0.1, kSlackBeforeBalance = 0.05;
/// Further off than this a step of the width goes beyond what the number asks for.
constexpr double kFar = 0.4;
constexpr double kAboveFurthest = 1.1;  // a first width, in parts of how far outside the furthest point is
/// The same for a first width, and the least part of it that is left without the points left out.
constexpr double kRoughly = 0.5, kLeastOfGuess = 0.4;
/// Steps of the width that are tried about the narrowest found, in vain each, and turns that balance what
/// they find; simplices that they meet. Where facets hold hundreds of simplices they find hardly anything.
constexpr double kProbeStep = 0.95;
constexpr int kProbesThinner = 8, kProbesWider = 8;
constexpr std::uint64_t kProbeTurns = 8, kMostProbed = 90'000;
/// Part of their width that slabs have when they are balanced, about.
constexpr double kBalanced = 0.8;
/// Logarithms of widths as near each other say little about the power: the number scatters.
constexpr double kTellsPower = 0.03;
/// Part of the width that points left out may be outside for disjoint slabs.
constexpr double kFarAbove = 0.65;
/// Simplices from which on coverings that overlap take long.
constexpr std::uint64_t kTakesLong = 100'000;
/// Of facets that hold so many simplices it is worth choosing among slabs that overlap.
constexpr std::uint64_t kLarge = 400;
/// Facets are balanced until so many turns make them hardly narrower.
constexpr std::size_t kTurnsLookedBack = 5;
constexpr double kNarrower = 0.98, kNarrowerOfFew = 0.999;
constexpr std::uint64_t kMostTurns = 24;
/// Two facets are joined to split the widest when they fit into this part of its width, and less than this
/// part of the number is to spare.
constexpr double kClearlyNarrower = 0.97;
constexpr std::uint64_t kFewSpare = 32;
/// When fewer have joined it is some turns until pairs are tried again.
constexpr std::uint64_t kFewJoined = 128;

}  // namespace

/// Facets whose planes bound a region, and fewer where two fit into one slab.
void Approximation::close_and_join(Covering& covering, double width, bool joins) const {
  close_open_directions(growth_.work().complex, *space_, growth_.coordinates(), nullptr, covering);
  if (joins) join_neighbours(covering, width);
}

/// Slabs of a width: disjoint ones where these are found, which takes a fraction of the time; not where
/// points are far above many simplices, since each plane would have to be turned, unless time is short.
Approximation::CountTrial Approximation::try_width(std::uint64_t count, const CoverEffort& effort,
                                                   double width, std::optional<SlabCover>& overlapping,
                                                   CountSearch& search) {
  const bool joins = is_worth_joining(count, live_count());
  std::optional<DualFacets> slabs;
  FacetLimit limit{.most = kFarTooMany * count};
  const bool are_far_above = growth_.furthest_height() > kFarAbove * width;
  if (effort.choices == 1 && (!are_far_above || search.is_cut_short))
    slabs = find_disjoint_slabs(width, &limit);
  if (limit.is_exceeded()) return {static_cast<std::size_t>(limit.expected), {}};
  if (slabs) search.covered += live_count() / kDisjointQuicker;
  if (slabs && slabs->count() > (joins ? 2 * count : count)) return {slabs->count(), {}};
  if (!slabs && !overlapping) overlapping.emplace(growth_.work().complex, *space_, is_convex());
  const WorkEnd end = growth_.end_of_merging();
  Covering covering =
      slabs ? covering_of(*slabs, *space_) : overlapping->cover(width, effort, limit.most, end);
  if (covering.planes.empty()) {
    search.is_cut_short |= end.is_here();
    return {std::max(static_cast<std::size_t>(overlapping->expected_facets()), count + 1), {}};
  }
  if (!slabs) search.covered += live_count();
  if (covering.planes.size() <= 2 * count) close_and_join(covering, width, joins);
  return {covering.planes.size(), std::move(covering)};
}

/// The covering by the narrowest slabs found that needs at most `count` facets, and hardly less;
/// chosen.slab_width is theirs. No planes: there is none. The number falls like a power of the width, about
/// the (rank-1)/2-th where the hull is round; what it was last is remembered. Where it falls off a cliff
/// (answers 1 to 5: 346 below width 1, 38 above) steps are halved. What is hardly more than a hull has to have
/// says nothing about the width: steps are long then.
Covering Approximation::cover_count(std::uint64_t count, const CoverEffort& effort, double start_width,
                                    double slack, CountSearch& search) {
  constexpr double kStepOfFewest = 0.3;
  const std::size_t fewest = space_->rank() + space_->rank() / 2 + 1;
  std::optional<SlabCover> overlapping;
  const double power_of_ball = 0.5 * (static_cast<double>(space_->rank()) - 1.0);
  const double least_step = slack / power_of_ball;
  if (search.power == 0.0) search.power = power_of_ball;
  const double wanted = std::log(static_cast<double>(count));
  struct Trial {
    double log_width, log_count;
  };
  std::optional<Trial> few, many, last;  // few, many: nearest with at most, with more than the count
  Covering best;
  double best_width = 0.0, log_width = std::log(start_width);
  bool are_fewest = false;
  for (int trial = 0; trial < kMostCoverings; ++trial) {
    const bool is_enough = growth_.is_late() || search.covered > most_covered(count);
    if (is_enough && (!best.planes.empty() || trial >= kMostCoveringsLate)) break;
    const double width = std::exp(log_width);
    CountTrial found = try_width(count, effort, width, overlapping, search);
    const double log_count = std::log(static_cast<double>(found.facets));
    if (last && std::abs(log_width - last->log_width) > kTellsPower && log_count != last->log_count) {
      const double power = (last->log_count - log_count) / (log_width - last->log_width);
      search.power = std::clamp(power, 0.5 * power_of_ball, 2.0 * power_of_ball);
    }
    last = Trial{log_width, log_count};
    if (found.facets > count) {
      if (!many || log_width > many->log_width) many = Trial{log_width, log_count};
    } else {
      if (!few || log_width < few->log_width) few = Trial{log_width, log_count};
      const bool is_hull = keeps_hull(found.covering);
      if (is_hull) consider(found.covering, width, search);
      if (is_hull && (best.planes.empty() || width < best_width)) {
        best = std::move(found.covering);
        best_width = width;
      }
      are_fewest = best.planes.size() <= fewest && fewest < count;
      if (is_hull && (width <= flat() || (!are_fewest && wanted - few->log_count < slack))) break;
    }
    if (few && many) {
      const double between = few->log_width - many->log_width;
      const double fewer = std::max(1e-9, many->log_count - few->log_count);
      const bool is_cliff = fewer > std::max(1.0, 3.0 * power_of_ball * between);
      if (between < (is_cliff ? 0.01 : 0.004)) break;
      const double part = is_cliff ? 0.5 : (many->log_count - wanted + 0.5 * slack) / fewer;
      log_width = many->log_width + std::clamp(part, 0.08, 0.92) * between;
    } else if (few) {
      const double short_of = wanted - few->log_count;
      const double step = (short_of > kFar ? 1.2 * short_of : short_of - 0.5 * slack) / search.power;
      log_width -= std::max(step, are_fewest ? kStepOfFewest : least_step);
      if (few->log_width > std::log(flat())) log_width = std::max(log_width, std::log(flat()));
    } else {
      const double beyond = many->log_count - wanted;
      log_width += std::max(least_step, (beyond > kFar ? 1.2 * beyond : beyond + 0.5 * slack) / search.power);
    }
  }
  hull_.chosen.slab_width = best_width;
  return best;
}

/// Narrower facets, no more of them: simplices change facets and planes turn. Every other turn begins with
/// pairs of facets that fit into one clearly narrower than the widest, which leaves some to split the widest
/// with. True widths decide. Returns the turns taken.
std::uint64_t Approximation::balance_facets(std::uint64_t count, const Covering& start, double slab,
                                            std::uint64_t most_turns, CountSearch& search) {
  FacetBalance balance(growth_.work().complex, *space_, is_convex(), start);
  std::array<double, kTurnsLookedBack> before;  // widths
  before.fill(HUGE_VAL);
  double width = HUGE_VAL;
  std::uint64_t turn = 0, next_join = 0;
  for (; turn < most_turns && search.width > flat() && !growth_.is_late(); ++turn) {
    const std::size_t facets = balance.covering().planes.size();
    if (turn >= next_join && facets + count / kFewSpare >= count) {
      Covering joined = balance.covering();
      join_neighbours(joined, kClearlyNarrower * std::min(width, joined.widest));
      const std::size_t won = facets - joined.planes.size();
      if (won > 0) balance.set_joined(std::move(joined));
      next_join = turn + (won > count / kFewJoined ? 2 : 5);
    }
    // A part of what may be: where they are needed shows when the others have turned.
    const std::size_t spare = count - std::min(count, balance.covering().planes.size());
    balance.split_widest((spare + 2) / 3);
    balance.turn();
    Covering turned = balance.covering();
    if (!keeps_hull(turned)) close_and_join(turned, slab, false);  // others have taken what had closed it
    if (turned.planes.size() > count || !keeps_hull(turned)) break;
    width = std::min(width, consider(turned, slab, search));
    double& earlier = before[turn % kTurnsLookedBack];
    if (width > (live_count() > kMostProbed ? kNarrower : kNarrowerOfFew) * earlier) return turn + 1;
    earlier = width;
  }
  return turn;
}

/// Slabs of widths near those of the narrowest covering. The number of facets scatters where they hold few
/// simplices: thinner slabs may need no more, and wider ones may be narrower when they are fitted to the
/// points.
void Approximation::probe_widths(std::uint64_t count, CountSearch& search) {
  SlabCover cover(growth_.work().complex, *space_, is_convex());
  const bool joins = is_worth_joining(count, cover.live_count());
  std::uint64_t left = kMostProbed;
  const auto can_go_on = [&] {
    return left >= cover.live_count() && search.width > flat() && !growth_.is_late();
  };
  const auto try_covering = [&](const Covering& covering, double slab) {
    consider(covering, slab, search);
    const std::uint64_t turns = balance_facets(count, covering, slab, kProbeTurns, search);
    left -= std::min(left, turns * cover.live_count() / 4);  // a turn takes less time than a covering
  };
  const auto probe = [&](double width, const CoverEffort& effort) {
    left -= cover.live_count();
    Covering covering = cover.cover(width, effort);
    if (covering.planes.size() > 2 * count) return;
    close_and_join(covering, width, joins);
    if (covering.planes.size() <= count && keeps_hull(covering)) try_covering(covering, width);
  };
  // As few facets as a hull can have, which may be the narrowest of a search that ended early.
  const Covering fewest =
      cover_by_first_simplex(growth_.work().complex, *space_, frame_, growth_.coordinates());
  if (can_go_on()) {
    try_covering(fewest, 0.0);
  } else {
    consider(fewest, 0.0, search);
  }
  double start = search.width, width = start * std::sqrt(kProbeStep);
  for (int step = 0; step < kProbesThinner && can_go_on(); ++step, width *= kProbeStep) {
    probe(width, kHarder);
    if (can_go_on()) probe(width, kPlain);
    if (search.width > 0.999 * start) continue;
    start = search.width;
    width = start / std::sqrt(kProbeStep);
    step = -1;
  }
  width = start / std::sqrt(kProbeStep);
  for (int step = 0; step < kProbesWider && can_go_on(); ++step, width /= kProbeStep) probe(width, kHarder);
}

/// Growth for so many facets.
void Approximation::grow_for_count(std::uint64_t count, double outside_width, const SlabGuess& guess) {
  const std::uint64_t most = std::min(std::max(kWorthGrowing, kSimplicesPerFacet * count), affordable_rows_);
  const std::uint64_t most_far = std::min(most_worth_growing(count), affordable_rows_);
  const auto has_paused = [&](std::uint64_t enough, double height) {
    return !growth_.grow_to(outside_width, enough, height) && !growth_.is_limited();
  };
  const auto are_far = [&](double slab) { return growth_.furthest_height() > kNearSlab * slab; };
  bool is_paused = !growth_.is_limited() && has_paused(lengths_.outside_width > 0.0 ? 0 : most, HUGE_VAL);
  if (is_paused && are_far(guess.slab) && !growth_.is_late())
    is_paused = has_paused(std::min(most + most / kFewMore, affordable_rows_), HUGE_VAL);
  const double slab = is_thorough() ? guess.slab : guess.coarse;
  for (std::uint64_t enough = most; is_paused && enough < most_far && are_far(slab) && !growth_.is_late();) {
    enough += kWorthGrowing / 4;
    is_paused = has_paused(enough, HUGE_VAL);
  }
  // What is further outside makes facets wider, whatever the slabs.
  const std::uint64_t most_further = std::min(most_where_far(count), affordable_rows_);
  const auto are_further = [&] { return growth_.furthest_height() > guess.coarse; };
  for (std::uint64_t enough = most; is_paused && live_count() < most_further && are_further();) {
    enough = std::min(most_further, std::max(enough, live_count()) + kWorthGrowing / 4);
    is_paused = has_paused(enough, HUGE_VAL);
  }
  locate_left_out(outside_width);
}

/// Is it worth growing further for slabs that turned out so narrow?
bool Approximation::is_coarse_for(double slab, double outside_width) {
  const double height = growth_.furthest_height();
  if (height == 0.0)  // it had ended
    return outside_width > flat() && kShareForGrowth * slab < kCoarse * outside_width;
  return height > kTooNearSlab * slab &&
         live_count() < std::min(most_worth_growing(accuracy_.facets), affordable_rows_);
}

/// From a coarse hull. Its slabs hold the points left out as well: those of the hull that is wanted are
/// thinner by about their height.
Approximation::SlabGuess Approximation::guess_slab(std::uint64_t count, CountSearch& search) {
  const std::uint64_t rows = std::max<std::uint64_t>(20'000, kSimplicesPerFacetFirst * count);
  if (growth_.grow_to(0.0, rows, HUGE_VAL) || growth_.is_limited()) return {};
  make_space(false);
  const double start = std::max(0.1 * lengths_.largest_extent, kAboveFurthest * growth_.furthest_height());
  if (cover_count(count, kPlain, start, kRoughly, search).planes.empty()) return {start, start};
  const double coarse = hull_.chosen.slab_width;
  return {coarse, std::max(coarse - growth_.furthest_height(), kLeastOfGuess * coarse)};
}

/// With a time limit: growth ends where the coverings that follow would take longer than what is left, by
/// what those of the coarse hull took.
void Approximation::foresee_coverings(double seconds_at_first, const CountSearch& search) {
  constexpr double kCoverings = 12.0;  // and what looks at their facets
  const double left = growth_.seconds_left();
  if (left == HUGE_VAL || search.covered == 0) return;
  const double seconds_per_simplex = (seconds_at_first - left) / static_cast<double>(search.covered);
  const double rows = std::max(0.0, left) / (kCoverings * seconds_per_simplex);
  affordable_rows_ = std::max<std::uint64_t>(live_count(), static_cast<std::uint64_t>(std::min(rows, 1e18)));
}

// A simplex with a point left out too far above it is too wide alone, whatever the slabs are: such points are
// taken in, in rounds, as for a target width. Each round starts from the slabs of the one before it.
FacetClusters Approximation::run_count() {
  const std::uint64_t count = accuracy_.facets;
  const bool is_given = lengths_.outside_width > 0.0;
  CoverEffort effort = kPlain;
  CountSearch search;
  const double seconds_at_first = growth_.seconds_left();
  SlabGuess guess = is_given ? SlabGuess{} : guess_slab(count, search);
  wants_exact_first_ = !is_given && may_be_few_exact_facets();
  if (wants_exact_first_) return FacetClusters{};
  foresee_coverings(seconds_at_first, search);
  double outside_width =
      is_given ? lengths_.outside_width : kShareForGrowth * (is_thorough() ? guess.slab : guess.coarse);
  if (guess.coarse == 0.0)
    guess.coarse = guess.slab = std::max(0.1 * lengths_.largest_extent, 2.0 * outside_width);
  grow_for_count(count, outside_width, guess);
  // Slabs that do not hold the points left out take long to be found.
  if (hull_.status == HullStatus::kTimeLimit)
    guess.slab = std::max(guess.slab, kAboveFurthest * growth_.furthest_height());
  double width = guess.slab;
  // A few facets that share all points, as a grid's, are found when all points are in.
  if (!is_given && !is_whole() && is_degenerate() && live_count() <= kSmallHull && !growth_.is_limited()) {
    outside_width = 0.0;
    take_in_outside(outside_width);
    grow_for_count(count, outside_width, guess);
  }
  if (growth_.is_found_otherwise()) return FacetClusters{};
  if (is_whole() && count_exact_facets(growth_.work(), growth_.coordinates()) <= count)
    return FacetClusters{};       // the exact hull it is
  search.narrowest = Covering{};  // of the coarse hull
  bool is_better_search = false, is_from_wide = false;
  if (!is_given) search_held(count, guess.coarse, outside_width, true, search);
  const bool is_held = search.has_any();
  for (int round = 1; !is_held && (!search.has_any() || !growth_.is_late()); ++round) {
    make_space(true);
    const bool takes_long = effort.choices > 1 && live_count() > kTakesLong;
    const double slack = !is_better_search ? kSlackWhileGrowing
                         : takes_long      ? kSlackOfLong
                                           : kSlackBeforeBalance;
    const Covering covering = cover_count(count, effort, width, slack, search);
    if (covering.planes.empty()) {
      if (search.has_any() || is_from_wide) break;
      width = std::max(width, 0.1 * lengths_.largest_extent);
      is_from_wide = true;
      continue;
    }
    const double slab = hull_.chosen.slab_width;
    const TrueWidths widths = true_widths(covering);
    const std::size_t known = extra_.size();
    const Offenders offenders = add_offenders(covering, widths, std::max(slab, flat()));
    const bool is_enough = search.covered > most_covered(count) || round == kMostRounds;
    const bool may_grow = !growth_.is_limited() && !growth_.is_late() && !is_enough;
    const double meant = kBalanced * slab;
    const bool is_coarse = may_grow && !is_given && is_coarse_for(meant, outside_width);
    bool is_settled = widths.widest() <= std::max(1.002 * slab, flat()) || extra_.size() == known;
    width = slab;
    const GrowthWork& work = growth_.work();
    const std::uint64_t insertions = work.counters.insertions, rows = work.complex.row_count;
    if (is_coarse && growth_.furthest_height() == 0.0) {
      outside_width = growth_.work().options.outside_width = kShareForGrowth * meant;
      growth_.repair();
    }
    if (is_coarse || (may_grow && !offenders.above_simplices.empty())) {
      growth_.put_back(offenders.above_simplices);
      grow_for_count(count, outside_width, {slab, slab});
    }
    // An insertion that was taken back may leave rows too.
    if (work.counters.insertions > insertions || work.complex.row_count > rows) {
      search.narrowest = Covering{};
      is_settled = false;
    }
    if (!is_settled && !is_enough) continue;
    if (is_enough || is_better_search || slab <= flat()) break;
    is_better_search = true;
    const double more = static_cast<double>(count) / static_cast<double>(covering.planes.size());
    if (live_count() > kMostProbed && live_count() < kLarge * count) {
      if (std::log(more) < kSlackBeforeBalance) break;
    } else {
      effort = kHarder;  // it needs fewer facets: a smaller width will do
      width *= 0.97;
    }
    width *= std::pow(more, -1.0 / search.power);
  }
  hull_.chosen.outside_width = outside_width;
  make_space(true);
  probe_widths(count, search);
  const Covering start = search.narrowest;
  balance_facets(count, start, search.slab, kMostTurns, search);
  take_in_widening(count, outside_width, search);
  if (is_thorough()) look_for_narrower(count, search);
  hull_.chosen.slab_width = search.slab;
  return facets_of(search.narrowest);
}

}  // namespace ndhull
