#include "approx/slabs/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ndhull {
namespace {

double dot(std::size_t rank, const double* a, const double* b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rank; ++k) sum += a[k] * b[k];
  return sum;
}

/// Near points from which on only the highest are looked at.
constexpr std::size_t kManyNear = 256;
/// Of so many points it takes less to ask a few times for the highest than once for all that are near.
constexpr std::size_t kManyRows = 8192;

/// work.near: the points within a width below `start`, the highest if they are very many, but no vertices of
/// the facet.
void find_near(const WidthSpace& space, const FittedPlane& start, std::span<const std::uint32_t> vertices,
               PlaneFitWork& work) {
  work.near.clear();
  work.above.clear();
  if (space.is_large()) {
    // Few of very many points are as high as the first shares of the width.
    for (double share = 0.125; share <= 1.0 && work.above.size() < kManyNear; share *= 2.0) {
      work.above.clear();
      space.find_above(start.normal, start.height - share * start.width(), work.above);
    }
    for (const FurthestPoint& point : work.above) work.near.push_back(point.row);
  } else {
    const bool may_be_many = space.table().count() > kManyRows;
    for (double share = may_be_many ? 0.0625 : 1.0; share <= 1.0 && work.near.size() < kManyNear;
         share *= 2.0) {
      work.near.clear();
      space.table().rows_above(work.products, start.height - share * start.width(), space.table().count(),
                               work.near);
    }
    if (work.near.size() > kManyNear)
      for (const std::uint32_t row : work.near) work.above.push_back({work.products.dots[row], row});
  }
  if (work.above.size() > kManyNear) {
    const auto end = work.above.begin() + static_cast<std::ptrdiff_t>(kManyNear);
    std::nth_element(work.above.begin(), end, work.above.end(),
                     [](const FurthestPoint& a, const FurthestPoint& b) {
                       return a.dot != b.dot ? a.dot > b.dot : a.row < b.row;
                     });
    work.near.resize(kManyNear);
    std::transform(work.above.begin(), end, work.near.begin(),
                   [](const FurthestPoint& point) { return point.row; });
  }
  work.pass_of_row.resize(space.table().count(), 0);
  ++work.pass;
  for (const std::uint32_t vertex : vertices) work.pass_of_row[vertex] = work.pass;
  std::erase_if(work.near, [&](std::uint32_t row) { return work.pass_of_row[row] == work.pass; });
}

}  // namespace

double lowest_dot(const WidthSpace& space, std::span<const double> normal,
                  std::span<const std::uint32_t> vertices) {
  double low = HUGE_VAL;
  for (const std::uint32_t vertex : vertices)
    low = std::min(low, dot(space.rank(), normal.data(), space.row(vertex)));
  return low;
}

FittedPlane measure_plane(const WidthSpace& space, std::span<const double> normal,
                          std::span<const std::uint32_t> vertices, PlaneFitWork& work) {
  FittedPlane plane{{normal.begin(), normal.end()}, -HUGE_VAL, HUGE_VAL};
  if (space.is_large()) {
    for (const std::uint32_t vertex : vertices) {
      const double product = dot(space.rank(), normal.data(), space.row(vertex));
      plane.low = std::min(plane.low, product);
      if (product <= plane.height) continue;
      plane.height = product;
      plane.highest = vertex;
    }
    const FurthestPoint furthest = space.furthest(normal, plane.height);
    plane.height = furthest.dot;
    if (furthest.row != FurthestPoint::kNoRow) plane.highest = furthest.row;
    return plane;
  }
  plane.highest = space.table().find(normal.data(), work.products, plane.height);
  plane.low = lowest_dot(space, normal, vertices);
  return plane;
}

void list_vertices_from(const WidthSpace& space, double least, const PlaneFitWork& work,
                        std::vector<std::uint32_t>& rows) {
  rows.clear();
  if (space.is_large()) {  // measuring has left no products
    rows.resize(space.vertex_count());
    std::iota(rows.begin(), rows.end(), 0u);
  } else {
    space.table().rows_above(work.products, least, space.vertex_count(), rows);
  }
}

double turn_among(const WidthSpace& space, std::span<const double> normal,
                  std::span<const std::uint32_t> near, std::span<const std::uint32_t> vertices,
                  unsigned steps, PlaneFitWork& work) {
  work.points.assign(space.rank(), space.row(0), vertices, near);
  work.best.assign(normal.begin(), normal.end());
  return turn_further(steps, work);
}

double turn_further(unsigned steps, PlaneFitWork& work) { return work.points.turn(steps, work.best.data()); }

double turn_among_near(const WidthSpace& space, const FittedPlane& start,
                       std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work) {
  find_near(space, start, vertices, work);
  return turn_among(space, start.normal, work.near, vertices, steps, work);
}

FittedPlane narrow_plane(const WidthSpace& space, const FittedPlane& start,
                         std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work) {
  turn_among_near(space, start, vertices, steps, work);
  FittedPlane turned = measure_plane(space, work.best, vertices, work);
  return turned.width() <= start.width() ? turned : start;
}

}  // namespace ndhull
