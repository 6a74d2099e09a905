#include "approx/rays/ray_shooting.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "approx/rays/frame_centre.h"
#include "approx/rays/near_copies.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;

/// Walks under way at a time: enough directions for products near the machine's peak.
constexpr std::size_t kWindow = 256;
/// Walks that one core takes over the core points together.
constexpr std::size_t kWalksPerGroup = 16;
/// A set of points this small is its own core.
constexpr std::size_t kSmallSet = 2048;
/// Points are above a plane by this gauge, or are not; growth moves points by as much (core/DESIGN.md).
constexpr double kAbove = 1e-12;
/// [ratio] coplanar points to points that are not above: growth merges within four shifts.
constexpr double kCoplanarToAbove = 4.0;
/// The walk is given up after so many pivots a dimension. Walks take up to five.
constexpr std::size_t kMaxPivotsPerDimension = 100;
/// How far the centre is moved from the simplex' mean to that of those points; the rest keeps it inside.
constexpr double kCentreShare = 0.875;

double unit_roundoff_bound(const FramePoints& points, double plane_length) {
  return 8.0 * static_cast<double>(points.rank) * 0x1p-53 * plane_length * points.largest_length;
}

}  // namespace

/// A walk under way.
struct RayShooter::Walker {
  enum class State { kOnCore, kOnAll, kDone };
  std::size_t task = 0;
  std::uint32_t skip = DirectionQuery::kNoPoint;
  bool asks_inside = false;
  bool tries_to_separate = false;  // the query is whether all points are below the point
  State state = State::kOnCore;
  ConeWalk walk;
  DirectionQuery query;
  double direction_length = 1.0;         // of the plane that the query's direction is a unit vector along
  std::vector<std::uint32_t> additions;  // points that were above: the core takes them in
  WalkResult result;

  void note_proof() {
    result.basis = walk.basis();
    result.weights.assign(walk.weights().begin(), walk.weights().end());
  }
};

namespace {

/// Writes the unit direction a walk asks about, and the query.
template <class Walker>
void ask(Walker& walker, double product_error, float* direction) {
  const Eigen::VectorXd wanted = walker.walk.turns() ? walker.walk.turn_direction() : walker.walk.plane();
  const double length = wanted.norm();
  for (Index k = 0; k < wanted.size(); ++k) direction[k] = static_cast<float>(wanted[k] / length);
  walker.direction_length = length;
  // What is refuted is above the plane whatever the rounding was; what is not near is below it.
  const double level = walker.walk.turns() ? 0.0 : 1.0 / length;
  walker.query.skip = walker.skip;
  if (walker.tries_to_separate) {
    const double below = walker.walk.gauge() / length - 2.0 * product_error;
    walker.query.refute = walker.query.threshold = static_cast<float>(below);
    return;
  }
  walker.query.refute = static_cast<float>(level + 2.0 * product_error);
  walker.query.threshold = static_cast<float>(std::max(level - 2.0 * product_error, 0.0));
}

}  // namespace

RayShooter::RayShooter(const PointView& points, double near) : frame_(fit_frame(points)) {
  point_count_ = points.rows;
  if (frame_.rank == 0) return;
  const std::vector<std::uint32_t> furthest = find_centre(points);
  is_in_core_.assign(point_count_, false);
  fill_tiles(near);
  core_ = ScanTiles(frame_.rank);
  for (const std::uint32_t id : furthest) add_to_core(id);
}

