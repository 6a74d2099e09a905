// How far an approximate hull grows: the part of approx/trade/approximation.h that comes before its facets.
#include "approx/geometry/length_unit.h"
#include "approx/growth/outside_points.h"
#include "approx/trade/approximation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ndhull {
namespace {

/// Growth for a width ends where nothing is further outside than a share of it, the larger the more simplices
/// there are: merging takes as long again. Of a hull that has the first number, the second, or more.
constexpr std::uint64_t kEnoughAtHalf = 180'000, kManySimplices = 250'000;
constexpr double kHalf = 0.5, kGrowthShareAtMost = 0.75;
/// Of still more: a quarter of the simplices less than at three quarters, and a quarter of the facets more.
constexpr std::uint64_t kVeryManySimplices = 4'000'000;
constexpr double kGrowthShareOfHuge = 0.85;
/// Of W alone: what is left out is no further above any simplex, where that is affordable. The outer planes
/// of a hull come in steps, one vertex each: to be clearly below W costs 3 % more facets on 10^5 sphere
/// points in 6-d with W 0.2, and 1 % of the width is gained.
constexpr double kAloneShare = 0.995;
/// Rounds of points that go back before the best so far is taken: those that are where they were not located,
/// and those that a search finds, few at a time.
constexpr int kRounds = 24, kSearchRounds = 96;
/// Simplices at which growth may go on by gauges: first, and, doubled, at most.
constexpr std::uint64_t kRowsBeforeGauges = 2048, kMostRowsBeforeGauges = 8192;
/// Simplices from which on growth is asked whether the hull is found without them.
constexpr std::uint64_t kRowsBeforeStars = std::uint64_t{1} << 18;
/// [bytes] A complex may be so large, or so many times the input, of inputs of this size and more. Below, the
/// time that stars take more is not worth the memory.
constexpr double kMostComplexBytes = 0x1p29, kMostOfInput = 2.0, kLargeInput = 0x1p26;

}  // namespace

/// Where the points left out are, to a twentieth of what growth left out.
void Approximation::locate_left_out(double outside_width) {
  growth_.locate_left_out(0.05 * outside_width / lengths_.largest_extent);
}

void Approximation::grow_outside_width() {
  const double width = lengths_.outside_width;
  hull_.chosen.outside_width = width;
  if (width > 0.0) growth_.grow_from_some();  // a search over all follows
  if (growth_.grow_to(width, 0, 0.0) && width > 0.0 && search_outside(width)) return;
  locate_left_out(width);
  for (int round = 0; round < kRounds && !growth_.is_limited() && growth_.repair(); ++round) {
    growth_.grow_to(width, 0, 0.0);
    locate_left_out(width);
  }
}

/// Takes in what is further above any simplex. True when all is known of the points left out, and nothing is
/// to be located.
bool Approximation::search_outside(double width) {
  // Where most points are inside, proving that leaves few to search. Merging has to know where they are; else
  // the search of many is the certificate as well: of few points and the vertices the facet table has that
  // sooner. To locate a point takes about as long as to search them all for one plane.
  constexpr std::size_t kWorthCertifying = 1 << 13;
  const bool merges = accuracy_.merges_neighbours();
  bool certifies = !merges;
  std::vector<PointId> points = growth_.unproven_points();
  const std::size_t planes = growth_.work().complex.row_count - growth_.work().free_count;
  if (merges || 2 * points.size() < growth_.work().point_count || points.size() < planes) {
    locate_left_out(width);
    certifies = !merges && growth_.left_out().size() >= kWorthCertifying;
    points = growth_.left_out_points(certifies);
  }
  const std::size_t count = points.size();
  if (!growth_.may_search(count)) return false;
  OutsideSearch search(growth_, std::move(points), certifies);
  const double wanted = merges ? width : kAloneShare * width;
  bool has_grown = false;
  for (int round = 0; round < kSearchRounds && search.put_back_above(width, wanted); ++round) {
    has_grown = true;
    if (!growth_.grow_to(wanted, 0, 0.0) || !growth_.may_search(count)) return false;
  }
  if (!certifies) return !has_grown;
  const double gauge = search.largest_gauge();
  growth_.certify_by_search(search.points(), gauge, search.take_highest());
  return true;
}

