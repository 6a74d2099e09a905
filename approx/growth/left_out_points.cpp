// What growth left out: the part of approx/growth/certified_growth.h that says which points the planes are
// certified with.
#include <algorithm>
#include <cmath>

#include "approx/growth/certified_growth.h"

namespace ndhull {
namespace {

/// The rounding of the frame's coordinates, and of a gauge computed of them, is far below this. [ratio]
constexpr double kFrameRounding = 1e-14;
/// Plane-times-point products that are worth certifying points near the hull one by one: some twenty seconds
/// of one core on 8-d gaussian points, where the tree of points spares most of them, for widths of half the
/// size.
constexpr double kAffordableProducts = 2e12;

std::vector<PointId> points_where(const std::vector<bool>& flags, bool wanted) {
  std::vector<PointId> points;
  for (std::uint32_t id = 0; id < flags.size(); ++id)
    if (flags[id] == wanted) points.push_back(PointId{id});
  return points;
}

}  // namespace

std::vector<PointId> CertifiedGrowth::unproven_points() const {
  return points_where(proven_.empty() ? std::vector<bool>(points_.rows, false) : proven_, false);
}

std::vector<PointId> CertifiedGrowth::left_out_points(bool with_vertices) const {
  std::vector<bool> is_taken(points_.rows, false);
  if (with_vertices) is_taken = certificate_wanted_;
  for (const LocatedPoint& point : left_out_) is_taken[point.point.value] = true;
  return points_where(is_taken, true);
}

void CertifiedGrowth::certify_by_search(std::span<const PointId> points, double gauge, KnownHighest known) {
  certificate_wanted_.assign(points_.rows, false);
  for (const PointId point : points) certificate_wanted_[point.value] = true;
  known_highest_ = std::move(known);
  left_out_.clear();
  covered_gauge_ = 0.0;
  hull_.max_outside_gauge = gauge + kFrameRounding;
  report_counters();
}

/// Points that are vertices of no simplex and not proven inside; marks the vertices in certificate_wanted_.
std::vector<PointId> CertifiedGrowth::points_off_the_complex() {
  certificate_wanted_ = find_corners(work_);
  std::vector<PointId> rest;
  for (std::uint32_t id = 0; id < points_.rows; ++id) {
    if (!certificate_wanted_[id] && (proven_.empty() || !proven_[id])) rest.push_back(PointId{id});
  }
  return rest;
}

/// Points so near the hull (or outside, after a limit) that only their distances will do. The others stay
/// well inside, however the hull grows.
void CertifiedGrowth::list_left_out(const std::vector<LocatedPoint>& located) {
  double largest_gauge = 0.0;
  left_out_.clear();
  if (proven_.empty()) proven_.assign(points_.rows, false);
  for (const LocatedPoint& point : located) {
    largest_gauge = std::max(largest_gauge, point.gauge);
    if (point.gauge > -kWellInside) {
      left_out_.push_back(point);
    } else {
      proven_[point.point.value] = true;
      ++proven_count_;
    }
  }
  hull_.max_outside_gauge = largest_gauge;
  covered_gauge_ = 0.0;
}

/// When the distances would cost too much the points outside are covered by their gauge.
void CertifiedGrowth::choose_certificate_points(std::size_t facets) {
  const double products =
      static_cast<double>(facets) * static_cast<double>(left_out_.size() * frame_.dimension);
  constexpr double kPart = 0.6;  // hardly anything comes after it
  const double affordable = std::min(
      kAffordableProducts, limits_.affordable_products(work_, kPart, options_.stop.stop_requested()));
  if (products > affordable && std::isfinite(hull_.max_outside_gauge)) {
    covered_gauge_ = hull_.max_outside_gauge + kFrameRounding;
    return;
  }
  for (const LocatedPoint& point : left_out_) certificate_wanted_[point.point.value] = true;
}

std::uint64_t CertifiedGrowth::points_without_proof() const {
  std::vector<bool> is_covered(points_.rows, false);
  if (covered_gauge_ > 0.0)
    for (const LocatedPoint& point : left_out_) is_covered[point.point.value] = true;
  std::uint64_t count = 0;
  for (std::uint32_t id = 0; id < points_.rows; ++id)
    if (!certificate_wanted_[id] && !is_covered[id] && (proven_.empty() || !proven_[id])) ++count;
  return count;
}

}  // namespace ndhull
