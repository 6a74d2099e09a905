#include "approx/trade/width_approximation.h"

#include <algorithm>
#include <utility>

#include "approx/slabs/held_simplices.h"
#include "approx/slabs/slab_partition.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

/// Up to so many facets neighbours are tried again for what fits into one slab, where growth has left out
/// hardly any points, and took as long as the exact hull's.
constexpr std::size_t kFewOfWholeHull = 128;
/// Points left out, in parts of the vertices, that are many.
constexpr double kLeftOutMany = 1.0;
/// Part of the width that points may be outside where a limit has ended growth.
constexpr double kShareOutside = 0.85;
/// Rounds in which the fits see what was above fewer facets.
constexpr int kMostRoundsOfPoints = 6;

}  // namespace

WidthApproximation::WidthApproximation(const ApproximationTask& task)
    : Approximation(task),
      input_bytes_(task.input_bytes),
      earlier_(task.earlier),
      target_(lengths_.width * (1.0 - 1e-9)),
      outside_width_(lengths_.outside_width > 0.0 ? lengths_.outside_width
                                                  : kShareForGrowth * lengths_.width),
      slab_(target_) {}

ApproximateFacets WidthApproximation::run() {
  ApproximateFacets found;
  found.clusters = find_facets();
  growth_.drop_grower();
  if (hull_.status == HullStatus::kComplete) hull_.status = limit_;
  found.determinants = std::move(determinants_);
  found.star_hull = std::move(star_hull_);
  found.may_do_without_complex =
      is_width_alone() && !are_stars_in_vain_ && !growth_.options().wants_simplices;
  return found;
}

/// Is it worth its time to join neighbours that fit into one slab, where disjoint slabs have joined along
/// segments?
bool WidthApproximation::is_worth_joining_again(std::size_t facets, std::size_t simplices) const {
  const double left_out = space_->share_of_others();
  return facets <= (left_out > kSomeLeftOut ? kFewFacets : kFewOfWholeHull) ||
         (left_out > kLeftOutMany && has_few_small(facets, simplices));
}

/// Of very few facets of few simplices, where growth has left out more points than there are vertices, a
/// quarter is saved in some milliseconds, and the exact hull takes longer still.
bool WidthApproximation::is_worth_looking_further(std::size_t facets) const {
  constexpr std::size_t kVeryFew = 40, kFewSimplices = 8192;
  return is_thorough() ||
         (facets <= kVeryFew && live_count() <= kFewSimplices && space_->share_of_others() > kLeftOutMany);
}

/// Is nothing left to be looked at? All points were seen, no simplex was too wide alone, the planes bound a
/// region, and hardly any two facets would fit into one slab.
bool WidthApproximation::is_final(const DualFacets& facets) const {
  return facets.unfit.empty() && facets.are_far_from_centre && growth_.left_out().size() <= kFewLeftOut &&
         !is_worth_joining_again(facets.count(), live_count());
}

/// Where there is none for slabs, may there be for the same hull without its complex?
bool WidthApproximation::has_memory_for(const std::optional<DualFacets>& slabs, bool are_final) {
  if (!slabs) return growth_.has_memory_to_cover();
  if (growth_.has_memory_for_slabs(slabs->count(), !are_final)) return true;
  const std::size_t rank = frame_.rank;
  const std::uint64_t room = growth_.bytes_left() + live_count() * 16 * rank;
  if (live_count() * star_row_bytes(rank) + slabs->count() * star_facet_bytes(rank) > room)
    are_stars_in_vain_ = true;
  return false;
}

/// No planes: not even slabs as thin as rounding leave a hull. `known`: as close_open_directions; with points
/// missing there the covering is not to be used.
Covering WidthApproximation::cover(std::optional<DualFacets> slabs, HullFacets* known) {
  double width = slab_;
  const SimplicialComplex& complex = growth_.work().complex;
  const std::size_t live = live_count();
  std::optional<SlabCover> overlapping;
  const auto cover_anew = [&] {
    if (slabs) return covering_of(*slabs, *space_);
    if (!overlapping) overlapping.emplace(complex, *space_, is_convex());
    return overlapping->cover(width, CoverEffort{.final_fit_steps = 0});
  };
  Covering covering = cover_anew();
  hull_.chosen.refused_merges =
      close_open_directions(complex, *space_, growth_.coordinates(), known, covering);
  if (known && !known->missing.empty()) return covering;
  while (!keeps_hull(covering)) {
    if (width < thinnest()) return Covering{};
    width *= 0.75;
    ++hull_.chosen.refused_merges;
    slabs = find_disjoint_slabs(width);
    covering = cover_anew();
    if (covering.planes.size() == live) return cover_by_simplices(complex, *space_);
  }
  hull_.chosen.slab_width = width;
  if (is_worth_joining_again(covering.planes.size(), live)) join_neighbours(covering, width);
  return covering;
}

