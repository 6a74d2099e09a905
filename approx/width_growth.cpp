// How far an approximate hull grows: the part of approx/approximation.h that comes before its facets.
#include "approx/approximation.h"
#include "approx/outside_points.h"

#include <algorithm>

namespace ndhull {
namespace {

/// Simplices that are worth growing for an approximate hull, of which merging takes as long again: so many
/// once nothing is further outside than half of the width, so many once three quarters will do, and so many
/// once nearly all of it has to. The last takes a quarter of the simplices less than three quarters do, and
/// makes a quarter of the facets more.
constexpr std::uint64_t kEnoughAtHalf = 180'000, kManySimplices = 250'000, kVeryManySimplices = 4'000'000;
constexpr double kHalf = 0.5, kGrowthShareAtMost = 0.75, kGrowthShareOfHuge = 0.85;
/// Of W alone: what is left out is no further above any simplex, where that is affordable. The outer planes
/// of a hull come in steps, one vertex each: to be clearly below W costs 3 % more facets on 10^5 sphere
/// points in 6-d with W 0.2, and 1 % of the width is gained.
constexpr double kAloneShare = 0.995;
/// Rounds of points that go back before the best so far is taken: those that are where they were not located,
/// and those that a search finds, few at a time.
constexpr int kRounds = 24, kSearchRounds = 96;

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

/// Growth for slabs of this width.
void Approximation::grow_for_width(double outside_width, double slab) {
  if (lengths_.outside_width > 0.0) {
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

}  // namespace ndhull
