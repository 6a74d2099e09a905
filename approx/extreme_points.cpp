#include "approx/extreme_points.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "approx/frame_planes.h"
#include "approx/ray_shooting.h"
#include "core/error.h"
#include "core/plane_value.h"
#include "core/stopwatch.h"

namespace ndhull {
namespace {

/// Points that are asked about between two looks at the clock.
constexpr std::size_t kBatch = 2048;
/// So near to an earlier point a point is met as that: each would be inside the hull of the others, with the
/// other among them, by rounding. [ratio to the longest point] A quarter of what tells inside from outside:
/// planes part vertices by more.
constexpr double kNear = 2.5e-13;

/// A vertex and the plane in the frame that parts it: a.y = level.
struct FoundVertex {
  std::uint32_t id;
  std::vector<double> plane;
  double level;
};

/// The two ends of points on a line, parted from the rest half way to the next point.
std::vector<FoundVertex> ends_of_segment(const RayShooter& shooter) {
  std::vector<std::uint32_t> order(shooter.distinct_count());
  for (std::size_t row = 0; row < order.size(); ++row) order[row] = shooter.distinct_point(row);
  const auto at = [&shooter](std::uint32_t id) { return *shooter.points().row(id); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return at(a) < at(b); });
  const std::size_t last = order.size() - 1;
  return {{order[0], {-1.0}, -0.5 * (at(order[0]) + at(order[1]))},
          {order[last], {1.0}, 0.5 * (at(order[last]) + at(order[last - 1]))}};
}

class ExtremeSearch {
 public:
  ExtremeSearch(RayShooter& shooter, const ExtremeOptions& options, Clock::time_point start)
      : shooter_(shooter), options_(options), start_(start), is_doubtful_(shooter.point_count(), 1) {}

  /// Asks about every distinct point, the longest first: those are vertices more often than others.
  void run(ExtremePoints& result) {
    const std::size_t rank = shooter_.frame().rank;
    const std::size_t count = shooter_.distinct_count();
    std::size_t first = 0;
    for (; first < count && !is_over(result); first += kBatch) {
      std::vector<WalkTask> tasks;
      for (std::size_t row = first; row < std::min(first + kBatch, count); ++row) {
        const std::uint32_t id = shooter_.distinct_point(row);
        const double* const point = shooter_.points().row(id);
        tasks.push_back({.direction = {point, point + rank}, .skip = id, .asks_inside = true});
      }
      std::vector<WalkResult> walks = shooter_.walk(tasks, options_.stop);
      for (std::size_t row = 0; row < tasks.size(); ++row) note(tasks[row].skip, walks[row], result);
      if (options_.progress) {
        options_.progress("vertices " + std::to_string(found_.size()) + ", points left " +
                          std::to_string(count - std::min(first + kBatch, count)));
      }
    }
    result.open_points += first < count ? count - first : 0;
    count_inside(result);
  }

  std::vector<FoundVertex>& found() { return found_; }

 private:
  struct InsidePoint {
    std::uint32_t id;
    std::vector<std::uint32_t> basis;
    std::vector<double> weights;
  };

  bool is_over(ExtremePoints& result) const {
    if (options_.stop.stop_requested()) result.status = ExtremeStatus::kInterrupted;
    if (options_.max_seconds > 0.0 && seconds_since(start_) > options_.max_seconds) {
      result.status = ExtremeStatus::kTimeLimit;
    }
    return result.status != ExtremeStatus::kComplete;
  }

