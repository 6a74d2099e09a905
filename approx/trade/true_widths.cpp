// How wide facets are over all points, and what makes them so: the part of approx/trade/approximation.h that
// says which points are to be taken in.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/trade/approximation.h"
#include "core/ids.h"

namespace ndhull {

const PointTree& Approximation::left_out_tree() {
  if (!left_out_tree_) {
    const GrowthWork& work = growth_.work();
    std::vector<PointId> left_out;
    for (const LocatedPoint& point : growth_.left_out()) left_out.push_back(point.point);
    left_out_tree_.emplace(work.rank, map_to_lengths(work.rank, factor_, growth_.coordinates(), left_out));
  }
  return *left_out_tree_;
}

/// The widths over all points, not only those of the space, and what they are due to.
TrueWidths Approximation::true_widths(const Covering& covering) {
  const std::size_t rank = space_->rank(), count = covering.planes.size();
  TrueWidths result;
  result.widths.resize(count);
  result.furthest.resize(count);
  std::vector<std::uint32_t> searched;  // facets
  for (std::uint32_t facet = 0; facet < count; ++facet) {
    const FittedPlane& plane = covering.planes[facet];
    result.widths[facet] = plane.width();
    // What is above a simplex with its own plane was not looked at.
    if (has_left_out_ && (!has_seen_all_ || plane.height == 0.0)) searched.push_back(facet);
  }
  if (searched.empty()) return result;
  std::vector<std::uint32_t> row_of_alone(count, kNone);
  for (std::uint32_t row = 0; row < covering.facet_of.size(); ++row)
    if (covering.facet_of[row] != kNone) row_of_alone[covering.facet_of[row]] = row;
  std::vector<double> normals, lows;
  std::vector<FurthestPoint> furthest(searched.size());
  for (std::size_t i = 0; i < searched.size(); ++i) {
    const FittedPlane& plane = covering.planes[searched[i]];
    normals.insert(normals.end(), plane.normal.begin(), plane.normal.end());
    double height = plane.height;
    lows.push_back(plane.low);
    if (height == 0.0) {
      const PointId vertex = growth_.work().complex.vertices(SimplexId{row_of_alone[searched[i]]})[0];
      const double* z = space_->row(space_->row_of(vertex));
      for (std::size_t k = 0; k < rank; ++k) height += plane.normal[k] * z[k];
      lows.back() = height;
    }
    furthest[i].dot = height;
  }
  find_furthest(left_out_tree(), normals, furthest);
  for (std::size_t i = 0; i < searched.size(); ++i) {
    result.widths[searched[i]] = furthest[i].dot - lows[i];
    result.furthest[searched[i]] = furthest[i];
  }
  return result;
}

/// The points left out that are furthest above the planes of these simplices.
std::vector<FurthestPoint> Approximation::furthest_above(std::span<const std::uint32_t> simplices) {
  const std::size_t rank = space_->rank();
  std::vector<FurthestPoint> found(simplices.size());
  if (simplices.empty() || !has_left_out_) return found;
  std::vector<double> normals(simplices.size() * rank);
  for (std::size_t i = 0; i < simplices.size(); ++i) {
    space_->normal_of(growth_.work().complex.plane(SimplexId{simplices[i]}), normals.data() + i * rank);
    found[i].dot = -HUGE_VAL;
  }
  find_furthest(left_out_tree(), normals, found);
  return found;
}

/// The furthest of the points left out above each of these simplices, a point once; ascending. The space is to
/// know them from now on.
std::vector<LocatedPoint> Approximation::far_above(std::span<const std::uint32_t> simplices) {
  const std::size_t rank = space_->rank();
  std::vector<LocatedPoint> above;
  const std::vector<FurthestPoint> furthest = furthest_above(simplices);
  for (std::size_t i = 0; i < simplices.size(); ++i) {
    if (furthest[i].row == FurthestPoint::kNoRow) continue;
    const PointId point = growth_.left_out()[furthest[i].row].point;
    extra_.push_back(point);
    const double* y = growth_.coordinates() + std::size_t{point.value} * rank;
    const auto plane = growth_.work().complex.plane(SimplexId{simplices[i]});
    const double gauge = std::inner_product(plane.begin(), plane.end(), y, -1.0);
    if (gauge > 0.0) above.push_back({point, SimplexId{simplices[i]}, gauge});
  }
  std::ranges::stable_sort(above, {}, &LocatedPoint::point);
  const auto same = std::ranges::unique(above, {}, &LocatedPoint::point);
  above.erase(same.begin(), same.end());
  std::ranges::sort(extra_);
  const auto known = std::ranges::unique(extra_);
  extra_.erase(known.begin(), known.end());
  return above;
}

/// Points that growth has left out, each with the simplex that it is highest above; not those that are above
/// none by more than rounding.
std::vector<LocatedPoint> Approximation::located(std::span<const PointId> left_out) const {
  const SimplicialComplex& complex = growth_.work().complex;
  const std::size_t rank = complex.rank, count = left_out.size();
  std::vector<LocatedPoint> highest;
  std::vector<double> columns(rank * count), gauges(count);
  for (const PointId point : left_out) {
    const double* y = growth_.coordinates() + std::size_t{point.value} * rank;
    for (std::size_t k = 0; k < rank; ++k) columns[k * count + highest.size()] = y[k];
    highest.push_back({point, SimplexId{}, 4.0 * growth_.work().options.shift});
  }
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    const auto plane = complex.plane(SimplexId{row});
    std::ranges::fill(gauges, -1.0);
    for (std::size_t k = 0; k < rank; ++k)
      for (std::size_t i = 0; i < count; ++i) gauges[i] += plane[k] * columns[k * count + i];
    for (std::size_t i = 0; i < count; ++i)
      if (gauges[i] > highest[i].gauge) highest[i] = {left_out[i], SimplexId{row}, gauges[i]};
  }
  std::erase_if(highest, [](const LocatedPoint& point) { return !point.simplex.valid(); });
  return highest;
}

/// Remembers, for each facet that is wider than `width`, the point that makes it so, and tells those that are
/// above a simplex that is a facet alone: no smaller slab helps there, growth has to take them in.
Offenders Approximation::add_offenders(const Covering& covering, const TrueWidths& widths, double width) {
  const std::size_t count = widths.widths.size();
  std::vector<std::uint32_t> size_of(count, 0), row_of(count, kNone), alone;
  for (std::uint32_t row = 0; row < covering.facet_of.size(); ++row) {
    if (covering.facet_of[row] == kNone) continue;
    ++size_of[covering.facet_of[row]];
    row_of[covering.facet_of[row]] = row;
  }
  Offenders offenders;
  for (std::uint32_t facet = 0; facet < count; ++facet) {
    if (widths.widths[facet] <= width) continue;
    const FurthestPoint& furthest = widths.furthest[facet];
    if (furthest.row != FurthestPoint::kNoRow) extra_.push_back(growth_.left_out()[furthest.row].point);
    if (size_of[facet] > 1) {
      offenders.widest_slab = std::max(offenders.widest_slab, widths.widths[facet]);
    } else {
      alone.push_back(row_of[facet]);
    }
  }
  // Above the simplex' own plane: along one that was fitted in vain a point may be furthest that is below it.
  offenders.above_simplices = far_above(alone);
  return offenders;
}

}  // namespace ndhull