/// Returns the points that the core begins with.
std::vector<std::uint32_t> RayShooter::find_centre(const PointView& points) {
  const std::size_t rank = frame_.rank;
  coordinates_.resize((point_count_ + 2 * rank) * rank);
  map_points(points, frame_, coordinates_.data());
  const FramePoints in_frame{coordinates_.data(), rank, 0.0};
  inner_radius_ = 0.5 * (1.0 - kCentreShare) * inner_radius(in_frame, frame_.simplex);
  const std::vector<std::uint32_t> far_out = furthest_along_directions(in_frame, point_count_);
  std::vector<double> mean(frame_.dimension, 0.0);
  const double weight = kCentreShare / static_cast<double>(far_out.size());
  for (std::size_t k = 0; k < frame_.dimension; ++k) mean[k] = (1.0 - kCentreShare) * frame_.centre[k];
  for (const std::uint32_t id : far_out)
    for (std::size_t k = 0; k < frame_.dimension; ++k) mean[k] += weight * points.at(id, k);
  frame_.centre = mean;
  map_points(points, frame_, coordinates_.data());
  for (std::size_t k = 0; k < rank; ++k) {  // two points inside the hull on each axis: the first basis
    coordinates_[(point_count_ + k) * rank + k] = inner_radius_;
    coordinates_[(point_count_ + rank + k) * rank + k] = -inner_radius_;
  }
  std::vector<std::uint32_t> first;
  if (point_count_ <= kSmallSet) {
    first.resize(point_count_);
    std::iota(first.begin(), first.end(), 0);
  } else {
    for (const PointId id : frame_.simplex) first.push_back(id.value);
    first.insert(first.end(), far_out.begin(), far_out.end());
  }
  return first;
}

/// Longest points first; of equal points only the first, so that points on a plane are different ones.
void RayShooter::fill_tiles(double near) {
  const std::size_t rank = frame_.rank;
  const FramePoints in_frame{coordinates_.data(), rank, 0.0};
  std::vector<double> length_sq(point_count_);
  for (std::uint32_t id = 0; id < point_count_; ++id) length_sq[id] = in_frame.point(id).squaredNorm();
  const double longest = std::sqrt(*std::max_element(length_sq.begin(), length_sq.end()));
  copy_of_ = find_near_copies(coordinates_.data(), point_count_, rank, near * longest);
  std::vector<std::uint32_t> order;
  for (std::uint32_t id = 0; id < point_count_; ++id) {
    if (copy_of_[id] == id) {
      order.push_back(id);
    } else {
      is_in_core_[id] = true;  // never to be added
    }
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (length_sq[a] != length_sq[b]) return length_sq[a] > length_sq[b];
    const double *const x = in_frame.row(a), *const y = in_frame.row(b);
    return std::lexicographical_compare(x, x + rank, y, y + rank);
  });
  all_ = ScanTiles(rank);
  all_.reserve(order.size());
  for (const std::uint32_t id : order) all_.append(in_frame.row(id), id);
  all_.mark_sorted();
}

void RayShooter::add_to_core(std::uint32_t id) {
  if (is_in_core_[id]) return;
  is_in_core_[id] = true;
  core_.append(points().row(id), id);
}

/// `begun`: another walk over a ridge, that has made no pivot; null: none. It may be from the same facet.
bool RayShooter::begin(const WalkTask& task, const Walker* begun, Walker& walker) const {
  walker.skip = task.skip;
  walker.asks_inside = task.asks_inside;
  walker.tries_to_separate = false;
  walker.state = Walker::State::kOnCore;
  walker.result = WalkResult();
  walker.result.end = WalkEnd::kOpen;
  walker.additions.clear();
  if (task.direction.empty()) {
    if (begun == nullptr || begun->walk.basis() != task.basis)
      return walker.walk.start_ridge(points(), task.basis, task.place);
    walker.walk.start_ridge(begun->walk, task.place);
    return true;
  }
  const Eigen::Map<const Eigen::VectorXd> direction(task.direction.data(), static_cast<Index>(frame_.rank));
  walker.walk.start_ray(direction, static_cast<std::uint32_t>(point_count_), inner_radius_);
  return true;
}

/// Is the point that is asked about proven to be inside? Then the walk is done. The points on the axes may
/// stand in the proof though the hull is that without the point: they are inside the hull with it, so its own
/// weight in what they are made of is less than one, and can be taken to the other side.
bool RayShooter::ends_inside(Walker& walker) const {
  if (!walker.asks_inside || walker.walk.gauge() > 1.0 + kAbove) return false;
  if (!walker.walk.refresh(points())) {
    walker.state = Walker::State::kDone;
    return true;
  }
  if (walker.walk.gauge() > 1.0 + kAbove) return false;  // rounding had moved it
  walker.state = Walker::State::kDone;
  walker.result.end = WalkEnd::kInside;
  walker.note_proof();
  return true;
}