  void note(std::uint32_t id, WalkResult& walk, ExtremePoints& result) {
    switch (walk.end) {
      case WalkEnd::kInside: {
        InsidePoint point{id, std::move(walk.basis), std::move(walk.weights)};
        if (is_proven(point)) {
          ++result.points_inside;
        } else {
          inside_.push_back(std::move(point));
        }
        return;
      }
      case WalkEnd::kOutside:
        shooter_.add_to_core(id);
        is_doubtful_[id] = 0;
        found_.push_back({id, std::move(walk.plane), walk.level});
        return;
      case WalkEnd::kNotBegun: result.status = ExtremeStatus::kInterrupted; [[fallthrough]];
      case WalkEnd::kFacet:
      case WalkEnd::kOpen: ++result.open_points; return;
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

  /// Two points at a sharp corner can each be inside the hull of the others by rounding, by way of the other:
  /// that proves nothing. What is a combination of such points, but for a small part, stays open.
  void count_inside(ExtremePoints& result) {
    for (std::uint8_t& flag : is_doubtful_) flag = 0;
    for (const InsidePoint& point : inside_) is_doubtful_[point.id] = 1;
    for (std::size_t before = SIZE_MAX; inside_.size() < before;) {
      before = inside_.size();
      std::erase_if(inside_, [&](const InsidePoint& point) {
        if (!is_proven(point)) return false;
        is_doubtful_[point.id] = 0;
        return true;
      });
      result.points_inside += before - inside_.size();
    }
    result.open_points += inside_.size();
  }

  RayShooter& shooter_;
  const ExtremeOptions& options_;
  Clock::time_point start_;
  std::vector<FoundVertex> found_;
  std::vector<std::uint8_t> is_doubtful_;  // one a point: not known to be a vertex
  std::vector<InsidePoint> inside_;        // not proven so far
};

void count_copies(const PointView& points, const RayShooter& shooter, ExtremePoints& result) {
  const std::size_t dimension = result.dimension;
  std::vector<std::uint32_t> vertex_of(points.rows, kNone);
  for (std::uint32_t row = 0; row < result.vertices.size(); ++row)
    vertex_of[result.vertices[row].value] = row;
  result.copies.assign(result.vertices.size(), 1);
  std::vector<double> first(dimension), other(dimension);
  for (std::uint32_t id = 0; id < points.rows; ++id) {
    const std::uint32_t copied = shooter.copy_of()[id], row = vertex_of[copied];
    if (copied == id) continue;
    points.copy_row(copied, first.data());
    points.copy_row(id, other.data());
    bool is_copy = first == other;
    if (!is_copy && row != kNone) {
      const std::span<const double> plane(result.planes.data() + row * (dimension + 1), dimension + 1);
      const CentredPlane halfspace{plane.first(dimension), {}, plane[dimension], 0.0, 1.0};
      is_copy = plane_sign(halfspace, other, DoubtfulSign::kExtendedThenExact) > 0.0;
    }
    if (!is_copy) ++result.points_inside;  // a distinct point, as near as it is
    if (is_copy && row != kNone) ++result.copies[row];
  }
}

/// Planes in input units, in the order of the ids. Of points near to a vertex those above its plane are
/// copies.
void write_planes(const PointView& points, std::vector<FoundVertex>& found, const RayShooter& shooter,
                  ExtremePoints& result) {
  const Frame& frame = shooter.frame();
  std::sort(found.begin(), found.end(),
            [](const FoundVertex& a, const FoundVertex& b) { return a.id < b.id; });
  const std::size_t dimension = frame.dimension;
  const NormalMap to_input(frame);
  std::vector<double> normal(dimension);
  for (const FoundVertex& vertex : found) {
    double length = 0.0;
    std::vector<double> plane = vertex.plane;
    to_input.map(plane.data(), 1, normal.data(), &length);
    // a.y = level with a.y = length normal.(x - centre)
    double offset = -vertex.level / length;
    for (std::size_t k = 0; k < dimension; ++k) offset -= normal[k] * frame.centre[k];
    result.vertices.push_back(PointId{vertex.id});
    result.planes.insert(result.planes.end(), normal.begin(), normal.end());
    result.planes.push_back(offset);
  }
  count_copies(points, shooter, result);
}

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
  result.point_count = points.rows;
  tbb::task_arena arena(options.threads == 0 ? tbb::task_arena::automatic
                                             : static_cast<int>(options.threads));
  arena.execute([&] {
    RayShooter shooter(points, kNear);
    const Frame& frame = shooter.frame();
    result.dimension = frame.dimension;
    result.rank = frame.rank;
    result.interior_point = frame.centre;
    if (frame.rank > kMaxExtremeRank) {
      throw Error(ErrorCode::kDimensionTooHigh,
                  "points span " + std::to_string(frame.rank) + " dimensions, expected at most " +
                      std::to_string(kMaxExtremeRank) + "; project them to fewer");
    }
    if (frame.rank == 0) {
      result.vertices.push_back(PointId{0});
      result.copies.push_back(static_cast<std::uint32_t>(points.rows));
      return;
    }
    ExtremeSearch search(shooter, options, start);
    if (frame.rank == 1) {
      search.found() = ends_of_segment(shooter);
      result.points_inside = shooter.distinct_count() - 2;
    } else {
      search.run(result);
    }
    write_planes(points, search.found(), shooter, result);
  });
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace ndhull
