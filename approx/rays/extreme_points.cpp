#include "approx/rays/extreme_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "approx/rays/near_copies.h"
#include "approx/rays/parting_planes.h"
#include "approx/rays/ray_shooting.h"
#include "core/error.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

/// Points that are asked about between two looks at the clock.
constexpr std::size_t kBatch = 2048;
/// So near to an earlier point a point is met as that: each would be inside the hull of the others, with the
/// other among them, by rounding. [ratio to the longest point] A quarter of what tells inside from outside:
/// planes part vertices by more.
constexpr double kNear = 2.5e-13;
/// What is so near to a vertex is none: it is outside the hull of the others by no more than tells inside
/// from outside. [ratio to the longest point]
constexpr double kAsGoodAsEqual = 2e-12;

/// Points far from the origin, seen from one of them: no point inside a hull that is a few roundings of its
/// coordinates thick has coordinates, unless they are taken off first.
struct NearOrigin {
  std::vector<double> origin;  // what is taken off
  std::vector<double> coordinates;
  PointView view;

  explicit NearOrigin(const PointView& points) : origin(points.dimension, 0.0), view(points) {
    if (!is_far(points)) return;
    const std::size_t dimension = points.dimension;
    std::vector<double> first(dimension);
    points.copy_row(0, first.data());
    coordinates.resize(points.rows * dimension);
    for (std::size_t row = 0; row < points.rows; ++row) {
      for (std::size_t k = 0; k < dimension; ++k) {
        const double x = points.at(row, k), difference = x - first[k], back = x - difference;
        const double rounding = (x - (difference + back)) + (back - first[k]);
        if (rounding != 0.0) return;  // the points would be others
        coordinates[row * dimension + k] = difference;
      }
    }
    const auto near = PointView::row_major(coordinates.data(), points.rows, dimension);
    // What is flat but for the rounding of its coordinates stays so.
    if (fit_frame(near).rank != fit_frame(points).rank) return;
    origin = first;
    view = near;
  }

 private:
  /// Is a column far from 0 for its extent?
  static bool is_far(const PointView& points) {
    constexpr double kFar = 16.0;
    for (std::size_t k = 0; k < points.dimension; ++k) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (std::size_t row = 0; row < points.rows; ++row) {
        low = std::min(low, points.at(row, k));
        high = std::max(high, points.at(row, k));
      }
      if (std::max(-low, high) > kFar * (high - low)) return true;
    }
    return false;
  }
};

/// The two ends of points on a line, parted from the rest half way to the next point.
std::vector<PartingPlane> ends_of_segment(const NearOrigin& points, const RayShooter& shooter) {
  std::vector<std::uint32_t> order(shooter.distinct_count());
  for (std::size_t row = 0; row < order.size(); ++row) order[row] = shooter.distinct_point(row);
  const auto at = [&shooter](std::uint32_t id) { return *shooter.points().row(id); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return at(a) < at(b); });
  const PartingPlaneMap to_input(points.view, shooter.frame(), points.origin);
  const auto end = [&](std::uint32_t id, std::uint32_t next, double sign) {
    const double level = 0.5 * sign * (at(id) + at(next)), gap = 0.5 * sign * (at(id) - at(next));
    return to_input.map(id, {&sign, 1}, level, gap);
  };
  const std::size_t last = order.size() - 1;
  return {end(order[0], order[1], -1.0), end(order[last], order[last - 1], 1.0)};
}

/// Are points vertices? Walks of a shooter, and what their ends prove.
class WalkEnds {
 public:
  /// `origin` was taken off the points.
  WalkEnds(const PointView& points, std::span<const double> origin, RayShooter& shooter)
      : shooter_(shooter),
        to_input_(points, shooter.frame(), origin),
        is_doubtful_(shooter.point_count(), 1) {
    if (shooter.distinct_count() < shooter.point_count())
      copies_apart_ = kNear * shooter.points().largest_length;
  }

