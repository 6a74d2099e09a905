#include "core/search/furthest_points.h"

#include <algorithm>
#include <bit>

namespace ndhull {
namespace {

/// A tree of fewer points is made at once where many may be as far as bytes can tell: among 4,177 points of
/// real data, with ties, searches in bytes took twice as long.
constexpr std::size_t kFewPoints = 1 << 13;

/// Where bytes leave so many points to be tried for a direction, or this part of all, trying them takes half
/// of the time: 10^5 points in the faces of a 6-d cube took 1.5 times as long as in a tree.
constexpr std::size_t kManyTried = 64, kPartTried = 512;

/// Directions after which a tree has paid for itself. To make one takes as long as some 4,000 searches in
/// bytes, whatever the number of points. How much a tree spares depends on how dense the points are: measured
/// on spheres, 6,000 directions pay on 10^5 points in 5-d and 10^6 in 6-d, 33,000 on 10^5 in 6-d, 53,000 on
/// 10^6 in 8-d; 10^4 in 5-d or 10^6 in 10-d never do. Up to 4-d bytes tell few points apart.
std::size_t directions_worth_a_tree(std::size_t dimension, std::size_t points, bool are_scattered) {
  constexpr std::size_t kBuilding = 1 << 12, kOfLow = 1 << 10, kLowDimension = 4, kDense = 8;
  if (dimension > BytePoints::kMaxDimension || (points < kFewPoints && !are_scattered)) return 0;
  if (dimension <= kLowDimension) return kOfLow;
  const std::size_t sparse = 2 * dimension + kDense;
  const auto dense = static_cast<std::size_t>(std::bit_width(points));
  return kBuilding << (std::max(sparse, dense) - dense);
}

}  // namespace

FurthestPoints::FurthestPoints(std::size_t dimension, StridedRows points, std::span<const double> low,
                               std::span<const double> high, bool are_scattered)
    : dimension_(dimension),
      worth_a_tree_(directions_worth_a_tree(dimension, points.count, are_scattered)),
      points_(points) {
  if (worth_a_tree_ > 0) bytes_.emplace(dimension, points, low, high);
}

void FurthestPoints::make_tree() {
  bytes_.reset();
  std::vector<double> copy;
  std::span<const double> rows(points_.data, points_.count * dimension_);
  if (points_.stride != dimension_) {
    copy.resize(rows.size());
    for (std::size_t row = 0; row < points_.count; ++row)
      std::copy_n(points_.row(row), dimension_, copy.data() + row * dimension_);
    rows = copy;
  }
  tree_.emplace(dimension_, rows);
}

void FurthestPoints::expect(std::size_t directions) {
  if (!tree_ && directions_ + directions / 2 >= worth_a_tree_) make_tree();
}

void FurthestPoints::find(std::span<const double> normals, std::span<FurthestPoint> furthest) {
  constexpr std::size_t kAtATime = 1 << 10;
  expect(furthest.size());
  for (std::size_t begin = 0; begin < furthest.size() && !tree_; begin += kAtATime) {
    const std::size_t count = std::min(kAtATime, furthest.size() - begin);
    tried_ += find_furthest(*bytes_, normals.subspan(begin * dimension_, count * dimension_),
                            furthest.subspan(begin, count));
    directions_ += count;
    if (tried_ / directions_ <= std::max(kManyTried, points_.count / kPartTried)) continue;
    make_tree();
    normals = normals.subspan((begin + count) * dimension_);
    furthest = furthest.subspan(begin + count);
  }
  if (tree_) find_furthest(*tree_, normals, furthest);
}

}  // namespace ndhull