/// Disjoint slabs that hold all simplices, small ones joined; or the points that are too far above simplices
/// which none holds, as far as growth may take them in. Slabs are of no use then.
std::vector<LocatedPoint> WidthApproximation::find_slabs(bool may_grow, std::optional<DualFacets>& slabs) {
  constexpr std::size_t kFew = 128;  // of the facets one in so many
  constexpr int kRoundsOfMany = 3;
  slabs = find_single_slabs(slab_, task_);
  if (!slabs) return {};
  // Held by planes of their own many would be many facets. Taking in points for the last ones has no end: the
  // next partition leaves others.
  const bool takes_in = may_grow && has_seen_all_ && !has_settled() && !growth_.is_late();
  const bool are_many = slabs->unfit.size() > slabs->count() / kFew && rounds_of_many_ < kRoundsOfMany;
  if (are_many) ++rounds_of_many_;
  std::vector<LocatedPoint> far;
  if (takes_in && are_many) far = far_above(slabs->unfit);
  if (far.empty()) {
    hold_unfit(*space_, growth_.coordinates(), slab_, *slabs);
    if (takes_in) far = far_above(slabs->unfit);
  }
  if (far.empty()) join_small_slabs(slab_, *slabs);
  return far;
}

/// Is there time for another round, the last one having taken so long?
bool WidthApproximation::may_go_on(double seconds_of_round) {
  constexpr double kRounds = 2.5;  // and the facet table
  if (!has_settled() || growth_.options().stop.stop_requested()) return !growth_.is_late();
  return growth_.seconds_left() > kRounds * seconds_of_round;
}

/// Has a limit ended growth, with time to gather what there is? Then facets may be as wide as the points that
/// are left out make them: simplices, of which there are many times more, are hardly narrower. True when that
/// is wider than the target was.
bool WidthApproximation::settles_for_wider() {
  if (has_settled()) return false;
  limit_ = growth_.go_on_within_limit();
  if (!has_settled()) return false;
  outside_width_ = std::max(outside_width_, growth_.furthest_height());
  const double least = outside_width_ / kShareOutside;
  if (least <= target_) return false;
  target_ = least;
  return true;
}

/// Fewer facets than a covering that fits over all points. What the fits have not seen may be above the
/// fewer: then they see it, and it is looked for again.
void WidthApproximation::look_for_fewer(Covering& covering) {
  for (int round = 0; round < kMostRoundsOfPoints; ++round) {
    Covering fewer = covering;
    if (!look_further(target_, fewer) || fewer.planes.size() >= covering.planes.size()) return;
    const TrueWidths widths = true_widths(fewer);
    if (widths.widest() <= target_) {
      covering = std::move(fewer);
      return;
    }
    const std::size_t known = extra_.size();
    add_offenders(fewer, widths, target_);
    if (extra_.size() == known) return;
    make_space(true);
  }
}

/// In rounds, with smaller slabs and more points each, until no facet is wider than the target.
FacetClusters WidthApproximation::find_facets() {
  Covering covering;
  HullFacets known;
  known.width = target_;
  choose_order();
  if (find_stars()) return FacetClusters{};
  for (int round = 0;; ++round) {
    const bool is_last = round == kWidthRounds;
    determinants_ = HugeArray<double>();
    grow();
    const Clock::time_point round_start = Clock::now();
    const bool may_cover = hull_.status != HullStatus::kMemoryLimit && growth_.has_time_to_cover();
    if (settles_for_wider()) known.width = slab_ = target_;
    if (!may_cover && (!has_settled() || hull_.status == HullStatus::kInterrupted)) return FacetClusters{};
    make_space(true);
    const bool may_grow = !is_last && !growth_.is_limited();
    if (round == 0 && may_grow && !has_settled() && leaves_out_hardly_any()) {
      outside_width_ = 0.0;
      take_in_outside(outside_width_);
      continue;
    }
    growth_.drop_grower();
    std::optional<DualFacets> slabs;
    const std::vector<LocatedPoint> far = find_slabs(may_grow, slabs);
    if (!far.empty()) {
      take_in_far(far, round);
      continue;
    }
    const bool are_final = slabs && is_final(*slabs) && !is_thorough();
    if (!has_memory_for(slabs, are_final)) return FacetClusters{};
    if (are_final) {
      hull_.chosen.outside_width = outside_width_;
      hull_.chosen.slab_width = slab_;
      FacetClusters clusters = clusters_of(std::move(*slabs));
      if (!growth_.work().shifted_points.empty()) clusters.keep_planes(growth_.work().complex);
      return clusters;
    }
    covering = cover(std::move(slabs), may_grow ? &known : nullptr);
    if (covering.planes.empty()) return FacetClusters{};
    if (may_grow && !known.missing.empty()) {
      take_in_alone(known.missing);
      continue;
    }
    const TrueWidths widths = true_widths(covering);
    const double widest = widths.widest();
    if (widest <= target_ && is_worth_looking_further(covering.planes.size())) look_for_fewer(covering);
    if (widest <= target_ || !may_grow || !may_go_on(seconds_since(round_start))) break;
    const Offenders offenders = add_offenders(covering, widths, target_);
    take_in_far(offenders.above_simplices, round);
    if (offenders.widest_slab > target_)
      slab_ = std::max(0.9 * slab_, slab_ - 1.1 * (offenders.widest_slab - target_));
  }
  hull_.chosen.outside_width = outside_width_;
  return facets_of(covering);
}

}  // namespace ndhull
