#include "approx/growth/work_limits.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

// Shares of the seconds that growth spent for each simplex it made, all but those for points. Sphere points
// in 8-d and 10-d, with 140 to 300 vertices: 0.3 to 0.5 of it for each simplex that stays, and one product of
// a plane with a vertex 1 / 3500 to 1 / 8000 for each dimension.
constexpr double kPlainShare = 0.4;
constexpr double kSharePerProduct = 1.0 / 5000.0;
/// Coplanar merging, where points were shifted: 9-d and 10-d cubes.
constexpr double kMergeShare = 3.0;
/// Clusters under a rule. Slabs of a width, and their facet table: 1 to 3 on spheres, balls, cubes and
/// gaussian points in 5-d to 10-d, 4 to 6 where many points are left out (balls in 6-d, wine in 11-d).
constexpr double kRuleShare = 10.0, kWidthShare = 3.0, kWidthShareOfMany = 7.0;
/// A point left out, over which slabs are measured: 0.8 us of 1.5 million in 7-d.
constexpr double kMeasureShare = 4.0;
/// Points that are located to learn what that costs; and what walking adds where climbing proves nothing, and
/// the longer ways in a hull that may be twice as large by then: 10-d spheres.
constexpr std::size_t kSampledPoints = 64, kSamplesAgain = 3;
constexpr double kPointShare = 1.5;

/// [bytes] of a simplex beside its planes, vertices and neighbours: state, outside set, free list; then
/// determinant, offsets, widths, area and own id.
constexpr std::uint64_t kFacetBytes = 5 + 4 + 8 + 32 + 4;
/// [bytes] of a simplex that may be merged: cluster, place, flags; beside them the rows are copied once to
/// get their order.
constexpr std::uint64_t kMergeBytes = 64;
/// [bytes] of a simplex for slabs that overlap, or clusters under a rule, and their facets: 20 to 140, on 8-d
/// gaussian points; the more the fewer merge.
constexpr std::uint64_t kCoverBytes = 140;
/// [bytes] of a facet that is a slab, and of each of its coordinates: of hulls in 5-d to 10-d whose simplices
/// hardly merge, which take most, up to 145 in 8-d.
constexpr std::uint64_t kSlabBytes = 96, kSlabCoordinate = 8;
/// [bytes] of a simplex among which a number of facets is looked for, beside its tables; of each facet, and of
/// its coordinates: of hulls in 5-d to 9-d, with facets for one to 1,000 simplices, quick and thorough.
constexpr std::uint64_t kCountBytes = 220, kFacetOfCount = 900, kCoordinateOfCount = 45;
/// [bytes] of a simplex whose slabs are looked at further, as a covering.
constexpr std::uint64_t kCoveringBytes = 60;
/// [bytes] of a simplex that points were searched above: what was found; of a coordinate of these points.
constexpr std::uint64_t kSearchBytes = 32, kSearchedCoordinate = 24;
/// [bytes] Tables grow by huge pages of 2 MiB; some ten are large.
constexpr std::uint64_t kPageBytes = 10 * (std::uint64_t{1} << 21);

}  // namespace

/// [bytes] of a simplex in the end, and when it may be merged with others.
std::uint64_t WorkLimits::row_bytes(const GrowthWork& work, std::size_t dimension, bool merges) const {
  std::uint64_t bytes = 16 * work.rank + kFacetBytes + limits_.bytes_afterwards;
  // Of flat data the normals are longer than the planes and do not take their place.
  if (work.rank != dimension) bytes += 8 * dimension;
  if (merges) bytes += 16 * work.rank + kMergeBytes;
  return bytes;
}

std::uint64_t WorkLimits::rows_for(std::uint64_t bytes_a_row, std::uint64_t point_bytes) const {
  const std::uint64_t whole_pages = std::min(kPageBytes, limits_.most_memory() / 6);
  const std::uint64_t used = point_bytes + whole_pages;
  const std::uint64_t left = limits_.most_memory() > used ? limits_.most_memory() - used : 0;
  return std::max<std::uint64_t>(1, left / bytes_a_row);
}