/// Is no point of the core as far along the plane's normal as the point that is asked about? Not where single
/// precision could not tell the point from the plane.
bool RayShooter::separates(Walker& walker, const DirectionQuery& answer) const {
  if (!walker.asks_inside) return false;
  const double error = all_.product_error();
  const double reach = walker.walk.gauge() / walker.direction_length;
  walker.tries_to_separate = static_cast<double>(answer.furthest_product) < reach - 3.0 * error &&
                             reach - 1.0 / walker.direction_length > 8.0 * error;
  return walker.tries_to_separate;
}

void RayShooter::walk_on_core(std::span<Walker*> walkers, const WorkEnd& end, WalkCounters& counters) const {
  const std::size_t rank = frame_.rank;
  std::vector<Walker*> active(walkers.begin(), walkers.end());
  std::vector<float> directions;
  std::vector<DirectionQuery> queries;
  const std::size_t most_pivots = kMaxPivotsPerDimension * rank;
  while (!active.empty() && !end.is_here()) {
    directions.resize(active.size() * rank);
    queries.resize(active.size());
    for (std::size_t row = 0; row < active.size(); ++row) {
      ask(*active[row], core_.product_error(), directions.data() + row * rank);
      queries[row] = active[row]->query;
      // Only the furthest point matters here.
      queries[row].threshold = queries[row].refute;
    }
    scan_directions(core_, directions, queries);
    counters.core_products += active.size() * core_.size();
    std::vector<Walker*> rest;
    for (std::size_t row = 0; row < active.size(); ++row) {
      Walker& walker = *active[row];
      if (!queries[row].is_refuted || separates(walker, queries[row])) {
        walker.state = Walker::State::kOnAll;
        continue;
      }
      ++counters.pivots;
      if (!walker.walk.pivot(points(), queries[row].furthest) || walker.walk.pivot_count() > most_pivots) {
        walker.state = Walker::State::kDone;
      } else if (!ends_inside(walker)) {
        rest.push_back(&walker);
      }
    }
    active = std::move(rest);
  }
}

/// The plane has been multiplied with all points: is it a facet's?
void RayShooter::decide(Walker& walker) const {
  walker.state = Walker::State::kOnCore;
  const bool tried_to_separate = std::exchange(walker.tries_to_separate, false);
  const FramePoints all = points();
  if (walker.query.is_refuted) return take_in(walker.query.furthest, walker);
  const Eigen::VectorXd& plane = walker.walk.plane();
  if (tried_to_separate) {
    walker.state = Walker::State::kDone;
    WalkResult& result = walker.result;
    result.end = WalkEnd::kOutside;
    result.plane.assign(plane.data(), plane.data() + plane.size());
    result.gauge = walker.walk.gauge();
    // Products are below the query's threshold by more than half of what it leaves to the gauge.
    result.gap = 0.5 * all_.product_error() * walker.direction_length;
    result.level = result.gauge - result.gap;
    return;
  }
  if (walker.walk.turns()) {  // no point beyond the ridge: the facet is all there is
    walker.state = Walker::State::kDone;
    return;
  }
  const double above = kAbove + unit_roundoff_bound(all, plane.norm());
  double worst = above;
  std::uint32_t worst_id = DirectionQuery::kNoPoint;
  for (const std::uint32_t id : walker.query.near) {
    const double gauge = plane.dot(all.point(id)) - 1.0;
    if (gauge <= worst) continue;
    worst = gauge;
    worst_id = id;
  }
  if (worst_id != DirectionQuery::kNoPoint) return take_in(worst_id, walker);
  end_at_facet(above, walker);
}

/// A point that is above the plane.
void RayShooter::take_in(std::uint32_t id, Walker& walker) const {
  walker.additions.push_back(id);
  if (walker.walk.pivot(points(), id) && walker.walk.pivot_count() <= kMaxPivotsPerDimension * frame_.rank) {
    ends_inside(walker);
  } else {
    walker.state = Walker::State::kDone;
  }
}

