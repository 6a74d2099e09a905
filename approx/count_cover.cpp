// A target number of facets: the part of approx/approximation.h that looks for the least width.
#include <algorithm>
#include <cmath>

#include "approx/approximation.h"
#include "approx/exact_facets.h"

namespace ndhull {
namespace {

/// Simplices that are worth growing for a target number; so many where points left out are nearly as far
/// outside as a facet may be wide. Covering them takes about as long as growing them did.
constexpr std::uint64_t kWorthGrowing = 250'000, kMostWorthGrowing = 1'000'000;
/// Simplices for each facet of a target number, at first and at most.
constexpr std::uint64_t kSimplicesPerFacetFirst = 16, kSimplicesPerFacet = 96;
/// Part of the width that points left out may be outside without growth going on to kMostWorthGrowing.
constexpr double kNearSlab = 0.75;
/// The same where slabs turned out narrower than growth was meant for.
constexpr double kTooNearSlab = 0.85;
/// Growth goes on where slabs turn out narrower than this part of what it was meant for.
constexpr double kCoarse = 0.75;
/// Simplices that are covered, counted again for each covering, until what there is is taken. On wine (11-d),
/// where each round finds more points that a facet has to have, that is 5 to 20 s.
constexpr std::uint64_t kMostCovered = 8'000'000;
/// Rounds of more points, likewise.
constexpr int kMostRounds = 24;
constexpr int kMostCoverings = 16, kMostCoveringsLate = 4;
/// By how much the logarithm of the number may fall short: of a hull that goes on growing, and at the end.
constexpr double kSome = 0.2, kLittle = 0.025;

}  // namespace

/// Remembers the narrowest over all points.
void Approximation::consider(const Covering& covering, double slab, CountSearch& search) {
  const double width = true_widths(covering).widest();
  if (search.has_any() && width >= search.width) return;
  search.narrowest = covering;
  search.width = width;
  search.slab = slab;
}

/// The covering by the narrowest slabs found that needs at most `count` facets, and hardly less;
/// chosen.slab_width is theirs. No planes: there is none. The number falls like a power of the width, about
/// the (rank-1)/2-th where the hull is round; what it was last is remembered.
Covering Approximation::cover_count(std::uint64_t count, const CoverEffort& effort, double start_width,
                                    double slack, CountSearch& search) {
  SlabCover cover(growth_.work().complex, *space_, is_convex());
  const bool joins = is_worth_joining(count, cover.live_count());
  const double power_of_ball = 0.5 * (static_cast<double>(space_->rank()) - 1.0);
  const double least_step = 0.2 / power_of_ball;
  if (search.power == 0.0) search.power = power_of_ball;
  const double wanted = std::log(static_cast<double>(count));
  struct Trial {
    double log_width, log_count;
  };
  std::optional<Trial> few, many;  // nearest with at most, with more than the count
  Covering best;
  double best_width = 0.0, log_width = std::log(start_width);
  for (int trial = 0; trial < kMostCoverings; ++trial) {
    if (growth_.is_late() && (!best.planes.empty() || trial >= kMostCoveringsLate)) break;
    const double width = std::exp(log_width);
    Covering covering = cover.cover(width, effort);
    search.covered += cover.live_count();
    if (covering.planes.size() <= 2 * count) {
      close_open_directions(growth_.work().complex, *space_, covering);
      if (joins) join_neighbours(covering, width);
    }
    const double log_count = std::log(static_cast<double>(covering.planes.size()));
    if (covering.planes.size() > count) {
      if (!many || log_width > many->log_width) many = Trial{log_width, log_count};
    } else {
      if (!few || log_width < few->log_width) few = Trial{log_width, log_count};
      const bool is_hull = keeps_hull(covering);
      if (is_hull) consider(covering, width, search);
      if (is_hull && (best.planes.empty() || width < best_width)) {
        best = std::move(covering);
        best_width = width;
      }
      if (is_hull && (width <= flat() || wanted - few->log_count < slack)) break;
    }
    if (few && many) {
      const double between = few->log_width - many->log_width;
      if (between < 0.004) break;
      const double fewer = std::max(1e-9, many->log_count - few->log_count);
      // Of widths near each other it says little: the number scatters.
      if (between > 0.03)
        search.power = std::clamp(fewer / between, 0.5 * power_of_ball, 4.0 * power_of_ball);
      const double part = (many->log_count - wanted + 0.5 * slack) / fewer;
      log_width = many->log_width + std::clamp(part, 0.08, 0.92) * between;
    } else if (few) {
      log_width -= std::max(least_step, 1.2 * (wanted - few->log_count) / search.power);
      if (few->log_width > std::log(flat())) log_width = std::max(log_width, std::log(flat()));
    } else {
      log_width += std::max(least_step, 1.2 * (many->log_count - wanted) / search.power);
    }
  }
  hull_.chosen.slab_width = best_width;
  return best;
}

/// Growth for so many facets that need slabs of this width. True when it has added a vertex.
bool Approximation::grow_for_count(std::uint64_t count, double outside_width, double slab) {
  const std::uint64_t most = std::max(kWorthGrowing, kSimplicesPerFacet * count);
  const std::uint64_t insertions = growth_.work().counters.insertions;
  const auto has_paused = [&](std::uint64_t enough, double height) {
    return !growth_.grow_to(outside_width, enough, height) && !growth_.is_limited();
  };
  bool is_paused = !growth_.is_limited() && has_paused(lengths_.outside_width > 0.0 ? 0 : most, HUGE_VAL);
  for (std::uint64_t enough = most; is_paused && enough < kMostWorthGrowing &&
                                    growth_.furthest_height() > kNearSlab * slab && !growth_.is_late();) {
    enough += kWorthGrowing / 4;
    is_paused = has_paused(enough, HUGE_VAL);
  }
  if (is_paused) has_paused(most, slab);  // what is further outside makes facets wider, whatever the slabs
  locate_left_out(outside_width);
  return growth_.work().counters.insertions > insertions;
}

/// Is it worth growing further for slabs that turned out so narrow?
bool Approximation::is_coarse_for(double slab, double outside_width) {
  const GrowthWork& work = growth_.work();
  const double height = growth_.furthest_height();
  if (height == 0.0)  // it had ended
    return outside_width > flat() && kShareForGrowth * slab < kCoarse * outside_width;
  return height > kTooNearSlab * slab && work.complex.row_count - work.free_count < kMostWorthGrowing;
}

/// What so many facets may be as wide as, from a coarse hull; 0 where that was not found out.
double Approximation::guess_width(std::uint64_t count, CountSearch& search) {
  const std::uint64_t rows = std::max<std::uint64_t>(20'000, kSimplicesPerFacetFirst * count);
  if (growth_.grow_to(0.0, rows, HUGE_VAL) || growth_.is_limited()) return 0.0;
  make_space(false);
  const double start = std::max(0.1 * lengths_.largest_extent, 1.1 * growth_.furthest_height());
  const Covering covering = cover_count(count, CoverEffort{.final_fit_steps = 0}, start, kLittle, search);
  return covering.planes.empty() ? start : hull_.chosen.slab_width;
}

// A simplex with a point left out too far above it is too wide alone, whatever the slabs are: such points are
// taken in, in rounds, as for a target width. Each round starts from the slabs of the one before it.
FacetClusters Approximation::run_count() {
  const std::uint64_t count = accuracy_.facets;
  const bool is_given = lengths_.outside_width > 0.0;
  CoverEffort effort{.final_fit_steps = 0};
  CountSearch search;
  double width = is_given ? 0.0 : guess_width(count, search);
  double outside_width = is_given ? lengths_.outside_width : kShareForGrowth * width;
  if (width == 0.0) width = std::max(0.1 * lengths_.largest_extent, 2.0 * outside_width);
  grow_for_count(count, outside_width, width);
  if (outside_width == 0.0 && growth_.furthest_height() == 0.0 && !growth_.is_limited() &&
      count_exact_facets(growth_.work(), growth_.coordinates()) <= count)
    return FacetClusters{};       // the exact hull it is
  search.narrowest = Covering{};  // of the coarse hull
  bool is_better_search = false, is_from_wide = false;
  for (int round = 1; !search.has_any() || !growth_.is_late(); ++round) {
    make_space(true);
    const Covering covering = cover_count(count, effort, width, is_better_search ? kLittle : kSome, search);
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
    const bool is_enough = search.covered > kMostCovered || round == kMostRounds;
    const bool may_grow = !growth_.is_limited() && !growth_.is_late() && !is_enough;
    const bool is_coarse = may_grow && !is_given && is_coarse_for(slab, outside_width);
    const bool is_settled = widths.widest() <= std::max(1.002 * slab, flat()) || extra_.size() == known;
    width = slab;
    if (is_coarse) {
      if (growth_.furthest_height() == 0.0) {
        outside_width = growth_.work().options.outside_width = kShareForGrowth * slab;
        growth_.repair();
      }
    } else if (is_enough || is_settled) {
      if (is_enough || is_better_search || slab <= flat()) break;
      is_better_search = true;  // it needs fewer facets: a smaller width will do
      effort = CoverEffort{.choices = 2, .refits = 2};
      width *= 0.97;
    }
    if (!may_grow || (!is_coarse && offenders.above_simplices.empty())) continue;
    growth_.put_back(offenders.above_simplices);
    if (grow_for_count(count, outside_width, slab)) search.narrowest = Covering{};  // rows are others now
  }
  hull_.chosen.outside_width = outside_width;
  if (search.has_any()) {
    hull_.chosen.slab_width = search.slab;
  } else {
    search.narrowest = cover_by_first_simplex(growth_.work().complex, *space_, frame_, growth_.coordinates());
  }
  return clusters_of(search.narrowest, *space_);
}

}  // namespace ndhull