std::uint64_t WorkLimits::most_rows(const GrowthWork& work, std::size_t dimension,
                                    std::uint64_t point_bytes) const {
  if (limits_.most_memory() == 0) return 0;
  if (gathering_ == Gathering::kCount) return rows_to_choose_from(work, dimension, point_bytes);
  return rows_for(row_bytes(work, dimension, !work.shifted_points.empty()), point_bytes);
}

/// Facets for an eighth of the simplices, if so many are asked for: with more simplices points are less far
/// above them, and facets as narrow as these points allow are fewer.
std::uint64_t WorkLimits::rows_to_choose_from(const GrowthWork& work, std::size_t dimension,
                                              std::uint64_t point_bytes) const {
  constexpr std::uint64_t kSimplicesOfFacet = 8;
  const std::uint64_t row = row_bytes(work, dimension, false) - kFacetBytes + kCountBytes;
  const std::uint64_t facet = chosen_facet_bytes(work);
  const std::uint64_t most_facets = limits_.most_memory() / facet + 1;
  return std::max(rows_for(row + facet / kSimplicesOfFacet, point_bytes),
                  rows_for(row, point_bytes + facet * std::min(facets_, most_facets)));
}

std::uint64_t WorkLimits::chosen_facet_bytes(const GrowthWork& work) {
  return kFacetOfCount + kCoordinateOfCount * work.rank;
}

std::uint64_t WorkLimits::most_facets(const GrowthWork& work, std::uint64_t point_bytes) const {
  if (limits_.most_memory() == 0) return UINT64_MAX;
  const std::uint64_t left = bytes_left(work, point_bytes);
  const std::uint64_t of_rows = work.complex.row_count * (kCountBytes - kFacetBytes);
  return left > of_rows ? (left - of_rows) / chosen_facet_bytes(work) : 0;
}

bool WorkLimits::has_memory_to_cover(const GrowthWork& work, std::size_t dimension,
                                     std::uint64_t point_bytes) const {
  if (limits_.most_memory() == 0) return true;
  return work.complex.row_count <= rows_for(row_bytes(work, dimension, true) + kCoverBytes, point_bytes);
}

bool WorkLimits::has_memory_for_slabs(const GrowthWork& work, std::size_t dimension,
                                      std::uint64_t point_bytes, std::uint64_t slabs,
                                      bool looks_further) const {
  if (limits_.most_memory() == 0) return true;
  std::uint64_t bytes_a_row = row_bytes(work, dimension, !work.shifted_points.empty());
  if (looks_further) bytes_a_row += kCoveringBytes;
  const std::uint64_t slab_bytes = slabs * (kSlabBytes + kSlabCoordinate * dimension);
  return work.complex.row_count <= rows_for(bytes_a_row, point_bytes + slab_bytes);
}

bool WorkLimits::has_memory_to_search(const GrowthWork& work, std::size_t dimension,
                                      std::uint64_t point_bytes, std::uint64_t points) const {
  if (limits_.most_memory() == 0) return true;
  const std::uint64_t bytes_a_row =
      row_bytes(work, dimension, !work.shifted_points.empty()) + 4 * work.rank + 8 * dimension + kSearchBytes;
  const std::uint64_t bytes_of_points = point_bytes + points * dimension * kSearchedCoordinate;
  return work.complex.row_count <= rows_for(bytes_a_row, bytes_of_points);
}

std::uint64_t WorkLimits::bytes_left(const GrowthWork& work, std::uint64_t point_bytes) const {
  if (limits_.most_memory() == 0) return UINT64_MAX;
  const std::uint64_t complex_bytes = work.complex.row_count * (16 * work.rank + kFacetBytes);
  return rows_for(1, point_bytes + complex_bytes);
}

double WorkLimits::seconds_left() const { return limits_.max_seconds - seconds_since(start_); }

double WorkLimits::seconds_per_created(const GrowthWork& work) {
  const GrowthCounters& counters = work.counters;
  const double seconds = counters.seconds_visible + counters.seconds_cone + counters.seconds_match;
  return seconds / static_cast<double>(std::max<std::uint64_t>(1, counters.created));
}

