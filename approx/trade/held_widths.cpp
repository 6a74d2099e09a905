// A number of facets where growth leaves out points that are far above simplices: the part of
// approx/trade/count_approximation.h that then looks for the width.
//
// Idea. How many facets slabs of a width leave says little there: most may be simplices that are too wide
// alone, and taking in what is above these changes the number by any factor. So a width is held until growth
// has taken in all that makes facets wider, as for a target width; what their number is then decides whether
// a smaller or a larger one is tried.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "approx/trade/count_approximation.h"
#include "approx/trade/count_limits.h"

namespace ndhull {
namespace {

/// Simplices that are worth growing, and what the first widths may have of them, and each after it more.
constexpr std::uint64_t kMostHeld = 2'500'000, kGrownAtOnce = 62'500;
constexpr double kShareAtFirst = 0.5, kShareMore = 0.125;
/// Points are left out far where one is so far outside, in parts of a width, and facets far too wide.
constexpr double kFarOutside = 0.5, kFarTooWide = 1.25;
/// Widths that are tried, and rounds of growth for each.
constexpr int kWidths = 10, kHoldRounds = 12;
/// So much of the number is near enough, since balancing splits facets, and so near widths.
constexpr double kNearlyCount = 0.7, kNearWidths = 1.01;
/// The number falls with a larger power of the width than of balls, since points are left out. Steps of the
/// logarithm of the width: the shortest, longer with each; the longest; after one that could not be held.
constexpr double kSteep = 1.5, kShortestStep = 0.02, kLongestStep = 0.25, kStepWhereNotHeld = 0.12;

}  // namespace

/// Is there room and time for growth to go on? A part of the room is left for the widths after the first.
bool CountApproximation::may_grow_held(double share) {
  const double most = share * static_cast<double>(std::min(kMostHeld, affordable_rows_));
  return !growth_.is_limited() && !growth_.is_late() && search_.covered <= most_covered(count_) &&
         static_cast<double>(live_count()) < most;
}

/// Facets no wider than this over all points. No planes: growth would have to go on further than it may.
/// Nothing: `only_if_far`, and no simplex alone is much wider than the slabs.
std::optional<Covering> CountApproximation::hold_width(double width, double share, bool only_if_far) {
  for (int round = 0;; ++round) {
    make_space(true);
    const bool may_grow = may_grow_held(share) && round < kHoldRounds;
    std::optional<DualFacets> slabs = find_disjoint_slabs(width);
    search_.covered += live_count() / (slabs ? kDisjointQuicker : 1);
    const bool is_asked = only_if_far && round == 0;
    if (is_asked && (!slabs || slabs->unfit.empty())) return std::nullopt;
    Covering covering = slabs ? covering_of(*slabs, *space_)
                              : SlabCover(growth_.work().complex, *space_, is_convex())
                                    .cover(width, CoverEffort{.final_fit_steps = 0});
    if (is_asked && true_widths(covering).widest() <= kFarTooWide * width) return std::nullopt;
    close_and_join(covering, width, false);
    const TrueWidths widths = true_widths(covering);
    if (widths.widest() <= width) return covering;
    const std::vector<LocatedPoint> above = add_offenders(covering, widths, width).above_simplices;
    if (!may_grow || above.empty()) return Covering{};
    search_.narrowest = Covering{};
    growth_.put_back(above);
    while (growth_.furthest_height() > width && may_grow_held(share))
      if (growth_.grow_to(outside_width_, live_count() + kGrownAtOnce, HUGE_VAL)) break;
    locate_left_out(outside_width_);
  }
}

/// The least width held by at most that number of facets, about, from a first one on. Leaves the narrowest.
/// `only_if_far`: nothing is looked for where no point is so far above a simplex that this is much wider alone
/// than slabs of the first width.
void CountApproximation::search_held(double first_width, bool only_if_far) {
  if (only_if_far && (growth_.is_limited() || growth_.furthest_height() < kFarOutside * first_width)) return;
  const double wanted = std::log(static_cast<double>(count_));
  double power = kSteep * 0.5 * (static_cast<double>(growth_.work().rank) - 1.0);
  struct Held {
    double log_width, log_count;
  };
  std::optional<Held> few, many;
  double log_width = std::log(first_width), share = kShareAtFirst;
  for (int trial = 0; trial < kWidths && !growth_.is_late(); ++trial) {
    const double width = std::exp(log_width);
    std::optional<Covering> held = hold_width(width, share, only_if_far && trial == 0);
    if (!held) return;
    Covering& covering = *held;
    share = std::min(1.0, share + kShareMore);
    if (covering.planes.size() > count_ && covering.planes.size() <= 2 * count_ && is_worth_joining())
      join_neighbours(covering, width);
    const std::size_t facets = covering.planes.size();
    if (covering.planes.empty()) {  // as if they were too many
      many = Held{log_width, wanted + kStepWhereNotHeld * power};
    } else {
      (facets <= count_ ? few : many) = Held{log_width, std::log(static_cast<double>(facets))};
      if (facets <= count_ && keeps_hull(covering)) consider(covering, width);
      if (facets <= count_ && (few->log_count > wanted + std::log(kNearlyCount) || !may_grow_held(share)))
        return;
    }
    if (few && many) {
      const double between = few->log_width - many->log_width;
      if (between < std::log(kNearWidths)) return;
      power = std::max(power, (many->log_count - few->log_count) / between);
      const double part = (many->log_count - wanted) / (many->log_count - few->log_count);
      log_width = many->log_width + std::clamp(part, 0.2, 0.8) * between;
    } else {
      const double beyond = (few ? few->log_count : many->log_count) - wanted;
      const double step = std::clamp(std::abs(beyond) / power, kShortestStep * (trial + 1), kLongestStep);
      log_width += few ? -step : step;
    }
  }
}

}  // namespace ndhull
