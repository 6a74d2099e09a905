#include "core/furthest_points.h"

#include <algorithm>

namespace ndhull {
namespace {

/// Directions after which a tree has paid for itself. To make one takes as long as some 4,000 searches in
/// bytes, whatever the number of points, and up to 5-d searches in it take a third of theirs. In each
/// dimension more a tree spares less: in 8-d, of 10^5 points on a sphere, it is no faster.
constexpr std::size_t kWorthATree = 1 << 12, kLowDimension = 5;
/// A tree of fewer points is made at once where many may be as far as bytes can tell: among 4,177 points of
/// real data, with ties, searches in bytes took twice as long.
constexpr std::size_t kFewPoints = 1 << 13;

std::size_t directions_worth_a_tree(std::size_t dimension, std::size_t points, bool are_scattered) {
  if (dimension > BytePoints::kMaxDimension || (points < kFewPoints && !are_scattered)) return 0;
  return kWorthATree << 2 * (dimension - std::min(dimension, kLowDimension));
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

void FurthestPoints::find(std::span<const double> normals, std::span<FurthestPoint> furthest) {
  if (!tree_ && directions_ + furthest.size() / 2 >= worth_a_tree_) make_tree();
  directions_ += furthest.size();
  if (tree_) {
    find_furthest(*tree_, normals, furthest);
  } else {
    find_furthest(*bytes_, normals, furthest);
  }
}

}  // namespace ndhull
