#include "approx/trade/approximation.h"

#include <algorithm>
#include <cmath>

#include "approx/facets/exact_facets.h"
#include "approx/slabs/merge_rule.h"
#include "approx/slabs/segment_merge.h"
#include "approx/slabs/slab_partition.h"
#include "approx/trade/cluster_merge.h"
#include "approx/trade/far_above.h"
#include "approx/trade/region_closing.h"
#include "core/ids.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

/// How far outside a point is known to be; the furthest comes first.
struct Reach {
  double height;
  PointId point;
  bool operator<(const Reach& other) const {
    return height != other.height ? height > other.height : point < other.point;
  }
};

/// As many points left out are all seen by the fits; of more, the furthest over each simplex. What they do
/// not see makes slabs too wide. Of a coarse hull, which only says about how wide facets will be, the
/// furthest.
constexpr std::size_t kFewLeftOut = 1 << 17, kFewOfCoarse = 1 << 12;
/// Up to so many facets neighbours are tried again for what fits into one slab.
constexpr std::size_t kFewFacets = 256;
/// The same of facets with few simplices each: many fit there, where large slabs leave hardly any.
constexpr std::size_t kFewSmallFacets = 1024, kSmall = 30;
/// The same for a width where growth has left out hardly any points, and took as long as the exact hull's.
constexpr std::size_t kFewOfWholeHull = 128;
/// Points left out, in parts of the vertices, that are many.
constexpr double kLeftOutMany = 1.0;
/// Disjoint slabs that hold less than this part of the mean number of simplices look for a neighbour to join.
/// Where points were shifted all that hold less than the mean do, if it is no less than this.
constexpr std::size_t kPartOfMean = 4, kLargeOfShifted = 16;
/// Part of the width that points may be outside where a limit has ended growth.
constexpr double kShareOutside = 0.85;

}  // namespace

Approximation::Approximation(const Frame& frame, const Accuracy& accuracy, const ResolvedAccuracy& lengths,
                             std::vector<double> factor, CertifiedGrowth& growth, Hull& hull,
                             double input_bytes, EarlierRun earlier)
    : frame_(frame),
      accuracy_(accuracy),
      lengths_(lengths),
      factor_(std::move(factor)),
      growth_(growth),
      hull_(hull),
      input_bytes_(input_bytes),
      earlier_(earlier) {}

FacetClusters Approximation::run() {
  if (accuracy_.facets > 0) return run_count();
  if (lengths_.width > 0.0) {
    FacetClusters clusters = run_width();
    if (hull_.status == HullStatus::kComplete) hull_.status = limit_of_width_;
    return clusters;
  }
  grow_outside_width();
  return accuracy_.merges_neighbours() && growth_.may_cover() ? run_merging() : FacetClusters{};
}

// Many simplices are gathered into slabs first, each well inside what the rule and the cap allow: merging
// them pair by pair would take longer than growing them did.
FacetClusters Approximation::run_merging() {
  constexpr double kShareOfSlabs = 0.8;  // of the cap
  const double cap = lengths_.width_cap * (1.0 - 1e-9);
  MergeRule rule{.centrum_radius = lengths_.centrum_radius,
                 .max_cosine = accuracy_.max_cosine,
                 .width_cap = cap,
                 .least_facets = growth_.work().rank + 1};
  Covering covering;
  MergeCounts counts;
  for (int round = 0; round < kWidthRounds;) {
    make_space(true);
    const SimplexRule simplex_rule(growth_.work().complex, *space_, rule, is_convex());
    SlabCover cover(growth_.work().complex, *space_, is_convex(), &simplex_rule);
    covering = cover.cover(kShareOfSlabs * rule.width_cap, CoverEffort{.final_fit_steps = 0});
    counts = merge_clusters(growth_.work().complex, *space_, rule, covering);
    if (!keeps_hull(covering) && covering.planes.size() < cover.live_count()) {
      if (rule.width_cap < thinnest()) return FacetClusters{};
      rule.width_cap *= 0.75;  // what was merged bounds no region any more; a hull may be thin
      continue;
    }
    ++round;
    const TrueWidths widths = true_widths(covering);
    const std::size_t known = extra_.size();
    add_offenders(covering, widths, cap);
    if (extra_.size() == known || growth_.is_late()) break;
  }
  hull_.chosen.width_cap = cap;
  hull_.chosen.merges = counts.merges;
  hull_.chosen.refused_merges = counts.refused;
  return facets_of(covering);
}

