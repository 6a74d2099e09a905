// The furthest of many points along each of many directions: by products of bytes, or in a tree of the points
// once so many directions have come that a tree pays.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/search/byte_points.h"
#include "core/search/point_tree.h"

namespace ndhull {

/// Points to be searched again and again. How they are searched follows from the numbers of points, of
/// directions so far, and of points that bytes could not tell from the furthest.
class FurthestPoints {
 public:
  /// Shapes  points: at least one row of `dimension` numbers, which must outlive this; low, high: no
  ///         coordinate of a column is outside of them; are_scattered: hardly any is inside the others' hull,
  ///         as on a sphere.
  FurthestPoints(std::size_t dimension, StridedRows points, std::span<const double> low,
                 std::span<const double> high, bool are_scattered);

  /// So many directions come next, in several calls: a tree may pay at once.
  void expect(std::size_t directions);
  /// As find_furthest for BytePoints and PointTree. Which of several points with the same product is found
  /// depends on nothing but the points and the calls before.
  void find(std::span<const double> normals, std::span<FurthestPoint> furthest);

 private:
  void make_tree();

  std::size_t dimension_, worth_a_tree_, directions_ = 0;
  std::size_t tried_ = 0;  // points that bytes left to be tried
  StridedRows points_;
  std::optional<BytePoints> bytes_;
  std::optional<PointTree> tree_;
};

}  // namespace ndhull
