#include "approx/growth/certified_growth.h"

#include <algorithm>
#include <cmath>

#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

/// Repair rounds after which the rest is reported, not chased. One or two are what degenerate inputs need.
constexpr std::uint64_t kRepairRounds = 8;
/// Points that take part in growth from the beginning.
constexpr std::size_t kPointsAtFirst = 4096;
/// A hull of more simplices than this has vertices that some of the points do not stand for. So has one that
/// one of so many points is inside.
constexpr std::size_t kManyRowsFromSome = 1 << 14, kHardlyAny = 64;

HullStatus status_of(GrowthStop stop) {
  switch (stop) {
    case GrowthStop::kNoOutsidePoints:
    case GrowthStop::kPaused: return HullStatus::kComplete;
    case GrowthStop::kFacetLimit: return HullStatus::kFacetLimit;
    case GrowthStop::kTimeLimit: return HullStatus::kTimeLimit;
    case GrowthStop::kMemoryLimit: return HullStatus::kMemoryLimit;
    case GrowthStop::kInterrupted: return HullStatus::kInterrupted;
  }
  return HullStatus::kComplete;
}

/// The choice of facets for the volume comes after growth, and takes what there is.
Limits limits_of_growth(const HullOptions& options) {
  constexpr double kShare = 0.5;
  Limits limits = options.limits;
  if (options.accuracy.is_for_volume()) limits.max_seconds *= kShare;
  return limits;
}

Gathering gathering_of(const Accuracy& accuracy) {
  if (accuracy.facets > 0) return Gathering::kCount;
  if (accuracy.width.is_set()) return Gathering::kWidth;
  return accuracy.merges_neighbours() ? Gathering::kRule : Gathering::kSimplices;
}

}  // namespace

CertifiedGrowth::CertifiedGrowth(const PointView& points, const Frame& frame,
                                 std::vector<double> gradient_factor, const HullOptions& options,
                                 Clock::time_point start, Hull& hull)
    : points_(points),
      frame_(frame),
      options_(options),
      start_(start),
      hull_(hull),
      limits_(limits_of_growth(options), start, gathering_of(options.accuracy), options.accuracy.facets) {
  coordinates_ = HugeArray<double>::to_write(points_.rows * frame_.rank);
  map_points(points_, frame_, coordinates_.data());
  work_.rank = frame_.rank;
  work_.point_count = points_.rows;
  work_.options.gradient_factor = std::move(gradient_factor);
  detail("frame", start_);
}

void CertifiedGrowth::detail(std::string_view name, Clock::time_point since) {
  hull_.statistics.detail_seconds.emplace_back(name, seconds_since(since));
}

GrowthStop CertifiedGrowth::poll(std::uint64_t points_left, double furthest) {
  const std::uint64_t rows = work_.complex.row_count - work_.free_count;
  points_left += work_.waiting.size();
  // Points that wait may be further; of some it is not known how far.
  if (std::isfinite(work_.waiting_height)) {
    furthest = std::max(furthest, work_.waiting_height);
    record_progress(points_left, furthest, rows);
  }
  tell(Phase::kGrowth, points_left, furthest);
  if (options_.stop.stop_requested()) return GrowthStop::kInterrupted;
  if (undoes_most()) {
    is_too_rough_ = true;
    return GrowthStop::kInterrupted;
  }
  // Once a point was shifted simplices will be merged, which takes memory.
  work_.options.most_table_rows = limits_.most_rows(work_, frame_.dimension, point_bytes());
  const std::uint64_t done = proven_count_ + work_.counters.insertions;
  const std::uint64_t to_prove =
      options_.wants_partial ? points_.rows - std::min<std::uint64_t>(points_.rows, done) : 0;
  return limits_.is_time_up(work_, ball_, to_prove) ? GrowthStop::kTimeLimit : GrowthStop::kNoOutsidePoints;
}

bool CertifiedGrowth::may_be_rougher() const {
  constexpr double kLargestShift = 1e-8;
  return options_.shift >= HullOptions().shift && options_.shift < kLargestShift;
}

/// Points that share planes exactly, as corners of a cube, have one in forty undone.
bool CertifiedGrowth::undoes_most() const {
  constexpr std::uint64_t kSome = 256;
  return work_.counters.rejected > kSome + work_.counters.insertions && may_be_rougher();
}