/// A covering that is not changed any more.
FacetClusters Approximation::facets_of(const Covering& covering) const {
  Covering freed = covering;
  free_lone_simplices(growth_.work().complex, *space_, is_convex(), freed);
  return clusters_of(keeps_hull(freed) ? freed : covering, *space_);
}

/// The space of fits: vertices; points outside that reach furthest, one a simplex at most; those met before.
void Approximation::make_space(bool with_left_out) {
  const GrowthWork& work = growth_.work();
  const SimplicialComplex& complex = work.complex;
  std::vector<std::uint8_t> is_taken(work.point_count, 0);
  std::vector<PointId> vertices, others;
  // Where all points added are still vertices, few rows name them.
  for (std::uint32_t row = 0; row < complex.row_count && vertices.size() < work.most_vertices(); ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    for (const PointId id : complex.vertices(SimplexId{row})) {
      if (is_taken[id.value]) continue;
      is_taken[id.value] = 1;
      vertices.push_back(id);
    }
  }
  std::vector<Reach> furthest;
  const std::size_t few = with_left_out ? kFewLeftOut : kFewOfCoarse;
  if (with_left_out && !growth_.left_out().empty()) {
    if (growth_.left_out().size() <= few) {
      for (const LocatedPoint& point : growth_.left_out()) furthest.push_back({0.0, point.point});
    } else {
      std::vector<Reach> of_row(complex.row_count, Reach{0.0, PointId{}});
      for (const LocatedPoint& point : growth_.left_out()) {
        const double height = height_above(work, point.simplex.value, point.gauge);
        const Reach reach{std::isfinite(height) ? height : HUGE_VAL, point.point};
        if (reach < of_row[point.simplex.value]) of_row[point.simplex.value] = reach;
      }
      for (const Reach& reach : of_row)
        if (reach.point.valid()) furthest.push_back(reach);
    }
  } else if (!with_left_out) {
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      if (complex.state[row] != SimplexState::kLive || complex.outside_head[row] == 0) continue;
      const std::uint32_t id = complex.outside_head[row] - 1;
      furthest.push_back({work.heights.height(id), PointId{id}});
    }
  }
  std::sort(furthest.begin(), furthest.end());
  const std::size_t most = std::max(2 * vertices.size() + 1024, few);
  if (furthest.size() > most) furthest.resize(most);
  const auto take = [&](PointId id, std::vector<PointId>& list) {
    if (!is_taken[id.value]) list.push_back(id);
    is_taken[id.value] = 1;
  };
  for (const PointId id : extra_) take(id, others);
  for (const Reach& reach : furthest) take(reach.point, others);
  space_.emplace(work.rank, factor_, growth_.coordinates(), work.point_count, vertices, others,
                 complex.row_count - work.free_count);
  left_out_tree_.reset();
  has_left_out_ = with_left_out && !growth_.left_out().empty();
  has_seen_all_ = !has_left_out_ || growth_.left_out().size() <= kFewLeftOut;
}

/// At least rank + 1 facets, whose outer planes bound a region. With many facets of which none is wider than
/// the hull is high everywhere, that is certain.
bool Approximation::keeps_hull(const Covering& covering) const {
  return covering.planes.size() > space_->rank() && bounds_region(growth_.work().complex, *space_, covering);
}

/// Of a coarse hull: is it worth its time to grow the exact one before anything else is looked for?
bool Approximation::may_be_few_exact_facets() {
  return growth_.furthest_height() > 0.0 && !growth_.is_limited() && !earlier_.has_tried_exact &&
         !growth_.options().limits.has_any() && is_degenerate() &&
         may_be_few_facets(growth_.work(), growth_.coordinates(), accuracy_.facets);
}

bool Approximation::has_few_small(std::size_t facets, std::size_t simplices) {
  return facets <= kFewSmallFacets && simplices < kSmall * facets;
}

/// Is it worth its time to join neighbours that fit into one slab, for a number of facets? Of few facets, and
/// of degenerate data: there slabs start from planes that rounding has drawn, and two may share what one
/// could hold.
bool Approximation::is_worth_joining(std::size_t facets, std::size_t simplices) const {
  return facets <= kFewFacets || has_few_small(facets, simplices) || is_degenerate();
}

/// The same for a width, where disjoint slabs have joined along segments.
bool Approximation::is_worth_joining_again(std::size_t facets, std::size_t simplices) const {
  const double left_out = space_->share_of_others();
  return facets <= (left_out > kSomeLeftOut ? kFewFacets : kFewOfWholeHull) ||
         (left_out > kLeftOutMany && has_few_small(facets, simplices));
}