  /// Asks about points, whose ids are those of the shooter.
  void ask(std::span<const std::uint32_t> ids, const WorkEnd& end) {
    const std::size_t rank = shooter_.frame().rank;
    std::vector<WalkTask> tasks;
    for (const std::uint32_t id : ids) {
      const double* const point = shooter_.points().row(id);
      tasks.push_back({.direction = {point, point + rank}, .skip = id, .asks_inside = true});
    }
    std::vector<WalkResult> walks = shooter_.walk(tasks, {}, end);
    for (std::size_t row = 0; row < tasks.size(); ++row) note(ids[row], walks[row]);
  }

  /// Two points at a sharp corner can each be inside the hull of the others by rounding, by way of the other:
  /// that proves nothing. What is a combination of such points, but for a small part, stays open.
  void settle_inside() {
    for (std::uint8_t& flag : is_doubtful_) flag = 0;
    for (const InsidePoint& point : inside_) is_doubtful_[point.id] = 1;
    for (std::size_t before = SIZE_MAX; inside_.size() < before;) {
      before = inside_.size();
      std::erase_if(inside_, [&](const InsidePoint& point) {
        if (!is_proven(point)) return false;
        is_doubtful_[point.id] = 0;
        inside.push_back(point.id);
        return true;
      });
    }
    for (const InsidePoint& point : inside_) open.push_back(point.id);
    inside_.clear();
  }

  /// It is known where this point is.
  void take_as_known(std::uint32_t id) { is_doubtful_[id] = 0; }

  std::vector<PartingPlane> found;
  std::vector<std::uint32_t> inside, open;  // complete after settle_inside

 private:
  struct InsidePoint {
    std::uint32_t id;
    std::vector<std::uint32_t> basis;
    std::vector<double> weights;
  };

  void note(std::uint32_t id, WalkResult& walk) {
    switch (walk.end) {
      case WalkEnd::kInside: {
        InsidePoint point{id, std::move(walk.basis), std::move(walk.weights)};
        if (is_proven(point)) {
          inside.push_back(id);
        } else {
          inside_.push_back(std::move(point));
        }
        return;
      }
      case WalkEnd::kOutside:
        shooter_.add_to_core(id);
        is_doubtful_[id] = 0;
        // What goes with another point may be higher than that by as much as both are apart.
        walk.gap -= copies_apart_ * std::sqrt(std::inner_product(walk.plane.begin(), walk.plane.end(),
                                                                 walk.plane.begin(), 0.0));
        found.push_back(to_input_.map(id, walk.plane, walk.level, walk.gap));
        return;
      case WalkEnd::kNotBegun: return;
      case WalkEnd::kFacet:
      case WalkEnd::kOpen: open.push_back(id); return;
    }
  }

  /// Is more than a small part of what the point is a combination of beyond doubt?
  bool is_proven(const InsidePoint& point) const {
    constexpr double kSmallPart = 1.0 / 16.0;
    double doubt = 0.0, all = 0.0;
    for (std::size_t k = 0; k < point.basis.size(); ++k) {
      all += point.weights[k];
      if (point.basis[k] < is_doubtful_.size() && is_doubtful_[point.basis[k]] != 0)
        doubt += point.weights[k];
    }
    return all - doubt >= kSmallPart * all;
  }

  RayShooter& shooter_;
  PartingPlaneMap to_input_;
  double copies_apart_ = 0.0;              // [distance in the frame]
  std::vector<std::uint8_t> is_doubtful_;  // one a point: not known to be a vertex
  std::vector<InsidePoint> inside_;        // not proven so far
};

class ExtremeSearch {
 public:
  ExtremeSearch(const PointView& points, const ExtremeOptions& options, Clock::time_point start)
      : points_(points),
        options_(options),
        end_(options.max_seconds, options.stop, start),
        seen_(points),
        shooter_(seen_.view, kNear) {
    stands_for_.assign(shooter_.copy_of().begin(), shooter_.copy_of().end());
    is_inside_.assign(points.rows, 0);
  }