/// No point is above the plane by more than `above`, a gauge.
void RayShooter::end_at_facet(double above, Walker& walker) const {
  const Eigen::VectorXd& plane = walker.walk.plane();
  WalkResult& result = walker.result;
  walker.state = Walker::State::kDone;
  result.gauge = walker.walk.gauge();
  result.plane.assign(plane.data(), plane.data() + plane.size());
  if (walker.asks_inside) {
    result.end = result.gauge > 1.0 + 2.0 * above ? WalkEnd::kOutside : WalkEnd::kInside;
    result.level = 0.5 * (1.0 + above + result.gauge);
    result.gap = 0.5 * (result.gauge - 1.0 - above);
    walker.note_proof();
    return;
  }
  result.end = WalkEnd::kFacet;
  result.coplanar = kCoplanarToAbove * above;
  for (const std::uint32_t id : walker.query.near) {
    if (plane.dot(points().point(id)) - 1.0 >= -result.coplanar) result.on_plane.push_back(id);
  }
  std::sort(result.on_plane.begin(), result.on_plane.end());
  result.basis = walker.walk.basis();
  result.determinant = walker.walk.determinant();
}

std::vector<WalkResult> RayShooter::walk(std::span<const WalkTask> tasks, std::stop_token stop,
                                         const WorkEnd& end) {
  const std::size_t rank = frame_.rank;
  std::vector<WalkResult> results(tasks.size());
  std::vector<Walker> window(std::min(kWindow, tasks.size()));
  std::vector<Walker*> free_walkers, active;
  for (Walker& walker : window) free_walkers.push_back(&walker);
  std::size_t next_task = 0;
  std::vector<float> directions;
  std::vector<DirectionQuery> queries;
  while (true) {
    const std::size_t last_old = active.size();
    while (!free_walkers.empty() && next_task < tasks.size() && !stop.stop_requested()) {
      free_walkers.back()->task = next_task++;
      active.push_back(free_walkers.back());
      free_walkers.pop_back();
    }
    if (active.empty() || end.is_here()) break;
    const std::size_t groups = (active.size() + kWalksPerGroup - 1) / kWalksPerGroup;
    std::vector<WalkCounters> group_counters(groups);
    for_each_block(groups, 1, [&](std::size_t group, std::size_t) {
      std::vector<Walker*> members;
      const Walker* begun = nullptr;
      const std::size_t last = std::min((group + 1) * kWalksPerGroup, active.size());
      for (std::size_t row = group * kWalksPerGroup; row < last; ++row) {  // those of a facet side by side
        Walker& walker = *active[row];
        if (row >= last_old && !begin(tasks[walker.task], begun, walker)) walker.state = Walker::State::kDone;
        if (walker.state != Walker::State::kOnCore) continue;
        members.push_back(&walker);
        if (walker.walk.turns()) begun = &walker;
      }
      walk_on_core(members, end, group_counters[group]);
      for (Walker* const walker : members) {
        if (walker->state == Walker::State::kOnAll && !walker->walk.turns() &&
            !walker->walk.refresh(points())) {
          walker->state = Walker::State::kDone;
        }
      }
    });
    for (const WalkCounters& counters : group_counters) {
      counters_.pivots += counters.pivots;
      counters_.core_products += counters.core_products;
    }

    std::vector<Walker*> asking;
    for (Walker* const walker : active) {
      if (walker->state == Walker::State::kOnAll) asking.push_back(walker);
    }
    directions.resize(asking.size() * rank);
    queries.resize(asking.size());
    for (std::size_t row = 0; row < asking.size(); ++row) {
      ask(*asking[row], all_.product_error(), directions.data() + row * rank);
      queries[row] = std::move(asking[row]->query);
    }
    scan_directions_in_parallel(all_, directions, queries);
    counters_.all_products += asking.size() * all_.size();
    for_each_block(asking.size(), 1, [&](std::size_t row, std::size_t) {
      asking[row]->query = std::move(queries[row]);
      decide(*asking[row]);
    });

    std::vector<Walker*> rest;
    for (Walker* const walker : active) {
      for (const std::uint32_t id : walker->additions) add_to_core(id);
      walker->additions.clear();
      if (walker->state != Walker::State::kDone) {
        rest.push_back(walker);
        continue;
      }
      ++counters_.walks;
      if (walker->result.end == WalkEnd::kOpen) ++counters_.open;
      results[walker->task] = std::move(walker->result);
      free_walkers.push_back(walker);
    }
    active = std::move(rest);
  }
  return results;
}

}  // namespace ndhull