/// The furthest point's height whenever the hull has grown by half. An earlier height is never exceeded: the
/// hull only grows.
void CertifiedGrowth::record_progress(std::uint64_t points_left, double furthest, std::uint64_t simplices) {
  std::vector<GrowthRecord>& curve = hull_.statistics.growth_curve;
  if (!curve.empty() && simplices < curve.back().simplices + curve.back().simplices / 2) return;
  if (!curve.empty()) furthest = std::min(furthest, curve.back().furthest);
  curve.push_back({seconds_since(start_), simplices, points_left, furthest});
}

void CertifiedGrowth::tell(Phase phase, std::uint64_t points_left, double furthest, std::uint64_t simplices,
                           std::uint64_t more_bytes) const {
  if (!options_.progress) return;
  const std::uint64_t bytes = work_.complex.row_count * (16 * frame_.rank + 9) + point_bytes() + more_bytes;
  options_.progress({phase, points_left, simplices, furthest, seconds_since(start_), bytes});
}

/// Coordinates, outside sets, flags, and what a proof lists of each point.
std::uint64_t CertifiedGrowth::point_bytes() const {
  return coordinates_.capacity() * 8 + points_.rows * (17 + 2 + 6 + sizeof(LocatedPoint));
}

void CertifiedGrowth::start() {
  has_started_ = true;
  work_.points = coordinates_.data();
  work_.measure_phases = true;
  work_.options.seed = options_.seed;
  work_.options.shift = options_.shift;
  work_.options.max_rows = options_.limits.max_facets;
  work_.options.poll = [this](std::uint64_t left, double furthest) { return poll(left, furthest); };
  if (grown_) {
    start_growth(work_, std::move(*grown_));
    grown_.reset();
    place_waiting();
    return;
  }
  const Clock::time_point begin = Clock::now();
  ball_ = find_ball(frame_.rank, coordinates_.data(), points_.rows, frame_.simplex);
  // A limit on facets ends growth at any time: then the furthest of all points has to come first.
  const bool may_wait = options_.limits.max_facets == 0;
  constexpr std::size_t kStride = 16;
  FirstPoints first;
  if (may_wait && grows_from_some_) first.stride = kStride;
  if (may_wait && !grows_from_some_) first.most = kPointsAtFirst;
  start_growth(work_, frame_.simplex, first);
  detail("first partition", begin);
  if (!work_.waiting.empty()) grow_before_placing();
}

void CertifiedGrowth::go_on_from(BegunHull begun) {
  ball_ = begun.ball;
  grown_ = std::move(begun.grown);
}

/// Growth that pauses now and then where most points were shifted. Not for the first few simplices: small
/// hulls are done before anything else has begun.
GrowthStop CertifiedGrowth::grow_asking() {
  if (is_found_otherwise_) return GrowthStop::kPaused;
  if (!find_otherwise_) return grow(work_);
  constexpr std::uint64_t kFirstAsked = 4096, kMostBetween = std::uint64_t{1} << 21;
  for (;;) {
    work_.options.pause_made = std::max(kFirstAsked, asked_at_ + std::min(asked_at_, kMostBetween));
    const GrowthStop stop = grow(work_);
    const bool is_asked = stop == GrowthStop::kPaused && work_.options.pause_made == 0;
    work_.options.pause_made = 0;
    if (!is_asked) return stop;
    asked_at_ = work_.counters.made();
    is_found_otherwise_ = find_otherwise_(asked_at_);
    if (is_found_otherwise_) return stop;
  }
}