double WorkLimits::sampled_seconds_per_point(const GrowthWork& work, const HullBall& ball,
                                             std::size_t first) {
  std::vector<PointId> sample;
  const std::size_t step = std::max<std::size_t>(1, work.point_count / kSampledPoints);
  for (std::size_t id = first % step; id < work.point_count; id += step)
    sample.push_back(PointId{static_cast<std::uint32_t>(id)});
  const Clock::time_point begin = Clock::now();
  try_inside(work.complex, work.points, ball, sample);
  return kPointShare * seconds_since(begin) / static_cast<double>(sample.size());
}

double WorkLimits::finish_seconds(const GrowthWork& work, const HullBall& ball, std::uint64_t points) {
  const std::uint64_t rows = work.complex.row_count - work.free_count;
  if (rows >= 2 * sampled_at_) {
    sampled_at_ = rows;
    seconds_per_point_ = sampled_seconds_per_point(work, ball, 0);
  }
  const auto vertices = static_cast<double>(work.most_vertices());
  double share = kPlainShare + kSharePerProduct * vertices * static_cast<double>(work.rank);
  if (!work.shifted_points.empty()) share += kMergeShare;
  if (gathering_ == Gathering::kWidth) share += width_share(work, work.points_outside);
  if (gathering_ != Gathering::kCount) share += limits_.share_afterwards;
  const double measured = gathering_ == Gathering::kWidth ? static_cast<double>(work.points_outside) : 0.0;
  return (static_cast<double>(rows) * share + measured * kMeasureShare) * seconds_per_created(work) +
         static_cast<double>(points) * seconds_per_point_;
}

bool WorkLimits::is_time_up(const GrowthWork& work, const HullBall& ball, std::uint64_t points) {
  if (limits_.max_seconds <= 0.0) return false;
  // Other work on the machine and what is not foreseen one by one: better too early than too late.
  constexpr double kReserve = 0.05;
  const auto is_up = [&](std::uint64_t point_count) {
    const double left = seconds_left() - kReserve * limits_.max_seconds;
    return left <= 0.0 || finish_seconds(work, ball, point_count) >= left;
  };
  // A few milliseconds that other work took from the sample stand for seconds in all: growth ends for the
  // points only on what samples of other points say as well.
  for (std::size_t again = 0; is_up(points); ++again) {
    if (again == kSamplesAgain || is_up(0)) return true;
    seconds_per_point_ = std::min(seconds_per_point_, sampled_seconds_per_point(work, ball, again + 1));
  }
  return false;
}

double WorkLimits::width_share(const GrowthWork& work, std::uint64_t left_out) {
  constexpr std::uint64_t kMany = 4;  // times as many as there are vertices
  return left_out > kMany * work.most_vertices() ? kWidthShareOfMany : kWidthShare;
}

bool WorkLimits::has_time_to_cover(const GrowthWork& work, std::uint64_t left_out) const {
  if (limits_.max_seconds <= 0.0) return true;
  const double share = gathering_ == Gathering::kWidth ? width_share(work, left_out) : kRuleShare;
  const double rows = static_cast<double>(work.complex.row_count - work.free_count);
  return (rows * share + static_cast<double>(left_out) * kMeasureShare) * seconds_per_created(work) <
         seconds_left();
}

bool WorkLimits::is_late() const {
  constexpr double kLate = 0.6;  // of the time
  return limits_.max_seconds > 0.0 && seconds_left() < (1.0 - kLate) * limits_.max_seconds;
}

double WorkLimits::affordable_products(const GrowthWork& work, double part, bool is_stopped) const {
  double seconds = HUGE_VAL;
  if (is_stopped) seconds = std::max(1.0, 0.1 * seconds_since(start_));
  if (limits_.max_seconds > 0.0) seconds = std::clamp(part * seconds_left(), 0.0, seconds);
  return seconds / (kSharePerProduct * seconds_per_created(work));
}

}  // namespace ndhull
