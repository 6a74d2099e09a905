// Points left out that keep the facets of a target number wide: the part of
// approx/trade/count_approximation.h that takes them in when facets have been balanced.
//
// Idea. Where growth has left points out, one may be so far above some simplices that they are too wide
// alone: neither other slabs nor more facets help. When such a facet is the widest, its points are taken in.
// A few insertions replace some simplices, the others keep their facets, and balance goes on from there.
// Where the widest facet is large that would not help: more vertices make it wider.
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "approx/trade/count_approximation.h"
#include "approx/trade/facet_carry.h"
#include "approx/trade/region_closing.h"

namespace ndhull {
namespace {

/// Facets of up to so many simplices that no plane holds: one of this part of the width of the widest is looked
/// at with it, and a point is taken in when it is as far above a simplex as this part of it.
constexpr std::size_t kFewInFacet = 16;
constexpr double kNearlyWidest = 0.95, kFarAboveAlone = 0.8;
/// Rounds, and the part of the width that each has to win for another.
constexpr int kMostTakenIn = 3;
constexpr double kWorthAnother = 0.97;
/// Simplices up to which it is worth it, and turns after each round.
constexpr std::uint64_t kMostToTakeIn = 2'000'000, kTurnsOfRound = 10;

}  // namespace

/// The simplices of the widest facets, if they are few and the widest of all is one of them.
std::vector<std::uint32_t> CountApproximation::simplices_of_widest(const TrueWidths& widths) const {
  const Covering& covering = search_.narrowest;
  const FacetMembers members_of(covering);
  const double widest = widths.widest();
  std::vector<std::uint32_t> simplices;
  for (std::size_t facet = 0; facet < covering.planes.size(); ++facet) {
    if (widths.widths[facet] < kNearlyWidest * widest) continue;
    const std::span<const std::uint32_t> members = members_of.of(facet);
    if (members.size() <= kFewInFacet) {
      simplices.insert(simplices.end(), members.begin(), members.end());
    } else if (widths.widths[facet] == widest) {
      return {};
    }
  }
  return simplices;
}

/// The points left out that are far above these simplices' own planes.
std::vector<PointId> CountApproximation::points_far_above(std::span<const std::uint32_t> simplices) {
  const SimplicialComplex& complex = growth_.work().complex;
  const std::vector<FurthestPoint> furthest = furthest_above(simplices);
  std::vector<PointId> points;
  std::vector<double> normal(space_->rank());
  for (std::size_t i = 0; i < simplices.size(); ++i) {
    if (furthest[i].row == FurthestPoint::kNoRow) continue;
    const SimplexId simplex{simplices[i]};
    space_->normal_of(complex.plane(simplex), normal.data());
    const double* z = space_->row(space_->row_of(complex.vertices(simplex)[0]));
    if (std::inner_product(normal.begin(), normal.end(), z, kFarAboveAlone * search_.width) < furthest[i].dot)
      points.push_back(growth_.left_out()[furthest[i].row].point);
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// What was taken in has made facets wider: the hull as it is now is covered anew by slabs of the width that
/// there was.
void CountApproximation::cover_again(double width) {
  const double before = search_.has_any() ? search_.width : HUGE_VAL;
  search_held(width, false);
  if (search_.has_any() && search_.width < before)
    balance_facets(Covering(search_.narrowest), search_.slab, kTurnsOfRound);
  if (!search_.has_any())
    consider(cover_by_first_simplex(growth_.work().complex, *space_, frame_, growth_.coordinates()), 0.0);
}

/// Takes in what keeps the widest facets wide, round by round, as long as facets become narrower by it. The
/// narrowest covering so far is carried from hull to hull.
void CountApproximation::take_in_widening() {
  for (int round = 0; round < kMostTakenIn && !growth_.is_limited() && !growth_.is_late(); ++round) {
    if (live_count() > std::min(kMostToTakeIn, affordable_rows_) || search_.width <= flat()) return;
    const std::vector<std::uint32_t> simplices = simplices_of_widest(true_widths(search_.narrowest));
    const std::vector<PointId> points = points_far_above(simplices);
    if (points.empty()) return;
    const SimplexNames before(growth_.work().complex);
    take_in_alone(points);
    locate_left_out(outside_width_);
    make_space(true);
    const double width = search_.width, slab = search_.slab;
    Covering carried = carry_facets(growth_.work().complex, *space_, before, search_.narrowest, width);
    search_.narrowest = Covering{};
    if (!keeps_hull(carried)) close_and_join(carried, width, false);
    if (carried.planes.size() <= count_ && keeps_hull(carried)) {
      consider(carried, slab);
      balance_facets(carried, slab, kTurnsOfRound);
    }
    if (!search_.has_any() || search_.width > width) return cover_again(width);
    if (search_.width > kWorthAnother * width) return;
  }
}

}  // namespace ndhull
