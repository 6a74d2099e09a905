// Slabs of the least width that needs no more facets than are wanted: the part of
// approx/trade/count_approximation.h that covers a hull as it is.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "approx/trade/count_approximation.h"
#include "approx/trade/count_limits.h"
#include "approx/trade/region_closing.h"

namespace ndhull {
namespace {

constexpr int kMostCoverings = 16, kMostCoveringsLate = 4;
/// A covering is given up when it would have so many times the facets that are wanted: one by slabs that are
/// far too thin takes seconds where points are left out far above them.
constexpr std::uint64_t kFarTooMany = 8;
/// Further off than this a step of the width goes beyond what the number asks for.
constexpr double kFar = 0.4;
/// Logarithms of widths as near each other say little about the power: the number scatters.
constexpr double kTellsPower = 0.03;
/// Part of the width that points left out may be outside for disjoint slabs.
constexpr double kFarAbove = 0.65;

/// Which width to try next for a number of facets. The number falls like a power of the width, about the
/// (rank-1)/2-th where the hull is round; what it was last is remembered. Where it falls off a cliff (answers
/// 1 to 5: 346 below width 1, 38 above) steps are halved. What is hardly more than a hull has to have says
/// nothing about the width: steps are long then.
class WidthSteps {
 public:
  struct Trial {
    double log_width = 0.0, log_count = 0.0;
    bool is_made = true;
  };

  /// `slack`: so much less than the number is as good [logarithm].
  WidthSteps(double count, double slack, double power_of_ball, double power)
      : wanted_(std::log(count)), slack_(slack), power_of_ball_(power_of_ball), power_(power) {}

  void note(const Trial& trial, bool are_few) {
    if (last_.is_made && std::abs(trial.log_width - last_.log_width) > kTellsPower &&
        trial.log_count != last_.log_count) {
      const double power = (last_.log_count - trial.log_count) / (trial.log_width - last_.log_width);
      power_ = std::clamp(power, 0.5 * power_of_ball_, 2.0 * power_of_ball_);
    }
    last_ = trial;
    if (are_few) {
      if (!few_.is_made || trial.log_width < few_.log_width) few_ = trial;
    } else {
      if (!many_.is_made || trial.log_width > many_.log_width) many_ = trial;
    }
  }

  double power() const { return power_; }
  /// How far the narrowest that needs no more facets than are wanted is below the number [logarithm].
  double short_of() const { return wanted_ - few_.log_count; }

  /// To the next width; false: what was tried is as near as it gets. `are_fewest`: of the best so far.
  bool step(bool are_fewest, double log_flat, double& log_width) const {
    constexpr double kStepOfFewest = 0.3;
    const double least_step = slack_ / power_of_ball_;
    if (few_.is_made && many_.is_made) {
      const double between = few_.log_width - many_.log_width;
      const double fewer = std::max(1e-9, many_.log_count - few_.log_count);
      const bool is_cliff = fewer > std::max(1.0, 3.0 * power_of_ball_ * between);
      if (between < (is_cliff ? 0.01 : 0.004)) return false;
      const double part = is_cliff ? 0.5 : (many_.log_count - wanted_ + 0.5 * slack_) / fewer;
      log_width = many_.log_width + std::clamp(part, 0.08, 0.92) * between;
    } else if (few_.is_made) {
      const double one = (short_of() > kFar ? 1.2 * short_of() : short_of() - 0.5 * slack_) / power_;
      log_width -= std::max(one, are_fewest ? kStepOfFewest : least_step);
      if (few_.log_width > log_flat) log_width = std::max(log_width, log_flat);
    } else {
      const double beyond = many_.log_count - wanted_;
      log_width += std::max(least_step, (beyond > kFar ? 1.2 * beyond : beyond + 0.5 * slack_) / power_);
    }
    return true;
  }