bool CertifiedGrowth::grow_exactly() {
  std::uint64_t searched_all = 0;
  start();
  work_.options.in_regions = !options_.limits.has_any();
  for (std::uint64_t round = 0;; ++round) {
    Clock::time_point phase_start = Clock::now();
    const GrowthStop stop = grow_asking();
    hull_.status = status_of(stop);
    seconds(Phase::kGrowth) += seconds_since(phase_start);
    if (is_found_otherwise_) {
      drop_grower();
      report_counters();
      return true;
    }
    if (is_too_rough_ || (hull_.status != HullStatus::kComplete && !options_.wants_partial)) break;
    phase_start = Clock::now();
    tell(Phase::kCertify, work_.points_outside, furthest_height());
    const std::vector<LocatedPoint> located =
        prove_inside(work_.complex, coordinates_.data(), ball_, points_off_the_complex(), work_.options.shift,
                     searched_all, affordable_search());
    const bool repaired = stop == GrowthStop::kNoOutsidePoints && round < kRepairRounds && repair(located);
    if (!repaired) list_left_out(located);
    seconds(Phase::kCertify) += seconds_since(phase_start);
    if (!repaired) break;
    ++hull_.statistics.repair_rounds;
  }
  drop_grower();
  constexpr double kManyShifts = 1000.0;
  const bool leaves_some_out =
      work_.counters.set_aside > 0 && hull_.max_outside_gauge > kManyShifts * work_.options.shift;
  if (hull_.status == HullStatus::kComplete && leaves_some_out && may_be_rougher()) is_too_rough_ = true;
  report_counters();
  return false;
}

double CertifiedGrowth::affordable_search() const {
  constexpr double kSlower = 16.0;  // than products in vectors
  constexpr double kPart = 0.3;
  return std::min(kSearchProducts,
                  limits_.affordable_products(work_, kPart, options_.stop.stop_requested()) / kSlower);
}

void CertifiedGrowth::grow_from_some() {
  constexpr std::size_t kWorthSome = 1 << 15;
  grows_from_some_ = points_.rows >= kWorthSome;
}

bool CertifiedGrowth::grow_to(double outside_width, std::uint64_t enough_rows, double enough_height) {
  work_.options.outside_width = outside_width;
  if (!has_started_) start();
  Clock::time_point begin = Clock::now();
  if (!work_.waiting.empty()) {
    work_.options.pause_rows = kManyRowsFromSome;
    const bool is_large = grow_asking() == GrowthStop::kPaused;
    work_.options.pause_rows = 0;
    seconds(Phase::kGrowth) += seconds_since(begin);
    if (is_large) place_waiting();
    begin = Clock::now();
  }
  work_.options.pause_rows = enough_rows;
  work_.options.pause_height = enough_height;
  const GrowthStop stop = grow_asking();
  work_.options.pause_rows = 0;
  work_.options.pause_height = HUGE_VAL;
  hull_.status = status_of(stop);
  seconds(Phase::kGrowth) += seconds_since(begin);
  return stop == GrowthStop::kNoOutsidePoints;
}

void CertifiedGrowth::locate_left_out(double useful_slack) {
  if (is_found_otherwise_) return;
  forget_waiting();  // what is left out goes back by `repair`
  const Clock::time_point begin = Clock::now();
  std::uint64_t searched_all = 0;
  tell(Phase::kCertify, work_.points_outside, furthest_height());
  // What is left out on purpose is not near enough to the hull to be proven outside by rounding and no more.
  const double useful = std::max(work_.options.shift, useful_slack);
  list_left_out(prove_inside(work_.complex, coordinates_.data(), ball_, points_off_the_complex(), useful,
                             searched_all, affordable_search()));
  seconds(Phase::kCertify) += seconds_since(begin);
  report_counters();
}

void CertifiedGrowth::put_back(std::span<const LocatedPoint> points) {
  forget_waiting();  // the caller has looked at all
  const double least = std::nextafter(least_height(work_), HUGE_VAL);
  for (const LocatedPoint& point : points) {
    // Not above its simplex by more than rounding: no insertion would see that.
    if (point.gauge <= 2.0 * work_.options.shift) continue;
    const double height = std::max(least, height_above(work_, point.simplex.value, point.gauge));
    const double known = work_.heights.height(point.point.value);
    if (known >= height) continue;
    // Growth that has paused left it above another simplex, less far.
    if (known != OutsideHeights::kNotOutside) take_from_outside(work_, point.point.value);
    push_outside(work_, point.point.value, point.simplex.value, height);
  }
  ++hull_.statistics.repair_rounds;
}

double CertifiedGrowth::furthest_height() { return std::max(0.0, work_.heights.furthest().height); }

