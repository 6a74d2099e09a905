#include "approx/plane_fit.h"

#include <algorithm>
#include <cmath>

namespace ndhull {
namespace {

double dot(std::size_t rank, const double* a, const double* b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rank; ++k) sum += a[k] * b[k];
  return sum;
}

/// Near points from which on only the highest are looked at.
constexpr std::size_t kManyNear = 256;

/// The points with the largest and, among the facet's vertices, the smallest product.
struct ExtremePair {
  std::uint32_t high = 0, low = 0;  // index into work.near; into the facet's vertices
  double height = 0.0, lowest = 0.0;
  double width() const { return height - lowest; }
};

ExtremePair find_near_extremes(PlaneFitWork& work, std::span<const double> normal) {
  ExtremePair pair;
  pair.high = work.near_table.find(normal.data(), work.products.data());
  pair.height = work.products[pair.high];
  for (std::size_t k = 0; k < normal.size(); ++k) work.next[k] = -normal[k];
  pair.low = work.facet_table.find(work.next.data(), work.products.data());
  pair.lowest = -work.products[pair.low];
  return pair;
}

void add_top(std::uint32_t row, std::vector<std::uint32_t>& tops) {
  if (std::find(tops.begin(), tops.end(), row) == tops.end()) tops.push_back(row);
}

void gather(const WidthSpace& space, std::span<const std::uint32_t> from, PlaneFitWork& work,
            SupportTable& table) {
  work.rows.resize(from.size() * space.rank());
  for (std::size_t i = 0; i < from.size(); ++i)
    std::copy_n(space.row(from[i]), space.rank(), work.rows.data() + i * space.rank());
  table.assign(space.rank(), work.rows);
}

/// work.near: the points within a width below `start`, the highest if they are very many.
void find_near(const WidthSpace& space, const FittedPlane& start, PlaneFitWork& work) {
  work.near.clear();
  work.above.clear();
  if (space.is_large()) {
    // Few of very many points are as high as the first shares of the width.
    for (double share = 0.125; share <= 1.0 && work.above.size() < kManyNear; share *= 2.0) {
      work.above.clear();
      space.find_above(start.normal, start.height - share * start.width(), work.above);
    }
  } else {
    space.table().rows_above(work.dots.data(), start.height - start.width(), work.near);
    for (const std::uint32_t row : work.near) work.above.push_back({work.dots[row], row});
    work.near.clear();
  }
  if (work.above.size() > kManyNear) {
    const auto end = work.above.begin() + static_cast<std::ptrdiff_t>(kManyNear);
    std::nth_element(work.above.begin(), end, work.above.end(),
                     [](const FurthestPoint& a, const FurthestPoint& b) {
                       return a.dot != b.dot ? a.dot > b.dot : a.row < b.row;
                     });
    work.above.erase(end, work.above.end());
  }
  for (const FurthestPoint& point : work.above) work.near.push_back(point.row);
}

}  // namespace

FittedPlane measure_plane(const WidthSpace& space, std::span<const double> normal,
                          std::span<const std::uint32_t> vertices, PlaneFitWork& work) {
  ++work.evaluations;
  FittedPlane plane{{normal.begin(), normal.end()}, -HUGE_VAL, HUGE_VAL};
  if (space.is_large()) {
    for (const std::uint32_t vertex : vertices) {
      const double product = dot(space.rank(), normal.data(), space.row(vertex));
      plane.low = std::min(plane.low, product);
      if (product <= plane.height) continue;
      plane.height = product;
      work.highest = vertex;
    }
    const FurthestPoint furthest = space.furthest(normal, plane.height);
    plane.height = furthest.dot;
    if (furthest.row != FurthestPoint::kNoRow) work.highest = furthest.row;
    return plane;
  }
  work.dots.resize(space.table().padded_count());
  work.highest = space.table().find(normal.data(), work.dots.data());
  plane.height = work.dots[work.highest];
  for (const std::uint32_t vertex : vertices) plane.low = std::min(plane.low, work.dots[vertex]);
  return plane;
}

double turn_among(const WidthSpace& space, std::span<const double> normal,
                  std::span<const std::uint32_t> near, std::span<const std::uint32_t> vertices,
                  unsigned steps, PlaneFitWork& work) {
  const std::size_t rank = space.rank();
  gather(space, near, work, work.near_table);
  gather(space, vertices, work, work.facet_table);
  work.products.resize(std::max(work.near_table.padded_count(), work.facet_table.padded_count()));
  work.trial.assign(normal.begin(), normal.end());
  work.next.resize(rank);
  work.best = work.trial;
  ExtremePair pair = find_near_extremes(work, work.trial);
  work.tops.assign(1, near[pair.high]);
  double best_width = pair.width();
  double step = 0.25;  // of the way to width 0, were the width linear
  for (unsigned i = 0; i < steps; ++i) {
    double across_sq = 0.0;
    const double along = pair.width();
    const double* high = space.row(near[pair.high]);
    const double* low = space.row(vertices[pair.low]);
    for (std::size_t k = 0; k < rank; ++k) {
      work.next[k] = high[k] - low[k] - along * work.trial[k];
      across_sq += work.next[k] * work.next[k];
    }
    if (!(across_sq > 0.0) || !(best_width > 0.0)) break;
    const double length = step * best_width / across_sq;
    for (std::size_t k = 0; k < rank; ++k) work.next[k] = work.trial[k] - length * work.next[k];
    const double scale = 1.0 / std::sqrt(dot(rank, work.next.data(), work.next.data()));
    for (std::size_t k = 0; k < rank; ++k) work.trial[k] = work.next[k] * scale;
    pair = find_near_extremes(work, work.trial);
    add_top(near[pair.high], work.tops);
    if (pair.width() < best_width) {
      best_width = pair.width();
      work.best = work.trial;
    } else {
      step *= 0.9;
    }
  }
  return best_width;
}

double turn_among_near(const WidthSpace& space, const FittedPlane& start,
                       std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work) {
  find_near(space, start, work);
  return turn_among(space, start.normal, work.near, vertices, steps, work);
}

FittedPlane narrow_plane(const WidthSpace& space, const FittedPlane& start,
                         std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work) {
  turn_among_near(space, start, vertices, steps, work);
  FittedPlane turned = measure_plane(space, work.best, vertices, work);
  if (turned.width() <= start.width()) return turned;
  return measure_plane(space, start.normal, vertices, work);
}

}  // namespace ndhull
