// How far an approximate hull grows for a width: the part of approx/trade/width_approximation.h that comes
// before its facets.
#include "approx/geometry/length_unit.h"
#include "approx/trade/width_approximation.h"
#include "core/machine/block_store.h"

#include <algorithm>
#include <cmath>

namespace ndhull {
namespace {

/// Growth for a width ends where nothing is further outside than a share of it, the larger the more simplices
/// there are: merging takes as long again. Of a hull that has the first number, the second, or more.
constexpr std::uint64_t kEnoughAtHalf = 180'000, kManySimplices = 250'000;
constexpr double kHalf = 0.5, kGrowthShareAtMost = 0.75;
/// Of still more: a quarter of the simplices less than at three quarters, and a quarter of the facets more.
constexpr std::uint64_t kVeryManySimplices = 4'000'000;
constexpr double kGrowthShareOfHuge = 0.85;
/// Rounds of points that go back, being where they were not located, before the best so far is taken.
constexpr int kRounds = 24;
/// Simplices at which growth may go on by gauges: first, and, doubled, at most.
constexpr std::uint64_t kRowsBeforeGauges = 2048, kMostRowsBeforeGauges = 8192;
/// Simplices from which on growth is asked whether the hull is found without them.
constexpr std::uint64_t kRowsBeforeStars = std::uint64_t{1} << 18;
/// [bytes] A complex may be so large, or so many times the input, of inputs of this size and more. Below, the
/// time that stars take more is not worth the memory.
constexpr double kMostComplexBytes = 0x1p29, kMostOfInput = 2.0, kLargeInput = 0x1p26;

/// How simplices rise with vertices: as a power of them that falls towards 1 (points on a sphere, whose facets
/// rise as its area does in the end), from 2.3 at 16,384 simplices in 8-d.
struct RiseOfSimplices {
  double vertices = 0.0, simplices = 0.0, exponent = 2.0;

  /// The hull has grown so far, to twice as many simplices or so.
  void note(std::size_t vertex_count, std::size_t simplex_count) {
    const double now = static_cast<double>(vertex_count), rows = static_cast<double>(simplex_count);
    if (vertices > 0.0 && now > vertices && rows > simplices)
      exponent = std::log(rows / simplices) / std::log(now / vertices);
    vertices = now;
    simplices = rows;
  }