 private:
  double wanted_, slack_, power_of_ball_, power_;
  // Nearest with at most, with more than the count; the last one.
  Trial few_{.is_made = false}, many_{.is_made = false}, last_{.is_made = false};
};

}  // namespace

/// Is it worth its time to join neighbours that fit into one slab? Of few facets, and of degenerate data:
/// there slabs start from planes that rounding has drawn, and two may share what one could hold.
bool CountApproximation::is_worth_joining() const {
  return count_ <= kFewFacets || has_few_small(count_, live_count()) || is_degenerate();
}

/// Facets whose planes bound a region, and fewer where two fit into one slab.
void CountApproximation::close_and_join(Covering& covering, double width, bool joins) const {
  close_open_directions(growth_.work().complex, *space_, growth_.coordinates(), nullptr, covering);
  if (joins) join_neighbours(covering, width);
}

/// Slabs of a width: disjoint ones where these are found, which takes a fraction of the time; not where
/// points are far above many simplices, since each plane would have to be turned, unless time is short.
CountApproximation::TriedWidth CountApproximation::try_width(const CoverEffort& effort, double width,
                                                             std::optional<SlabCover>& overlapping) {
  const bool joins = is_worth_joining();
  std::optional<DualFacets> slabs;
  PartitionTask task{.most_facets = kFarTooMany * count_};
  const bool are_far_above = growth_.furthest_height() > kFarAbove * width;
  if (effort.choices == 1 && (!are_far_above || search_.is_cut_short)) slabs = find_single_slabs(width, task);
  if (task.has_too_many()) return {static_cast<std::size_t>(task.expected_facets), {}};
  if (slabs) join_small_slabs(width, *slabs);
  if (slabs) search_.covered += live_count() / kDisjointQuicker;
  if (slabs && slabs->count() > (joins ? 2 * count_ : count_)) return {slabs->count(), {}};
  if (!slabs && !overlapping) overlapping.emplace(growth_.work().complex, *space_, is_convex());
  const WorkEnd end = growth_.end_of_merging();
  Covering covering =
      slabs ? covering_of(*slabs, *space_) : overlapping->cover(width, effort, task.most_facets, end);
  if (covering.planes.empty()) {
    search_.is_cut_short |= end.is_here();
    return {std::max(static_cast<std::size_t>(overlapping->expected_facets()), count_ + 1), {}};
  }
  if (!slabs) search_.covered += live_count();
  if (covering.planes.size() <= 2 * count_) close_and_join(covering, width, joins);
  return {covering.planes.size(), std::move(covering)};
}

/// The covering by the narrowest slabs found that needs at most that number of facets, and hardly less;
/// chosen.slab_width is theirs. No planes: there is none.
Covering CountApproximation::cover_count(const CoverEffort& effort, double start_width, double slack) {
  const std::size_t fewest = space_->rank() + space_->rank() / 2 + 1;
  std::optional<SlabCover> overlapping;
  const double power_of_ball = 0.5 * (static_cast<double>(space_->rank()) - 1.0);
  if (search_.power == 0.0) search_.power = power_of_ball;
  WidthSteps steps(static_cast<double>(count_), slack, power_of_ball, search_.power);
  Covering best;
  double best_width = 0.0, log_width = std::log(start_width);
  for (int trial = 0; trial < kMostCoverings; ++trial) {
    const bool is_enough = growth_.is_late() || search_.covered > most_covered(count_);
    if (is_enough && (!best.planes.empty() || trial >= kMostCoveringsLate)) break;
    const double width = std::exp(log_width);
    TriedWidth found = try_width(effort, width, overlapping);
    const bool are_few = found.facets <= count_;
    steps.note({log_width, std::log(static_cast<double>(found.facets))}, are_few);
    search_.power = steps.power();
    const bool is_hull = are_few && keeps_hull(found.covering);
    if (is_hull) consider(found.covering, width);
    if (is_hull && (best.planes.empty() || width < best_width)) {
      best = std::move(found.covering);
      best_width = width;
    }
    const bool are_fewest = best.planes.size() <= fewest && fewest < count_;
    if (is_hull && (width <= flat() || (!are_fewest && steps.short_of() < slack))) break;
    if (!steps.step(are_fewest, std::log(flat()), log_width)) break;
  }
  hull_.chosen.slab_width = best_width;
  return best;
}

}  // namespace ndhull