/// Of very few facets of few simplices, where growth has left out more points than there are vertices, a
/// quarter is saved in some milliseconds, and the exact hull takes longer still.
bool Approximation::is_worth_looking_further(std::size_t facets) const {
  constexpr std::size_t kVeryFew = 40, kFewSimplices = 8192;
  return is_thorough() ||
         (facets <= kVeryFew && live_count() <= kFewSimplices && space_->share_of_others() > kLeftOutMany);
}

void Approximation::join_neighbours(Covering& covering, double width) const {
  const MergeRule any{.max_cosine = -1.0, .width_cap = width, .least_facets = space_->rank() + 1};
  Covering joined = covering;
  merge_clusters(growth_.work().complex, *space_, any, joined);
  if (keeps_hull(joined)) covering = std::move(joined);
}

/// Of a hull without shifted points: no plane changes.
std::span<const double> Approximation::find_determinants(const BlockWork& also) {
  SimplicialComplex& complex = growth_.work().complex;
  if (determinants_.data() != nullptr) {
    constexpr std::size_t kRowsInBlock = 1 << 13;
    for_each_block(complex.row_count, kRowsInBlock, also);
  } else {
    const Clock::time_point start = Clock::now();
    determinants_ = HugeArray<double>::to_write(complex.row_count);
    find_outwards(complex, growth_.coordinates(), {determinants_.data(), complex.row_count}, also);
    hull_.statistics.detail_seconds.emplace_back("volumes", seconds_since(start));
  }
  return {determinants_.data(), complex.row_count};
}

/// Disjoint slabs, the small ones of which have joined a neighbour where both fit into one. Nothing:
/// overlapping ones are better. For a number of facets determinants are not wanted yet.
std::optional<DualFacets> Approximation::find_disjoint_slabs(double width, FacetLimit* limit_of_count) {
  const SimplicialComplex& complex = growth_.work().complex;
  const double* coordinates = growth_.coordinates();
  const PointsAbove above = !growth_.work().shifted_points.empty() ? PointsAbove::kAny
                            : is_convex()                          ? PointsAbove::kNoPoint
                                                                   : PointsAbove::kLeftOut;
  FindDeterminants find;
  if (above != PointsAbove::kAny && limit_of_count == nullptr)
    find = [this](const BlockWork& also) { return find_determinants(also); };
  std::optional<DualFacets> facets =
      partition_into_slabs(complex, *space_, coordinates, factor_, above, width, find, limit_of_count);
  if (!facets || !facets->may_join()) return facets;
  const std::size_t simplices = facets->begin.back();
  const std::size_t mean = simplices / facets->count();
  // The exact hull of shifted points takes longer, since coplanar facets are looked for: so may this.
  const bool has_time = above == PointsAbove::kAny && mean >= kLargeOfShifted;
  std::size_t most = has_time ? mean : std::max<std::size_t>(1, mean / kPartOfMean);
  // Of degenerate data slabs start from planes that rounding has drawn: two may share what one could hold.
  if (is_degenerate() || has_few_small(facets->count(), simplices)) most = simplices;
  join_along_segments(complex, coordinates, factor_, space_->point_count(), width, most, *facets);
  return facets;
}

/// Is nothing left to be looked at? All points were seen, no simplex was too wide alone, the planes bound a
/// region, and hardly any two facets would fit into one slab.
bool Approximation::is_final(const DualFacets& facets) const {
  return facets.unfit == 0 && facets.are_far_from_centre && growth_.left_out().size() <= kFewLeftOut &&
         !is_worth_joining_again(facets.count(), live_count());
}

/// No planes: not even slabs as thin as rounding leave a hull. `known`: as close_open_directions; with points
/// missing there the covering is not to be used.
Covering Approximation::cover_width(double width, std::optional<DualFacets> slabs, HullFacets* known) {
  const SimplicialComplex& complex = growth_.work().complex;
  const std::size_t live = live_count();
  std::optional<SlabCover> overlapping;
  const auto cover = [&] {
    if (slabs) return covering_of(*slabs, *space_);
    if (!overlapping) overlapping.emplace(complex, *space_, is_convex());
    return overlapping->cover(width, CoverEffort{.final_fit_steps = 0});
  };
  Covering covering = cover();
  hull_.chosen.refused_merges =
      close_open_directions(complex, *space_, growth_.coordinates(), known, covering);
  if (known && !known->missing.empty()) return covering;
  while (!keeps_hull(covering)) {
    if (width < thinnest()) return Covering{};
    width *= 0.75;
    ++hull_.chosen.refused_merges;
    slabs = find_disjoint_slabs(width);
    covering = cover();
    if (covering.planes.size() == live) return cover_by_simplices(complex, *space_);
  }
  hull_.chosen.slab_width = width;
  if (is_worth_joining_again(covering.planes.size(), live)) join_neighbours(covering, width);
  return covering;
}

