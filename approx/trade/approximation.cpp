#include "approx/trade/approximation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/facets/exact_facets.h"
#include "approx/slabs/merge_rule.h"
#include "approx/slabs/segment_merge.h"
#include "approx/trade/cluster_merge.h"
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

/// Of a coarse hull, which only says about how wide facets will be, so many of the furthest points are seen.
constexpr std::size_t kFewOfCoarse = 1 << 12;
/// Up to so many facets with few simplices each neighbours are tried again: many fit there, where large slabs
/// leave hardly any.
constexpr std::size_t kFewSmallFacets = 1024, kSmall = 30;
/// Disjoint slabs that hold less than this part of the mean number of simplices look for a neighbour to join.
/// Where points were shifted all that hold less than the mean do, if it is no less than this.
constexpr std::size_t kPartOfMean = 4, kLargeOfShifted = 16;

}  // namespace

Approximation::Approximation(const ApproximationTask& task)
    : frame_(task.frame),
      accuracy_(task.accuracy),
      lengths_(task.lengths),
      factor_(task.factor),
      growth_(task.growth),
      hull_(task.hull) {}

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
      constexpr std::size_t kAtATime = 4096;
      const std::vector<LocatedPoint>& left_out = growth_.left_out();
      std::vector<double> heights(left_out.size());
      for_each_block(left_out.size(), kAtATime, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          heights[i] = height_above(work, left_out[i].simplex.value, left_out[i].gauge);
      });
      std::vector<Reach> of_row(complex.row_count, Reach{0.0, PointId{}});
      for (std::size_t i = 0; i < left_out.size(); ++i) {
        const Reach reach{std::isfinite(heights[i]) ? heights[i] : HUGE_VAL, left_out[i].point};
        Reach& furthest_of_row = of_row[left_out[i].simplex.value];
        if (reach < furthest_of_row) furthest_of_row = reach;
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

bool Approximation::has_few_small(std::size_t facets, std::size_t simplices) {
  return facets <= kFewSmallFacets && simplices < kSmall * facets;
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

PointsAbove Approximation::points_above() const {
  constexpr double kShifts = 4.0;  // none is moved by more than two, and planes are as right as rounding lets
  const GrowthWork& work = growth_.work();
  return {.are_left_out = space_->vertex_count() < space_->table().count(),
          .vertices = work.shifted_points.empty() ? 0.0 : kShifts * work.options.shift};
}

/// Disjoint slabs, the small ones of which have joined a neighbour where both fit into one. Nothing:
/// overlapping ones are better.
std::optional<DualFacets> Approximation::find_disjoint_slabs(double width) {
  PartitionTask task;
  std::optional<DualFacets> facets = find_single_slabs(width, task);
  if (facets) join_small_slabs(width, *facets);
  return facets;
}

/// Before any have joined.
std::optional<DualFacets> Approximation::find_single_slabs(double width, PartitionTask& task) {
  const PointsAbove above = points_above();
  FindDeterminants find;
  if (!above.are_shifted() && finds_determinants_)
    find = [this](const BlockWork& also) { return find_determinants(also); };
  return partition_into_slabs(growth_.work().complex, *space_, growth_.coordinates(), factor_, above, width,
                              find, task);
}

void Approximation::join_small_slabs(double width, DualFacets& facets) const {
  if (!facets.may_join()) return;
  const std::size_t simplices = facets.begin.back();
  const std::size_t mean = simplices / facets.count();
  // The exact hull of shifted points takes longer, since coplanar facets are looked for: so may this.
  const bool has_time = points_above().are_shifted() && mean >= kLargeOfShifted;
  std::size_t most = has_time ? mean : std::max<std::size_t>(1, mean / kPartOfMean);
  // Of degenerate data slabs start from planes that rounding has drawn: two may share what one could hold.
  if (is_degenerate() || has_few_small(facets.count(), simplices)) most = simplices;
  join_along_segments(growth_.work().complex, growth_.coordinates(), factor_, space_->point_count(), width,
                      most, facets);
}

/// Where the points left out are, to a twentieth of what growth left out. It may soon go on.
void Approximation::locate_and_go_on(double outside_width) {
  growth_.locate_left_out(0.05 * outside_width / lengths_.largest_extent);
}

void Approximation::locate_left_out(double outside_width) {
  locate_and_go_on(outside_width);
  growth_.drop_grower();
}

/// Puts back what was left out and is further outside than this.
void Approximation::take_in_outside(double outside_width) {
  GrowthWork& work = growth_.work();
  work.options.outside_width = outside_width;
  std::vector<LocatedPoint> above;
  for (LocatedPoint point : growth_.left_out()) {
    const auto plane = work.complex.plane(point.simplex);
    const double* y = growth_.coordinates() + std::size_t{point.point.value} * work.rank;
    point.gauge = std::inner_product(plane.begin(), plane.end(), y, -1.0);
    if (point.gauge > 4.0 * work.options.shift &&
        height_above(work, point.simplex.value, point.gauge) > outside_width)
      above.push_back(point);
  }
  growth_.put_back(above);
}

/// Takes in these points, of those left out, however little they are outside; no other.
void Approximation::take_in_alone(std::span<const PointId> left_out) {
  for (std::size_t round = 0; round <= left_out.size() && !growth_.is_limited(); ++round) {
    const std::vector<LocatedPoint> above = located(left_out);
    if (above.empty()) return;
    growth_.leave_out_others();
    growth_.put_back(above);
    growth_.grow_to(0.0, 0, HUGE_VAL);
  }
}

}  // namespace ndhull
