// Points in blocks against planes in chunks, in vectors; what the error bound leaves open is refined pair by
// pair.
//
// 1. A task takes a chunk of planes and a slab of points. It subtracts the reference, finds the largest
//    |x_k - r_k| of the slab, and from that one error bound for each plane.
// 2. The vector loop returns values above a threshold: pairs that may be above (value > -bound), and pairs
//    that may be the worst of all. What the worst is at least is known to all tasks and only rises, so a pair
//    that is passed over can never be it: the result does not depend on the order of the tasks.
// 3. For what it returns, double arithmetic decides where it can, plane_value where it cannot.
//
// Error bound, u = 2^-53, S = sum |n_k| max |x_k - r_k| + |offset| + |claimed unit|: the difference adds u to
// a term, the vector loop (d + 2) u, folding claimed unit into the offset 3 u: below (d + 6) u S to first
// order. The bound takes (d + 10) u S, which covers second order and the rounding of S, and a subnormal for
// each operation.

#include "approx/planes/plane_scan.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "approx/planes/plane_scan_kernel.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

constexpr double kUnitRoundoff = 0x1p-53;
constexpr double kSubnormal = 0x1p-1068;
/// Above this a sum of products may overflow; such planes are refined at every point.
constexpr double kNearOverflow = 1e300;
/// Planes and points of one task: planes stay in the second-level cache (256 kB in 8-d), and setting up
/// both costs less than a hundredth of their 10^7 pairs.
constexpr std::size_t kPlanesPerTask = 4096;
constexpr std::size_t kPointsPerTask = 4096;

/// Length of a vector, without overflow; the same on every machine. 1 for the zero vector.
double length_or_one(std::span<const double> vector) {
  double largest = 0.0;
  for (const double value : vector) largest = std::max(largest, std::fabs(value));
  if (largest == 0.0) return 1.0;
  double sum = 0.0;
  for (const double value : vector) sum += (value / largest) * (value / largest);
  return largest * std::sqrt(sum);
}

bool is_worse(const PlanePair& a, const PlanePair& b) {
  if (a.distance != b.distance) return a.distance > b.distance;
  return a.point != b.point ? a.point < b.point : a.plane < b.plane;
}

constexpr PlanePair kNoPair{-HUGE_VAL, static_cast<std::size_t>(-1), static_cast<std::size_t>(-1)};

/// The largest distance found so far by any task. Reading an old one is harmless: it only passes fewer pairs.
class WorstKnown {
 public:
  double get() const { return value_.load(std::memory_order_relaxed); }
  void raise(double distance) {
    double now = get();
    while (now < distance && !value_.compare_exchange_weak(now, distance, std::memory_order_relaxed)) {
    }
  }

 private:
  std::atomic<double> value_{-HUGE_VAL};
};

/// One task: its planes, prepared, and its part of the result.
class Task {
 public:
  Task(const PointView& points, const PlaneSource& source, DoubtfulSign doubtful, WorstKnown& worst_known)
      : points_(points), source_(source), doubtful_(doubtful), worst_known_(worst_known) {
    result_.worst = kNoPair;
    point_.resize(points.dimension);
  }

  PlaneScan run(std::size_t first_point, std::size_t end_point, std::size_t first_plane,
                std::size_t end_plane) {
    first_plane_ = first_plane;
    load_points(first_point, end_point);
    load_planes(end_plane);
    const std::size_t block_size = points_.dimension * kScanBlock;
    for (std::size_t block = 0; block * block_size < blocks_.size(); ++block) {
      set_thresholds();
      hits_.clear();
      find_above(planes_, blocks_.data() + block * block_size, hits_);
      for (const ScanHit& hit : hits_) {
        const std::size_t point = first_point + block * kScanBlock + hit.point;
        if (point < end_point) judge(hit, point);
      }
    }
    result_.pairs = static_cast<std::uint64_t>(end_point - first_point) * (end_plane - first_plane);
    return result_;
  }

 private:
  /// Blocks of the points less the reference of the first plane: all planes of a source share it.
  void load_points(std::size_t first, std::size_t end) {
    const std::size_t d = points_.dimension;
    const std::span<const double> reference = source_.plane(first_plane_).reference;
    blocks_.assign((end - first + kScanBlock - 1) / kScanBlock * kScanBlock * d, 0.0);
    largest_.assign(d, 0.0);
    for (std::size_t point = first; point < end; ++point) {
      const std::size_t column = (point - first) % kScanBlock;
      double* const block = blocks_.data() + (point - first - column) * d;
      for (std::size_t k = 0; k < d; ++k) {
        const double x = points_.at(point, k) - (reference.empty() ? 0.0 : reference[k]);
        block[k * kScanBlock + column] = x;
        largest_[k] = std::max(largest_[k], std::fabs(x));
      }
    }
  }