/// Growth for slabs of this width; then it is known where the points left out are.
void Approximation::grow_for_width(double outside_width, double slab) {
  grow_in_stages(outside_width, slab);
  growth_.work().options.by_gauge = false;
  locate_left_out(outside_width);
  for (int round = 0; round < kRounds && outside_width == 0.0 && !growth_.is_limited() && growth_.repair();
       ++round) {
    growth_.grow_to(outside_width, 0, HUGE_VAL);
    locate_left_out(outside_width);
  }
}

/// Grows some simplices, and sees whether all points will be vertices whatever their order.
void Approximation::choose_order(double outside_width) {
  if (!is_width_without_limits()) return;
  GrowthOptions& options = growth_.work().options;
  options.in_regions = !growth_.options().limits.has_any();
  for (std::uint64_t rows = kRowsBeforeGauges; rows <= kMostRowsBeforeGauges && !options.by_gauge;
       rows *= 2) {
    if (growth_.grow_to(outside_width, rows, HUGE_VAL) || growth_.is_limited()) return;
    options.by_gauge = will_take_in_all(outside_width);
  }
}

/// Hardly any point was left out so far, and those still outside are further than W by so much that hardly
/// any will be. The user's limit on memory is far away.
bool Approximation::will_take_in_all(double outside_width) const {
  constexpr double kClear = 1.5, kWidthsAbove = 3.0;  // else growth may end before W
  if (growth_.furthest_height() < kWidthsAbove * lengths_.width) return false;
  constexpr std::size_t kHardlyAny = 256;  // one of so many
  const GrowthWork& work = growth_.work();
  const std::size_t known = work.most_vertices() + work.points_outside;
  if (known + work.point_count / kHardlyAny < work.point_count) return false;
  // Simplices rise about with the square of vertices, and somewhat faster in many dimensions.
  constexpr double kFaster = 8.0;
  const double more = static_cast<double>(known) / static_cast<double>(work.most_vertices());
  const double rows = kFaster * more * more * static_cast<double>(work.complex.row_count - work.free_count);
  // The machine's memory changes nothing.
  if (growth_.options().limits.max_memory_bytes > 0 && rows > static_cast<double>(growth_.most_rows()))
    return false;
  std::vector<std::uint32_t> far;
  work.heights.list_above(kClear * outside_width, far);
  return far.size() == work.points_outside;
}

/// Where simplices become many, points further outside are left out, unless what is left out was asked for.
void Approximation::grow_in_stages(double outside_width, double slab) {
  if (lengths_.outside_width > 0.0 || outside_width == 0.0) {
    growth_.grow_to(outside_width, 0, HUGE_VAL);
    return;
  }
  const GrowthWork& work = growth_.work();
  const auto simplices = [&] { return work.complex.row_count - work.free_count; };
  const auto has_paused = [&](std::uint64_t enough, double height) {
    return !growth_.grow_to(outside_width, enough, height) && !growth_.is_limited();
  };
  if (!has_paused(kEnoughAtHalf, kGrowthShareOfHuge * slab) || simplices() > kVeryManySimplices) return;
  if (!has_paused(kEnoughAtHalf, kGrowthShareAtMost * slab)) return;
  constexpr std::uint64_t kStep = kEnoughAtHalf / 16;
  while (simplices() < kManySimplices && growth_.furthest_height() > kHalf * slab)
    if (!has_paused(std::min<std::uint64_t>(kManySimplices, simplices() + kStep), HUGE_VAL)) return;
}

/// Nearly all points are vertices, so that the rest of them costs less than what they would be too far above.
/// Not where simplices are limited: what is there fits.
bool Approximation::leaves_out_hardly_any(double outside_width) const {
  constexpr double kHardlyAny = 1.0 / 12.0;  // in parts of the vertices
  return lengths_.outside_width == 0.0 && outside_width > 0.0 && has_left_out_ &&
         growth_.options().limits.max_facets == 0 && space_->share_of_others() < kHardlyAny;
}

/// How far outside points are left out once one of them was too far above a simplex that no slab holds, and
/// growth takes it in: less from some rounds on, and nothing in the last.
double Approximation::less_outside(double outside_width, int round) const {
  constexpr int kPatience = 4;
  constexpr double kLess = 0.7;
  if (lengths_.outside_width > 0.0 || is_limited_width()) return outside_width;
  if (leaves_out_hardly_any(outside_width) || round + 1 == kWidthRounds) return 0.0;
  return round < kPatience ? outside_width : kLess * outside_width;
}