  const Frame& frame() const { return shooter_.frame(); }
  std::vector<double> interior_point() const {
    std::vector<double> point = frame().centre;
    for (std::size_t k = 0; k < point.size(); ++k) point[k] += seen_.origin[k];
    return point;
  }

  void run(ExtremePoints& result) {
    if (frame().rank == 1) {
      planes_ = ends_of_segment(seen_, shooter_);
      std::fill(is_inside_.begin(), is_inside_.end(), 1);
      for (const PartingPlane& plane : planes_) is_inside_[plane.vertex] = 0;
    } else {
      const std::vector<std::uint32_t> open = ask_about_all(result);
      if (!open.empty() && !is_over(result)) ask_again(open, result);
    }
    settle(result);
    for (const PartingPlane& plane : planes_) {
      result.vertices.push_back(PointId{plane.vertex});
      result.planes.insert(result.planes.end(), plane.normal.begin(), plane.normal.end());
      result.planes.push_back(plane.offset);
      result.copies.push_back(static_cast<std::uint32_t>(1 + plane.above.size()));
    }
    count_others(result);
  }

 private:
  bool is_over(ExtremePoints& result) const {
    if (!end_.is_here()) return false;
    result.status = options_.stop.stop_requested() ? ExtremeStatus::kInterrupted : ExtremeStatus::kTimeLimit;
    return true;
  }

  /// The longest points first: those are vertices more often than others. Returns what stays open.
  std::vector<std::uint32_t> ask_about_all(ExtremePoints& result) {
    const std::size_t count = shooter_.distinct_count();
    std::vector<std::uint32_t> ids(count);
    for (std::size_t row = 0; row < count; ++row) ids[row] = shooter_.distinct_point(row);
    WalkEnds walks(seen_.view, seen_.origin, shooter_);
    std::size_t first = 0;
    for (; first < count && !is_over(result); first += kBatch) {
      walks.ask(std::span(ids).subspan(first, std::min(kBatch, count - first)), end_);
      if (options_.progress) {
        options_.progress("vertices " + std::to_string(walks.found.size()) + ", points left " +
                          std::to_string(count - std::min(first + kBatch, count)));
      }
    }
    walks.settle_inside();
    is_over(result);
    for (const std::uint32_t id : walks.inside) is_inside_[id] = 1;
    planes_ = std::move(walks.found);
    std::sort(walks.open.begin(), walks.open.end());
    return std::move(walks.open);
  }

  /// Of open points that are as good as equal one is asked about, beside the vertices alone; what is as good
  /// as equal to a vertex goes with it.
  void ask_again(std::span<const std::uint32_t> open, ExtremePoints& result) {
    const std::size_t rank = frame().rank, known = planes_.size();
    std::vector<std::uint32_t> ids;
    for (const PartingPlane& plane : planes_) ids.push_back(plane.vertex);
    ids.insert(ids.end(), open.begin(), open.end());
    std::vector<double> rows;
    for (const std::uint32_t id : ids)
      rows.insert(rows.end(), shooter_.points().row(id), shooter_.points().row(id) + rank);
    const std::vector<std::uint32_t> first_of = find_near_copies(rows.data(), ids.size(), rank, near());
    std::vector<std::uint32_t> among_ids(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(known)),
        asked;
    for (std::size_t i = known; i < ids.size(); ++i) {
      stands_for_[ids[i]] = ids[first_of[i]];
      if (first_of[i] != i) continue;
      asked.push_back(static_cast<std::uint32_t>(among_ids.size()));
      among_ids.push_back(ids[i]);
    }
    std::vector<double> coordinates(among_ids.size() * points_.dimension);
    for (std::size_t i = 0; i < among_ids.size(); ++i)
      seen_.view.copy_row(among_ids[i], coordinates.data() + i * points_.dimension);
    const auto some = PointView::row_major(coordinates.data(), among_ids.size(), points_.dimension);
    RayShooter among(some);
    if (among.frame().rank != rank) return;
    WalkEnds walks(some, seen_.origin, among);
    for (std::uint32_t i = 0; i < known; ++i) walks.take_as_known(i);
    walks.ask(asked, end_);
    walks.settle_inside();
    is_over(result);
    for (const std::uint32_t i : walks.inside) is_inside_[among_ids[i]] = 1;
    for (PartingPlane& plane : walks.found) {
      plane.vertex = among_ids[plane.vertex];
      plane.gap = 0.0;  // parted from those alone
      planes_.push_back(std::move(plane));
    }
  }

