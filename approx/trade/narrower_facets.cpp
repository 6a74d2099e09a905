// The narrowest facets found, made narrower: the part of approx/trade/count_approximation.h that comes after
// slabs of the least width.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "approx/trade/count_approximation.h"
#include "approx/trade/count_limits.h"
#include "approx/trade/facet_balance.h"
#include "approx/trade/region_closing.h"

namespace ndhull {
namespace {

/// Steps of the width that are tried about the narrowest found, in vain each, and turns that balance what
/// they find.
constexpr double kProbeStep = 0.95;
constexpr int kProbesThinner = 8, kProbesWider = 8;
constexpr std::uint64_t kProbeTurns = 8;
/// Facets are balanced until so many turns make them hardly narrower.
constexpr std::size_t kTurnsLookedBack = 5;
constexpr double kNarrower = 0.98, kNarrowerOfFew = 0.999;
/// Two facets are joined to split the widest when they fit into this part of its width, and less than this
/// part of the number is to spare.
constexpr double kClearlyNarrower = 0.97;
constexpr std::uint64_t kFewSpare = 32;
/// When fewer have joined it is some turns until pairs are tried again.
constexpr std::uint64_t kFewJoined = 128;
/// Widths that are looked into for a number of facets; how much narrower one has to be at least, and up to
/// which part of the number it is not enough.
constexpr int kMostWidths = 8, kMostInVain = 2;
constexpr double kLeastNarrower = 0.004, kNearlyAll = 0.995;
/// Logarithms of widths as near each other say nothing of the power.
constexpr double kTellsOfPower = 0.02;

}  // namespace

/// Remembers the narrowest over all points. Returns how wide it is.
double CountApproximation::consider(const Covering& covering, double slab) {
  const double width = true_widths(covering).widest();
  if (search_.has_any() && width >= search_.width) return width;
  search_.narrowest = covering;
  search_.width = width;
  search_.slab = slab;
  return width;
}

/// Narrower facets, no more of them: simplices change facets and planes turn. Every other turn begins with
/// pairs of facets that fit into one clearly narrower than the widest, which leaves some to split the widest
/// with. True widths decide. Returns the turns taken.
std::uint64_t CountApproximation::balance_facets(const Covering& start, double slab,
                                                 std::uint64_t most_turns) {
  FacetBalance balance(growth_.work().complex, *space_, is_convex(), start);
  std::array<double, kTurnsLookedBack> before;  // widths
  before.fill(HUGE_VAL);
  double width = HUGE_VAL;
  std::uint64_t turn = 0, next_join = 0;
  for (; turn < most_turns && search_.width > flat() && !growth_.is_late(); ++turn) {
    const std::size_t facets = balance.covering().planes.size();
    if (turn >= next_join && facets + count_ / kFewSpare >= count_) {
      Covering joined = balance.covering();
      join_neighbours(joined, kClearlyNarrower * std::min(width, joined.widest));
      const std::size_t won = facets - joined.planes.size();
      if (won > 0) balance.set_joined(std::move(joined));
      next_join = turn + (won > count_ / kFewJoined ? 2 : 5);
    }
    // A part of what may be: where they are needed shows when the others have turned.
    const std::size_t spare = count_ - std::min(count_, balance.covering().planes.size());
    balance.split_widest((spare + 2) / 3);
    balance.turn();
    Covering turned = balance.covering();
    if (!keeps_hull(turned)) close_and_join(turned, slab, false);  // others have taken what had closed it
    if (turned.planes.size() > count_ || !keeps_hull(turned)) break;
    width = std::min(width, consider(turned, slab));
    double& earlier = before[turn % kTurnsLookedBack];
    if (width > (live_count() > kMostProbed ? kNarrower : kNarrowerOfFew) * earlier) return turn + 1;
    earlier = width;
  }
  return turn;
}

/// Slabs of widths near those of the narrowest covering. The number of facets scatters where they hold few
/// simplices: thinner slabs may need no more, and wider ones may be narrower when they are fitted to the
/// points.
void CountApproximation::probe_widths() {
  SlabCover cover(growth_.work().complex, *space_, is_convex());
  const bool joins = is_worth_joining();
  std::uint64_t left = kMostProbed;
  const auto can_go_on = [&] {
    return left >= cover.live_count() && search_.width > flat() && !growth_.is_late();
  };
  const auto try_covering = [&](const Covering& covering, double slab) {
    consider(covering, slab);
    const std::uint64_t turns = balance_facets(covering, slab, kProbeTurns);
    left -= std::min(left, turns * cover.live_count() / 4);  // a turn takes less time than a covering
  };
  const auto probe = [&](double width, const CoverEffort& effort) {
    left -= cover.live_count();
    Covering covering = cover.cover(width, effort);
    if (covering.planes.size() > 2 * count_) return;
    close_and_join(covering, width, joins);
    if (covering.planes.size() <= count_ && keeps_hull(covering)) try_covering(covering, width);
  };
  // As few facets as a hull can have, which may be the narrowest of a search that ended early.
  const Covering fewest =
      cover_by_first_simplex(growth_.work().complex, *space_, frame_, growth_.coordinates());
  if (can_go_on()) {
    try_covering(fewest, 0.0);
  } else {
    consider(fewest, 0.0);
  }
  double start = search_.width, width = start * std::sqrt(kProbeStep);
  for (int step = 0; step < kProbesThinner && can_go_on(); ++step, width *= kProbeStep) {
    probe(width, kHarderCover);
    if (can_go_on()) probe(width, kPlainCover);
    if (search_.width > 0.999 * start) continue;
    start = search_.width;
    width = start / std::sqrt(kProbeStep);
    step = -1;
  }
  width = start / std::sqrt(kProbeStep);
  for (int step = 0; step < kProbesWider && can_go_on(); ++step, width /= kProbeStep)
    probe(width, kHarderCover);
}

/// So many facets, narrower: their number falls like a power of the width, which shows from width to width.
void CountApproximation::look_for_narrower() {
  const double wanted = kNearlyAll * static_cast<double>(count_);
  const double power_of_ball = std::max(1.0, 0.5 * (static_cast<double>(space_->rank()) - 1.0));
  double power = power_of_ball, width = search_.width, last_width = HUGE_VAL, last_count = 0.0;
  int in_vain = 0;
  for (int i = 0; i < kMostWidths && search_.width > flat() && !growth_.is_late(); ++i) {
    Covering covering = search_.narrowest;
    if (!look_further(width, covering)) {
      if (i == 0 || ++in_vain == kMostInVain) return;
      width = 0.5 * (width + search_.width);
      continue;
    }
    const double before = search_.width, found = static_cast<double>(covering.planes.size());
    const bool is_narrower = covering.planes.size() <= count_ && consider(covering, search_.slab) < before;
    if (i > 0 && !is_narrower && ++in_vain == kMostInVain) return;
    if (i > 0 && is_narrower && found >= wanted) return;
    if (std::abs(std::log(last_width / width)) > kTellsOfPower) {
      if (i > 0)
        power = std::clamp(std::log(found / last_count) / std::log(last_width / width), 1.0, power_of_ball);
      last_width = width;
      last_count = found;
    }
    width = std::min(width * std::pow(found / wanted, 1.0 / power), (1.0 - kLeastNarrower) * search_.width);
  }
}

}  // namespace ndhull