  void load_planes(std::size_t end_plane) {
    const std::size_t d = points_.dimension;
    const std::size_t count = end_plane - first_plane_;
    planes_.dimension = d;
    planes_.normals.resize(count * d);
    planes_.offsets.resize(count);
    planes_.thresholds.resize(count);
    bounds_.resize(count);
    lengths_.resize(count);
    for (std::size_t row = 0; row < count; ++row) {
      const CentredPlane plane = source_.plane(first_plane_ + row);
      std::copy(plane.normal.begin(), plane.normal.end(),
                planes_.normals.begin() + static_cast<std::ptrdiff_t>(row * d));
      const double claim = plane.claimed * plane.unit;
      planes_.offsets[row] = plane.offset - claim;
      double magnitude = std::fabs(plane.offset) + std::fabs(claim);
      for (std::size_t k = 0; k < d; ++k) magnitude += std::fabs(plane.normal[k]) * largest_[k];
      bounds_[row] = magnitude < kNearOverflow
                         ? static_cast<double>(d + 10) * (kUnitRoundoff * magnitude + kSubnormal)
                         : HUGE_VAL;
      lengths_[row] = length_or_one(plane.normal);
    }
  }

  /// Lowest value of a plane that may matter: -bound, or less while the worst distance known is below that.
  void set_thresholds() {
    const double worst = worst_known_.get();
    for (std::size_t row = 0; row < bounds_.size(); ++row) {
      planes_.thresholds[row] = std::min(-bounds_[row], lowest_worst(row, worst));
    }
  }

  /// A value at or below this cannot have a distance of `worst` or more; the last term covers the rounding of
  /// length and division.
  double lowest_worst(std::size_t row, double worst) const {
    const double value = worst * lengths_[row];
    const double slack =
        bounds_[row] + static_cast<double>(points_.dimension + 8) * kUnitRoundoff * std::fabs(value);
    return value - slack - kSubnormal;
  }

  void judge(const ScanHit& hit, std::size_t point) {
    const double bound = bounds_[hit.plane];
    const bool open = !(hit.value > bound || hit.value < -bound);
    if (hit.value > bound) ++result_.above;
    const bool may_be_worst = !(hit.value < lowest_worst(hit.plane, worst_known_.get()));
    if (!open && !may_be_worst) return;
    points_.copy_row(point, point_.data());
    const CentredPlane plane = source_.plane(first_plane_ + hit.plane);
    const double value = plane_value(plane, point_, open ? doubtful_ : DoubtfulSign::kExtendedThenExact);
    if (open) {
      ++result_.refined;
      if (value > 0.0) ++result_.above;
    }
    const PlanePair pair{signed_distance(value, lengths_[hit.plane]), point, first_plane_ + hit.plane};
    if (is_worse(pair, result_.worst)) result_.worst = pair;
    worst_known_.raise(pair.distance);
  }

  /// Keeps the sign where the quotient underflows.
  static double signed_distance(double value, double length) {
    const double distance = value / length;
    if (distance != 0.0 || value == 0.0) return distance;
    return std::copysign(std::numeric_limits<double>::denorm_min(), value);
  }

  const PointView& points_;
  const PlaneSource& source_;
  DoubtfulSign doubtful_;
  WorstKnown& worst_known_;
  std::size_t first_plane_ = 0;
  std::vector<double> blocks_;   // blocks of dimension x kScanBlock
  std::vector<double> largest_;  // per column: largest |x_k - r_k| of the slab
  std::vector<double> bounds_, lengths_;
  std::vector<double> point_;
  ScanPlanes planes_;
  std::vector<ScanHit> hits_;
  PlaneScan result_;
};

PlaneScan joined(PlaneScan a, const PlaneScan& b) {
  a.pairs += b.pairs;
  a.above += b.above;
  a.refined += b.refined;
  if (is_worse(b.worst, a.worst)) a.worst = b.worst;
  return a;
}

}  // namespace

PlaneScan scan_planes(const PointView& points, const PlaneSource& planes, DoubtfulSign doubtful) {
  if (points.rows == 0 || planes.count() == 0) return {};
  PlaneScan nothing;
  nothing.worst = kNoPair;
  // One value that is reached, so that the first blocks do not return all of their pairs.
  WorstKnown worst_known;
  std::vector<double> first(points.dimension);
  points.copy_row(0, first.data());
  for (std::size_t row = 0; row < std::min(planes.count(), kPlanesPerTask); ++row) {
    const CentredPlane plane = planes.plane(row);
    worst_known.raise(plane_value(plane, first, DoubtfulSign::kExtendedThenExact) /
                      length_or_one(plane.normal));
  }

  const auto slabs = [](std::size_t count, std::size_t size) { return (count + size - 1) / size; };
  const std::size_t chunks = slabs(planes.count(), kPlanesPerTask);
  const std::size_t tasks = slabs(points.rows, kPointsPerTask) * chunks;
  constexpr std::size_t kMostParts = 4096;
  const std::size_t tasks_at_a_time = slabs(tasks, kMostParts);
  std::vector<PlaneScan> parts(slabs(tasks, tasks_at_a_time), nothing);
  for_each_block(tasks, tasks_at_a_time, [&](std::size_t begin, std::size_t end) {
    PlaneScan& part = parts[begin / tasks_at_a_time];
    for (std::size_t one = begin; one != end; ++one) {
      const std::size_t slab = one / chunks, chunk = one % chunks;
      Task task(points, planes, doubtful, worst_known);
      part = joined(part,
                    task.run(slab * kPointsPerTask, std::min(points.rows, (slab + 1) * kPointsPerTask),
                             chunk * kPlanesPerTask, std::min(planes.count(), (chunk + 1) * kPlanesPerTask)));
    }
  });
  PlaneScan all = nothing;
  for (const PlaneScan& part : parts) all = joined(all, part);
  return all;
}

}  // namespace ndhull