/// Is the hull the exact one? Nothing that was left out is outside by more than rounding.
bool Approximation::is_whole() {
  return growth_.furthest_height() == 0.0 && !growth_.is_limited() &&
         hull_.max_outside_gauge <= 4.0 * growth_.work().options.shift;
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

/// Takes in these points, which are too far above simplices, and all that are further outside than others may
/// be then: returns how far.
double Approximation::take_in_far(std::span<const LocatedPoint> far, double outside_width, int round) {
  if (far.empty()) return outside_width;
  growth_.put_back(far);
  outside_width = less_outside(outside_width, round);
  take_in_outside(outside_width);
  return outside_width;
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

/// Is a width asked for that stars could answer, which have no early end?
bool Approximation::is_width_without_limits() const {
  const HullOptions& options = growth_.options();
  return lengths_.width > 0.0 && accuracy_.facets == 0 && lengths_.outside_width == 0.0 &&
         growth_.frame().rank >= 3 && options.limits.max_seconds == 0.0 && options.limits.max_facets == 0;
}

bool Approximation::may_do_without_complex() const {
  return is_width_without_limits() && !has_too_many_vertices_ && !growth_.options().wants_simplices;
}

/// A hull without its complex, where that would be too large: for the memory that is allowed, or beside a
/// large input.
bool Approximation::find_stars(double outside_width, double slab) {
  const std::uint64_t most_rows = growth_.most_rows();
  if (!is_width_without_limits() || (input_bytes_ < kLargeInput && most_rows == 0)) return false;
  const std::uint64_t enough = most_rows == 0
                                   ? kRowsBeforeStars
                                   : std::min(kRowsBeforeStars, std::max<std::uint64_t>(1, most_rows / 4));
  // In steps: where little is left to grow, growth ends before that.
  for (std::uint64_t rows = std::min(enough, kEnoughAtHalf);; rows = std::min(enough, 2 * rows)) {
    const bool is_grown = growth_.grow_to(outside_width, rows, HUGE_VAL);
    if (growth_.is_limited()) return false;
    const bool is_near = is_grown || growth_.furthest_height() <= kGrowthShareOfHuge * slab;
    if (is_near && !earlier_.has_run_out) return false;
    if (is_near || rows == enough) break;
  }
  // Who wants simplices gets those of the hull that others get: growth has paused where theirs does.
  if (growth_.options().wants_simplices) return false;
  // Heights fall about so fast as simplices become more: balls and gaussian points, somewhat slower than
  // spheres. All points that are left may be vertices; simplices rise about with their square then.
  const GrowthWork& work = growth_.work();
  const double rank = static_cast<double>(work.rank);
  const double vertices = static_cast<double>(work.counters.insertions) + rank + 1.0;
  const double more = 1.0 + static_cast<double>(work.points_outside) / vertices;
  const double fall = std::max(1.0, growth_.furthest_height() / (kGrowthShareOfHuge * slab));
  // Vertices rise with about half of that exponent on spheres; on other sets slower.
  has_too_many_vertices_ =
      vertices * std::min(more, std::pow(fall, (rank - 1.0) / 4.0)) > static_cast<double>(kMostStarVertices);
  if (has_too_many_vertices_) return false;
  const double rows = static_cast<double>(enough) * std::min(more * more, std::pow(fall, (rank - 1.0) / 3.0));
  const bool is_too_large =
      input_bytes_ >= kLargeInput &&
      rows * (16.0 * rank + 5.0) > std::max(kMostComplexBytes, kMostOfInput * input_bytes_);
  const bool has_no_room = most_rows > 0 && rows > static_cast<double>(most_rows);
  if (!is_too_large && !has_no_room && !earlier_.has_run_out) return false;
  return take_star_hull(slab, rows);
}

/// Goes on without the complex. `rows`: simplices that the hull will about have.
bool Approximation::take_star_hull(double slab, double rows) {
  growth_.drop_paused();
  const double share =
      rows > static_cast<double>(kVeryManySimplices) ? kGrowthShareOfHuge : kGrowthShareAtMost;
  const ScaledFactor area = scale_factor(gradient_factor(frame_, LengthUnit()));
  star_hull_ = find_star_hull(growth_, factor_, area.factor, slab, share * slab);
  if (!star_hull_) return false;
  hull_.status = HullStatus::kComplete;
  star_hull_->surface_exponent = area.exponent;
  hull_.chosen.outside_width = star_hull_->distance;
  hull_.chosen.slab_width = slab;
  return true;
}

}  // namespace ndhull