  /// Of a hull of so many times the vertices: 0.9 to 1.2 times what 1,000 to 5,000 points on spheres, lenses
  /// and cones have in 7-d and 8-d, foreseen from 2 to 20 % of them.
  double foreseen(double times) const {
    constexpr double kFall = 0.85;  // of what the exponent has above 1, whenever simplices double
    double doublings = 0.0, excess = std::max(0.0, exponent - 1.0);
    for (double left = std::log2(times); left > 0.0;) {
      excess *= kFall;
      const double step = 1.0 / (1.0 + excess);
      doublings += std::min(1.0, left / step);
      left -= step;
    }
    return simplices * std::exp2(doublings);
  }
};

}  // namespace

/// Growth for the slabs, which may soon go on; then it is known where the points left out are.
void WidthApproximation::grow() {
  grow_in_stages();
  growth_.work().options.by_gauge = false;
  locate_and_go_on(outside_width_);
  for (int round = 0; round < kRounds && outside_width_ == 0.0 && !growth_.is_limited() && growth_.repair();
       ++round) {
    growth_.grow_to(outside_width_, 0, HUGE_VAL);
    locate_and_go_on(outside_width_);
  }
}

/// Grows some simplices, and sees whether all points will be vertices whatever their order. Without limits
/// points may also be added side by side.
void WidthApproximation::choose_order() {
  if (!is_width_alone()) return;
  GrowthOptions& options = growth_.work().options;
  options.in_regions = !growth_.options().limits.has_any();
  for (std::uint64_t rows = kRowsBeforeGauges; rows <= kMostRowsBeforeGauges && !options.by_gauge;
       rows *= 2) {
    if (growth_.grow_to(outside_width_, rows, HUGE_VAL) || growth_.is_limited()) return;
    options.by_gauge = will_take_in_all();
  }
}

/// Hardly any point was left out so far, and those still outside are further than W by so much that hardly
/// any will be. The user's limit on memory is far away.
bool WidthApproximation::will_take_in_all() const {
  constexpr double kClear = 1.5, kWidthsAbove = 3.0;  // else growth may end before W
  if (growth_.furthest_height() < kWidthsAbove * lengths_.width) return false;
  constexpr std::size_t kHardlyAny = 256;  // one of so many
  const GrowthWork& work = growth_.work();
  const std::size_t known = work.most_vertices() + work.points_outside;
  if (known + work.point_count / kHardlyAny < work.point_count) return false;
  // Simplices rise about with the square of vertices, and somewhat faster in many dimensions.
  constexpr double kFaster = 8.0;
  const double more = static_cast<double>(known) / static_cast<double>(work.most_vertices());
  const double rows = kFaster * more * more * static_cast<double>(live_count());
  // The machine's memory changes nothing.
  if (growth_.options().limits.max_memory_bytes > 0 && rows > static_cast<double>(growth_.most_rows()))
    return false;
  std::vector<std::uint32_t> far;
  work.heights.list_above(kClear * outside_width_, far);
  return far.size() == work.points_outside;
}

/// Where simplices become many, points further outside are left out, unless what is left out was asked for.
void WidthApproximation::grow_in_stages() {
  if (lengths_.outside_width > 0.0 || outside_width_ == 0.0) {
    growth_.grow_to(outside_width_, 0, HUGE_VAL);
    return;
  }
  const auto has_paused = [&](std::uint64_t enough, double height) {
    return !growth_.grow_to(outside_width_, enough, height) && !growth_.is_limited();
  };
  if (!has_paused(kEnoughAtHalf, kGrowthShareOfHuge * slab_) || live_count() > kVeryManySimplices) return;
  if (!has_paused(kEnoughAtHalf, kGrowthShareAtMost * slab_)) return;
  constexpr std::uint64_t kStep = kEnoughAtHalf / 16;
  while (live_count() < kManySimplices && growth_.furthest_height() > kHalf * slab_)
    if (!has_paused(std::min<std::uint64_t>(kManySimplices, live_count() + kStep), HUGE_VAL)) return;
}

/// A hull without its complex, where that would be too large: for the memory that is allowed, or beside a
/// large input.
bool WidthApproximation::find_stars() {
  const std::uint64_t most_rows = growth_.most_rows();
  if (!is_width_alone() || (input_bytes_ < kLargeInput && most_rows == 0)) return false;
  const std::uint64_t enough = most_rows == 0
                                   ? kRowsBeforeStars
                                   : std::min(kRowsBeforeStars, std::max<std::uint64_t>(1, most_rows / 4));
  // In steps: where little is left to grow, growth ends before that.
  RiseOfSimplices rise;
  for (std::uint64_t rows = (enough + 3) / 4;; rows = std::min(enough, 2 * rows)) {
    const bool is_grown = growth_.grow_to(outside_width_, rows, HUGE_VAL);
    if (growth_.is_limited()) return false;
    const bool is_near = is_grown || growth_.furthest_height() <= kGrowthShareOfHuge * slab_;
    if (is_near && !earlier_.has_run_out) return false;
    rise.note(growth_.work().most_vertices(), live_count());
    if (is_near || rows == enough) break;
  }
  // Who wants simplices gets those of the hull that others get: growth has paused where theirs does.
  if (growth_.options().wants_simplices) return false;
  // Heights fall about so fast as simplices become more: balls and gaussian points, somewhat slower than
  // spheres. All points that are left may be vertices.
  const GrowthWork& work = growth_.work();
  const double rank = static_cast<double>(work.rank);
  const double vertices = static_cast<double>(work.most_vertices());
  const double more = 1.0 + static_cast<double>(work.points_outside) / vertices;
  const double fall = std::max(1.0, growth_.furthest_height() / (kGrowthShareOfHuge * slab_));
  // Vertices rise with about half of that exponent on spheres; on other sets slower.
  are_stars_in_vain_ =
      vertices * std::min(more, std::pow(fall, (rank - 1.0) / 4.0)) > static_cast<double>(kMostStarVertices);
  if (are_stars_in_vain_) return false;
  const double rows = std::min(rise.foreseen(more), rise.simplices * std::pow(fall, (rank - 1.0) / 3.0));
  const bool is_too_large =
      input_bytes_ >= kLargeInput &&
      rows * (16.0 * rank + 5.0) > std::max(kMostComplexBytes, kMostOfInput * input_bytes_);
  const bool has_no_room = most_rows > 0 && rows > static_cast<double>(most_rows);
  if (!is_too_large && !has_no_room && !earlier_.has_run_out) return false;
  return take_star_hull(rows);
}

/// Goes on without the complex. `rows`: simplices that the hull will about have.
bool WidthApproximation::take_star_hull(double rows) {
  growth_.drop_grower();
  const double share =
      rows > static_cast<double>(kVeryManySimplices) ? kGrowthShareOfHuge : kGrowthShareAtMost;
  const ScaledFactor area = scale_factor(gradient_factor(frame_, LengthUnit()));
  star_hull_ = find_star_hull(growth_, factor_, area.factor, slab_, share * slab_);
  if (!star_hull_) {
    give_back_free_pages();
    return false;
  }
  hull_.status = HullStatus::kComplete;
  star_hull_->surface_exponent = area.exponent;
  hull_.chosen.outside_width = star_hull_->distance;
  hull_.chosen.slab_width = slab_;
  return true;
}

/// Nearly all points are vertices, so that the rest of them costs less than what they would be too far above.
/// Not where simplices are limited: what is there fits.
bool WidthApproximation::leaves_out_hardly_any() const {
  constexpr double kHardlyAny = 1.0 / 12.0;  // in parts of the vertices
  return lengths_.outside_width == 0.0 && outside_width_ > 0.0 && has_left_out_ &&
         growth_.options().limits.max_facets == 0 && space_->share_of_others() < kHardlyAny;
}

/// How far outside points are left out once one of them was too far above a simplex that no slab holds, and
/// growth takes it in: less from some rounds on, and nothing in the last.
double WidthApproximation::less_outside(int round) const {
  constexpr int kPatience = 4;
  constexpr double kLess = 0.7;
  if (lengths_.outside_width > 0.0 || has_settled()) return outside_width_;
  if (leaves_out_hardly_any() || round + 1 == kWidthRounds) return 0.0;
  return round < kPatience ? outside_width_ : kLess * outside_width_;
}

/// Takes in these points, which are too far above simplices, and all that are further outside than others may
/// be then.
void WidthApproximation::take_in_far(std::span<const LocatedPoint> far, int round) {
  if (far.empty()) return;
  growth_.put_back(far);
  outside_width_ = less_outside(round);
  take_in_outside(outside_width_);
}

/// Nothing but the width was asked for that decides what growth leaves out or when it ends; the user's limit
/// on memory may.
bool WidthApproximation::is_width_alone() const {
  const HullOptions& options = growth_.options();
  return lengths_.outside_width == 0.0 && frame_.rank >= 3 && options.limits.max_seconds == 0.0 &&
         options.limits.max_facets == 0;
}

}  // namespace ndhull