  void settle(ExtremePoints& result) {
    std::sort(planes_.begin(), planes_.end(),
              [](const PartingPlane& a, const PartingPlane& b) { return a.vertex < b.vertex; });
    const std::span<const double> in_frame(shooter_.points().coordinates, points_.rows * frame().rank);
    const bool is_whole = settle_planes(
        points_, in_frame, near(), [this] { return end_.is_here(); }, planes_);
    if (!is_whole) is_over(result);
  }

  double near() const { return kAsGoodAsEqual * shooter_.points().largest_length; }

  /// What is no vertex: a copy, inside, or open. What goes with another point is what that is.
  void count_others(ExtremePoints& result) const {
    std::vector<std::uint32_t> plane_of(points_.rows, kNone), copied(points_.rows, kNone);
    for (std::uint32_t row = 0; row < planes_.size(); ++row) plane_of[planes_[row].vertex] = row;
    for (std::uint32_t row = 0; row < planes_.size(); ++row)
      for (const std::uint32_t id : planes_[row].above) copied[id] = row;
    std::vector<double> point(points_.dimension), first(points_.dimension);
    for (std::uint32_t id = 0; id < points_.rows; ++id) {
      if (plane_of[id] != kNone || copied[id] != kNone) continue;
      const std::uint32_t like = shooter_.copy_of()[id];
      points_.copy_row(id, point.data());
      points_.copy_row(like, first.data());
      const bool is_equal = like != id && point == first;
      const std::uint32_t root = stands_for_[like], row = plane_of[root];
      if (row != kNone && !planes_[row].is_settled &&
          ((is_equal && like == root) || is_above(planes_[row], point))) {
        ++result.copies[row];
      } else if (is_equal) {
        continue;  // no distinct point
      } else if (row != kNone || is_inside_[root] != 0) {
        ++result.points_inside;
      } else {
        ++result.open_points;
      }
    }
  }

  const PointView& points_;
  const ExtremeOptions& options_;
  WorkEnd end_;
  NearOrigin seen_;
  RayShooter shooter_;
  std::vector<PartingPlane> planes_;
  std::vector<std::uint32_t> stands_for_;  // itself, or the point that it is as good as equal to
  std::vector<std::uint8_t> is_inside_;    // of what stands for itself
};

}  // namespace

std::string_view to_string(ExtremeStatus status) {
  switch (status) {
    case ExtremeStatus::kComplete: return "complete";
    case ExtremeStatus::kTimeLimit: return "time_limit";
    case ExtremeStatus::kInterrupted: return "interrupted";
  }
  return "unknown";
}

ExtremePoints extreme_points(const PointView& points, const ExtremeOptions& options) {
  const Clock::time_point start = Clock::now();
  ExtremePoints result;
  check_shape(points);
  result.point_count = points.rows;
  tbb::task_arena arena = arena_of(options.threads);
  arena.execute([&] {
    ExtremeSearch search(points, options, start);
    const Frame& frame = search.frame();
    result.dimension = frame.dimension;
    result.rank = frame.rank;
    result.interior_point = search.interior_point();
    if (frame.rank > kMaxExtremeRank) {
      throw Error(ErrorCode::kDimensionTooHigh,
                  "points span " + std::to_string(frame.rank) + " dimensions, expected at most " +
                      std::to_string(kMaxExtremeRank) + "; project them to fewer");
    }
    check_extents(frame);
    if (frame.rank == 0) {
      result.vertices.push_back(PointId{0});
      result.copies.push_back(static_cast<std::uint32_t>(points.rows));
      return;
    }
    search.run(result);
  });
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace ndhull
