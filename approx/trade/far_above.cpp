#include "approx/trade/far_above.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/search/highest_dots.h"

namespace ndhull {
namespace {

/// Points that are worth products with all planes, and how often it is worth looking at simplices one by one.
constexpr std::size_t kMostCandidates = 512, kLooksAtLeast = 1 << 16, kSimplicesForLook = 4;
constexpr std::size_t kSimplicesInBlock = 4096, kLookedAtForEach = 256;

class FarSearch {
 public:
  FarSearch(const GrowthWork& work, const double* points, const WidthSpace& space, double width)
      : work_(work), complex_(work.complex), points_(points), space_(space), width_(width) {}

  std::vector<LocatedPoint> run(const std::vector<LocatedPoint>& left_out) {
    list_candidates(left_out);
    if (candidates_.empty() || takes_long()) return {};
    list_open();
    if (open_.empty()) return {};
    hold();
    return takes_long() ? std::vector<LocatedPoint>() : above_open();
  }

 private:
  enum Kind : std::uint8_t { kCloseBelow, kTooFarBelow, kHeld };

  bool takes_long() const {
    const std::size_t live = complex_.row_count - work_.free_count;
    return looks_ > kLooksAtLeast + live / kSimplicesForLook || candidates_.size() > kMostCandidates;
  }

  double gauge_of(PointId point, SimplexId simplex) const {
    const auto plane = complex_.plane(simplex);
    return std::inner_product(plane.begin(), plane.end(), points_ + std::size_t{point.value} * complex_.rank,
                              -1.0);
  }

  /// Where its gauge is largest: that is linear in the dual vertices of simplices, so climbing over neighbours
  /// ends there, as the simplex method does.
  LocatedPoint climb(LocatedPoint at) {
    for (bool climbs = true; climbs;) {
      climbs = false;
      for (const SimplexId neighbour : complex_.neighbours(at.simplex)) {
        const double gauge = gauge_of(at.point, neighbour);
        ++looks_;
        if (gauge <= at.gauge) continue;
        at = {at.point, neighbour, gauge};
        climbs = true;
        break;
      }
    }
    return at;
  }

  /// Is a point further above some simplex than the width? Those where it could be hang together, around the
  /// one where its gauge is largest. Where they are many that may be so.
  bool may_be_far(const LocatedPoint& top, double least) {
    if (top.gauge <= least) return false;
    walk_.assign(1, top.simplex);
    met_by_[top.simplex.value] = top.point.value;
    for (std::size_t i = 0; i < walk_.size(); ++i) {
      if (i == kLookedAtForEach) return true;
      const double gauge = gauge_of(top.point, walk_[i]);
      ++looks_;
      if (gauge <= least) continue;
      if (height_above(work_, walk_[i].value, gauge) > width_) return true;
      for (const SimplexId neighbour : complex_.neighbours(walk_[i])) {
        if (met_by_[neighbour.value] == top.point.value) continue;
        met_by_[neighbour.value] = top.point.value;
        walk_.push_back(neighbour);
      }
    }
    return false;
  }

  /// Points that may be further than the width above some simplex, and the least gauge at which they are.
  void list_candidates(const std::vector<LocatedPoint>& left_out) {
    least_gauge_ = HUGE_VAL;
    met_by_.assign(complex_.row_count, kNone);
    for (const LocatedPoint& outside : left_out) {
      if (takes_long()) return;
      const std::uint32_t own_row = space_.row_of(outside.point);
      if (own_row == kNone || !outside.simplex.valid()) continue;
      // A gauge g above a plane that is h from the centre is a height of g h, and (1 + g) h is no more than
      // the point's own distance.
      const double* own = space_.row(own_row);
      const double reach = std::sqrt(std::inner_product(own, own + complex_.rank, own, 0.0));
      if (reach <= width_) continue;
      const double least = width_ / (reach - width_);
      if (!may_be_far(climb({outside.point, outside.simplex, gauge_of(outside.point, outside.simplex)}),
                      least))
        continue;
      candidates_.push_back(outside.point);
      least_gauge_ = std::min(least_gauge_, least);
    }
  }