/// Points that would make a covering vain, where that takes longer than taking them in. Not many: of a thin
/// hull hundreds can be far above the simplices of its rim, which slabs hold all the same.
std::vector<LocatedPoint> Approximation::few_far_above(double width) const {
  constexpr std::size_t kLargeHull = 50'000, kFew = 8, kPart = 4;
  if (!has_left_out_ || live_count() < kLargeHull) return {};
  std::vector<LocatedPoint> far =
      find_far_above(growth_.work(), growth_.coordinates(), *space_, growth_.left_out(), width);
  if (far.size() > std::max(kFew, growth_.left_out().size() / kPart)) return {};
  return far;
}

/// Is there time for another round, the last one having taken so long?
bool Approximation::may_go_on(double seconds_of_round) {
  constexpr double kRounds = 2.5;  // and the facet table
  if (!is_limited_width() || growth_.options().stop.stop_requested()) return !growth_.is_late();
  return growth_.seconds_left() > kRounds * seconds_of_round;
}

/// Has a limit ended growth, with time to gather what there is? Then facets may be as wide as the points that
/// are left out make them: simplices, of which there are many times more, are hardly narrower. True when that
/// is wider than the target was.
bool Approximation::settles_for_wider(double& outside_width, double& target) {
  if (is_limited_width()) return false;
  limit_of_width_ = growth_.go_on_within_limit();
  if (!is_limited_width()) return false;
  outside_width = std::max(outside_width, growth_.furthest_height());
  const double least = outside_width / kShareOutside;
  if (least <= target) return false;
  target = least;
  return true;
}

FacetClusters Approximation::run_width() {
  double target = lengths_.width * (1.0 - 1e-9);
  double outside_width =
      lengths_.outside_width > 0.0 ? lengths_.outside_width : kShareForGrowth * lengths_.width;
  constexpr int kRoundsOfFar = 3;
  double slab = target;
  Covering covering;
  HullFacets known;
  known.width = target;
  choose_order(outside_width);
  if (find_stars(outside_width, slab)) return FacetClusters{};
  for (int round = 0;; ++round) {
    const bool is_last = round == kWidthRounds;
    determinants_ = HugeArray<double>();
    grow_for_width(outside_width, slab);
    const Clock::time_point round_start = Clock::now();
    const bool may_cover = growth_.may_cover();
    if (settles_for_wider(outside_width, target)) known.width = slab = target;
    if (!may_cover && (!is_limited_width() || hull_.status == HullStatus::kInterrupted))
      return FacetClusters{};
    make_space(true);
    const bool may_grow = !is_last && !growth_.is_limited();
    if (round == 0 && may_grow && !is_limited_width() && leaves_out_hardly_any(outside_width)) {
      outside_width = 0.0;
      take_in_outside(outside_width);
      continue;
    }
    const std::vector<LocatedPoint> far =
        may_grow && round < kRoundsOfFar ? few_far_above(target) : std::vector<LocatedPoint>();
    if (!far.empty()) {
      outside_width = take_in_far(far, outside_width, round);
      continue;
    }
    std::optional<DualFacets> slabs = find_disjoint_slabs(slab);
    if (slabs && is_final(*slabs) && !is_thorough()) {
      hull_.chosen.outside_width = outside_width;
      hull_.chosen.slab_width = slab;
      FacetClusters clusters = clusters_of(std::move(*slabs));
      if (!growth_.work().shifted_points.empty()) clusters.keep_planes(growth_.work().complex);
      return clusters;
    }
    covering = cover_width(slab, std::move(slabs), may_grow ? &known : nullptr);
    if (covering.planes.empty()) return FacetClusters{};
    if (may_grow && !known.missing.empty()) {
      take_in_alone(known.missing);
      continue;
    }
    const TrueWidths widths = true_widths(covering);
    const double widest = widths.widest();
    if (widest <= target && is_worth_looking_further(covering.planes.size()))
      look_for_fewer(target, covering);
    if (widest <= target || !may_grow || !may_go_on(seconds_since(round_start))) break;
    const Offenders offenders = add_offenders(covering, widths, target);
    outside_width = take_in_far(offenders.above_simplices, outside_width, round);
    if (offenders.widest_slab > target)
      slab = std::max(0.9 * slab, slab - 1.1 * (offenders.widest_slab - target));
  }
  hull_.chosen.outside_width = outside_width;
  return facets_of(covering);
}

}  // namespace ndhull