void CertifiedGrowth::report_counters() {
  const GrowthCounters& counters = work_.counters;
  HullStatistics& statistics = hull_.statistics;
  statistics.created_simplices = counters.created;
  statistics.insertions = counters.insertions;
  statistics.shifted_points = work_.shifted_points.size();
  statistics.rejected_insertions = counters.rejected;
  const std::pair<std::string_view, double> details[] = {{"visible set", counters.seconds_visible},
                                                         {"cone", counters.seconds_cone},
                                                         {"matching", counters.seconds_match},
                                                         {"partition", counters.seconds_partition},
                                                         {"points inside", seconds(Phase::kCertify)}};
  for (const auto& [name, value] : details) {
    const auto same = std::find_if(statistics.detail_seconds.begin(), statistics.detail_seconds.end(),
                                   [&](const auto& entry) { return entry.first == name; });
    if (same == statistics.detail_seconds.end()) {
      statistics.detail_seconds.emplace_back(name, value);
    } else {
      same->second = value;
    }
  }
}

/// A small hull, to place the waiting points in.
void CertifiedGrowth::grow_before_placing() {
  const Clock::time_point begin = Clock::now();
  work_.options.pause_rows = 128 * frame_.rank;
  const GrowthStop stop = grow(work_);
  work_.options.pause_rows = 0;
  seconds(Phase::kGrowth) += seconds_since(begin);
  // Ended by a limit: the final proof comes next.
  if (stop != GrowthStop::kPaused && stop != GrowthStop::kNoOutsidePoints) return;
  if (!grows_from_some_ || holds_some_waiting()) place_waiting();
}

/// Are more than hardly any of the waiting points well inside?
bool CertifiedGrowth::holds_some_waiting() {
  constexpr std::size_t kLookedAt = 512;
  std::vector<PointId> some;
  for (std::size_t i = 0; i < work_.waiting.size(); i += 1 + work_.waiting.size() / kLookedAt)
    some.push_back(PointId{work_.waiting[i]});
  const std::vector<LocatedPoint> located = try_inside(work_.complex, coordinates_.data(), ball_, some);
  const auto inside = std::count_if(located.begin(), located.end(),
                                    [](const LocatedPoint& point) { return point.gauge < -kWellInside; });
  return static_cast<std::size_t>(inside) * kHardlyAny >= some.size();
}

/// Most of many points are well inside a small hull already. What is proven inside a part of the hull is
/// inside the whole, and the part's simplices are few and in cache. The others go to outside sets.
void CertifiedGrowth::place_waiting() {
  constexpr std::size_t kChunk = std::size_t{1} << 14;  // what they take is in cache, and taken again
  const Clock::time_point begin = Clock::now();
  proven_.assign(points_.rows, false);
  std::vector<PointId> chunk;
  for (std::size_t first = 0; first < work_.waiting.size(); first += kChunk) {
    const std::size_t count = std::min(kChunk, work_.waiting.size() - first);
    chunk.resize(count);
    for (std::size_t i = 0; i < count; ++i) chunk[i] = PointId{work_.waiting[first + i]};
    for (const LocatedPoint& point : try_inside(work_.complex, coordinates_.data(), ball_, chunk)) {
      if (point.gauge < -kWellInside) {
        proven_[point.point.value] = true;
        ++proven_count_;
      } else {
        push_if_outside(point);
      }
    }
  }
  forget_waiting();
  seconds(Phase::kCertify) += seconds_since(begin);
}

/// A point that goes into an outside set by another way must not be placed as well.
void CertifiedGrowth::forget_waiting() {
  work_.waiting = std::vector<std::uint32_t>();
  work_.waiting_height = 0.0;
}

/// Into an outside set, when it is more than the shift and W above its simplex.
bool CertifiedGrowth::push_if_outside(const LocatedPoint& point) {
  double gauge = -1.0;
  const auto plane = work_.complex.plane(point.simplex);
  for (std::size_t k = 0; k < frame_.rank; ++k)
    gauge += plane[k] * coordinates_[point.point.value * frame_.rank + k];
  const double height = height_above(work_, point.simplex.value, gauge);
  if (gauge <= 2.0 * work_.options.shift || height <= least_height(work_)) return false;
  push_outside(work_, point.point.value, point.simplex.value, height);
  return true;
}

/// Points more than four shifts and W outside go back; true when there were any.
bool CertifiedGrowth::repair(const std::vector<LocatedPoint>& located) {
  bool any = false;
  for (const LocatedPoint& point : located) {
    if (point.gauge > 4.0 * work_.options.shift) any = push_if_outside(point) || any;
  }
  return any;
}

}  // namespace ndhull