  /// Simplices that a point is too far above.
  void list_open() {
    const std::size_t rank = complex_.rank;
    std::vector<double> rows;
    for (const PointId id : candidates_)
      rows.insert(rows.end(), points_ + std::size_t{id.value} * rank,
                  points_ + (std::size_t{id.value} + 1) * rank);
    const PointGroups groups(rank, rows, false);
    const std::vector<double> attained(kSimplicesInBlock, 1.0 + least_gauge_);
    kinds_.assign(complex_.row_count, kCloseBelow);
    for_each_block(complex_.row_count, kSimplicesInBlock, [&](std::size_t begin, std::size_t end) {
      std::vector<double> highest(end - begin);
      const auto of_all = std::span(attained).first(end - begin);
      highest_dots(groups, {complex_.planes.data() + begin * rank, (end - begin) * rank},
                   {of_all, of_all, 0, {}}, highest);
      for (std::size_t row = begin; row < end; ++row) {
        if (highest[row - begin] <= attained[0] || complex_.state[row] != SimplexState::kLive) continue;
        const double gauge = highest[row - begin] - 1.0;
        if (height_above(work_, static_cast<std::uint32_t>(row), gauge) > width_) kinds_[row] = kTooFarBelow;
      }
    });
    for (std::uint32_t row = 0; row < complex_.row_count; ++row)
      if (kinds_[row] == kTooFarBelow) open_.push_back(SimplexId{row});
  }

  /// The candidate that is highest above a simplex; at least 0 high.
  LocatedPoint highest_above(SimplexId simplex) const {
    LocatedPoint highest{PointId{}, simplex, 0.0};
    for (const PointId id : candidates_) {
      const double gauge = gauge_of(id, simplex);
      if (gauge > highest.gauge) highest = {id, simplex, gauge};
    }
    return highest;
  }

  /// Grows slabs over open simplices from those beside them.
  void hold() {
    met_by_.assign(complex_.row_count, kNone);
    for (const SimplexId open : open_) {
      for (const SimplexId seed : complex_.neighbours(open)) {
        if (kinds_[seed.value] != kCloseBelow || met_by_[seed.value] == seed.value) continue;
        met_by_[seed.value] = seed.value;
        looks_ += candidates_.size() / complex_.rank;
        hold_from(seed);
        if (takes_long()) return;
      }
    }
  }

  void hold_from(SimplexId seed) {
    const double least =
        highest_above(seed).gauge - width_ / height_above(work_, seed.value, 1.0);  // in gauges
    walk_.assign(1, seed);
    for (std::size_t i = 0; i < walk_.size(); ++i) {
      for (const SimplexId next : complex_.neighbours(walk_[i])) {
        if (kinds_[next.value] == kCloseBelow || met_by_[next.value] == seed.value) continue;
        met_by_[next.value] = seed.value;
        ++looks_;
        const bool is_in = std::ranges::all_of(
            complex_.vertices(next), [&](PointId vertex) { return gauge_of(vertex, seed) >= least; });
        if (!is_in) continue;
        kinds_[next.value] = kHeld;
        walk_.push_back(next);
      }
    }
  }

  std::vector<LocatedPoint> above_open() const {
    std::vector<LocatedPoint> found;
    for (const SimplexId simplex : open_)
      if (kinds_[simplex.value] == kTooFarBelow) found.push_back(highest_above(simplex));
    std::ranges::stable_sort(found, {}, &LocatedPoint::point);
    const auto same = std::ranges::unique(found, {}, &LocatedPoint::point);
    found.erase(same.begin(), same.end());
    return found;
  }

  const GrowthWork& work_;
  const SimplicialComplex& complex_;
  const double* points_;
  const WidthSpace& space_;
  double width_;
  std::vector<PointId> candidates_;
  double least_gauge_ = 0.0;
  std::vector<Kind> kinds_;             // per row; open: as long as no slab holds it
  std::vector<SimplexId> open_, walk_;  // open ones as they were listed
  std::vector<std::uint32_t> met_by_;   // per row, the last point, and then the last seed
  std::size_t looks_ = 0;
};

}  // namespace

std::vector<LocatedPoint> find_far_above(const GrowthWork& work, const double* points,
                                         const WidthSpace& space, const std::vector<LocatedPoint>& left_out,
                                         double width) {
  return FarSearch(work, points, space, width).run(left_out);
}

}  // namespace ndhull
