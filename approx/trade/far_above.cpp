#include "approx/trade/far_above.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "core/ids.h"

namespace ndhull {
namespace {

class FarSearch {
 public:
  FarSearch(const GrowthWork& work, const double* points, const WidthSpace& space, double width)
      : work_(work),
        complex_(work.complex),
        points_(points),
        space_(space),
        width_(width),
        met_by_(complex_.row_count, PointId::kNone) {}

  bool is_late() const {
    constexpr std::size_t kPart = 4, kLeast = 4096;
    return looked_at_ > kLeast + (complex_.row_count - work_.free_count) / kPart;
  }

  /// A simplex that the point is too far above; nothing: there is none.
  std::optional<LocatedPoint> find(const LocatedPoint& outside) {
    const std::uint32_t own_row = space_.row_of(outside.point);
    if (own_row == kNone || !outside.simplex.valid()) return {};
    // A gauge g above a plane that is h from the centre is a height of g h, and (1 + g) h is no more than the
    // point's own distance.
    const double* own = space_.row(own_row);
    const double reach = std::sqrt(std::inner_product(own, own + complex_.rank, own, 0.0));
    if (reach <= width_) return {};
    const double least = width_ / (reach - width_);
    const LocatedPoint top =
        climb({outside.point, outside.simplex, gauge_of(outside.point, outside.simplex)});
    if (top.gauge <= least) return {};
    walk_.assign(1, top.simplex);
    met_by_[top.simplex.value] = outside.point.value;
    for (std::size_t i = 0; i < walk_.size(); ++i) {
      const SimplexId simplex = walk_[i];
      const double gauge = gauge_of(outside.point, simplex);
      if (gauge <= least) continue;
      if (height_above(work_, simplex.value, gauge) > width_)
        return LocatedPoint{outside.point, simplex, gauge};
      for (const SimplexId neighbour : complex_.neighbours(simplex)) {
        if (met_by_[neighbour.value] == outside.point.value) continue;
        met_by_[neighbour.value] = outside.point.value;
        walk_.push_back(neighbour);
      }
    }
    return {};
  }

 private:
  double gauge_of(PointId point, SimplexId simplex) {
    ++looked_at_;
    const auto plane = complex_.plane(simplex);
    return std::inner_product(plane.begin(), plane.end(), points_ + std::size_t{point.value} * complex_.rank,
                              -1.0);
  }

  LocatedPoint climb(LocatedPoint at) {
    for (bool climbs = true; climbs;) {
      climbs = false;
      for (const SimplexId neighbour : complex_.neighbours(at.simplex)) {
        const double gauge = gauge_of(at.point, neighbour);
        if (gauge <= at.gauge) continue;
        at = {at.point, neighbour, gauge};
        climbs = true;
        break;
      }
    }
    return at;
  }

  const GrowthWork& work_;
  const SimplicialComplex& complex_;
  const double* points_;
  const WidthSpace& space_;
  double width_;
  std::vector<std::uint32_t> met_by_;  // per simplex, the last point
  std::vector<SimplexId> walk_;
  std::size_t looked_at_ = 0;
};

}  // namespace

std::vector<LocatedPoint> find_far_above(const GrowthWork& work, const double* points,
                                         const WidthSpace& space, std::vector<LocatedPoint> left_out,
                                         double width) {
  std::vector<LocatedPoint> found;
  std::erase_if(left_out, [](const LocatedPoint& point) { return point.gauge <= 0.0; });
  if (left_out.empty()) return found;
  std::ranges::sort(left_out, [](const LocatedPoint& a, const LocatedPoint& b) {
    return a.gauge != b.gauge ? a.gauge > b.gauge : a.point < b.point;
  });
  FarSearch search(work, points, space, width);
  for (const LocatedPoint& point : left_out) {
    if (search.is_late()) break;
    if (const std::optional<LocatedPoint> far = search.find(point)) found.push_back(*far);
  }
  return found;
}

}  // namespace ndhull
