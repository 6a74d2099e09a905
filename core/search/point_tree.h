// The furthest of many points along each of many directions: outer planes of hulls that leave points out, and
// which point is furthest above which.
//
// Idea. Points in groups of neighbours, groups in clusters, each in a box and in a cone that begins in the
// middle of all points. Round hulls are what cones are for: from the middle a group is a small cap. Skewed
// data, most of which lie to one side of the middle, and long ones are what boxes are for. Along a direction
// the points that were furthest along directions before and the cluster that may reach furthest are looked at
// first; most others then reach less far than the best point found. Points of the rest are multiplied in
// single precision, those that may be the furthest again in double. Bounds include their own rounding, so the
// result is the same, digit for digit, as that of all products.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// The cones and boxes of one level, by columns: what is within an angle of an axis and not longer than a
/// reach, and no further from a centre than half a size in each coordinate. In coordinates scaled and moved as
/// PointTree says.
struct Enclosures {
  std::size_t count = 0, stride = 0;
  std::vector<float> axes;                     ///< dimension x stride, of length 1
  std::vector<float> reaches, cosines, sines;  ///< stride; of the angle; those behind the last reach nowhere
  std::vector<float> centres, half_sizes;      ///< dimension x stride
};

/// Points in an order in which neighbours are together.
class PointTree {
 public:
  /// Points of a group, and groups of a cluster: a vector of floats where vectors are longest.
  static constexpr std::size_t kSize = 16;

  /// Shapes  points: any number of rows x dimension, at least one.
  /// Cost    O(n log n) for n points, shared out among threads; 12 bytes a coordinate. The same for any
  ///         number of threads.
  PointTree(std::size_t dimension, std::span<const double> points);

  std::size_t dimension() const { return dimension_; }
  std::size_t point_count() const { return order_.size(); }
  /// Place i of the tree holds this row of the points.
  const std::vector<std::uint32_t>& order() const { return order_; }
  /// The place of each row.
  std::vector<std::uint32_t> place_of_rows() const;
  /// Enclosures are in coordinates x / size - middle of each column, which are in [-1, 1]; columns whose
  /// extents are alike have the same size: a ball is one in these too, which is what cones are for.
  std::span<const double> column_sizes() const { return column_sizes_; }
  std::span<const double> middle() const { return middle_; }
  /// No point, and no corner of a box, is longer in those coordinates.
  double reach() const { return reach_; }
  /// No point is.
  double point_reach() const { return point_reach_; }
  const Enclosures& groups() const { return groups_; }
  const Enclosures& clusters() const { return clusters_; }
  /// Coordinate k of the kSize points of a group in the enclosures' coordinates; the last point fills the last
  /// group.
  const float* scaled_rows(std::size_t group, std::size_t k) const {
    return scaled_rows_.data() + (group * dimension_ + k) * kSize;
  }
  /// The point at a place, as it was given.
  const double* point(std::size_t place) const { return points_.data() + place * dimension_; }

 private:
  void find_columns(std::span<const double> points);
  void fill(std::span<const double> points);
  void enclose(std::size_t first_group, std::size_t last_group, Enclosures& level, std::size_t at);

  std::size_t dimension_;
  std::vector<std::uint32_t> order_;
  std::vector<double> column_sizes_;
  std::vector<double> middle_;
  double reach_ = 0.0, point_reach_ = 0.0;
  std::vector<double> points_;      // in order
  std::vector<float> scaled_rows_;  // by groups and columns
  Enclosures groups_, clusters_;
};

/// The furthest point along one direction.
struct FurthestPoint {
  static constexpr std::uint32_t kNoRow = 0xFFFF'FFFFu;
  double dot = 0.0;            ///< its product; in: a product that is known to be attained, or -infinity
  std::uint32_t row = kNoRow;  ///< of the tree's points; kNoRow: none has a larger product than that
};

/// Finds the largest product of each normal with any of the points.
///
/// Shapes  normals: directions x dimension; furthest: one a direction.
/// Error   each product is a chain of fused multiply-adds from the first coordinate on: at most
///         gamma_dimension sum |n_k x_k| (Higham. Accuracy and Stability of Numerical Algorithms, 2nd ed.,
///         eq. 3.5).
/// Cost    a cone for each 256 points, and the points of those that reach furthest: on 10^5 points of a
///         sphere in 8-d some 3 us a direction. At most all products.
void find_furthest(const PointTree& tree, std::span<const double> normals, std::span<FurthestPoint> furthest);

/// Appends every point whose product with `normal` is at least `least`, with the product, in the order of the
/// tree. Error as above. Cost  a cone for each 256 points, and the points of those that reach so far.
void find_above(const PointTree& tree, std::span<const double> normal, double least,
                std::vector<FurthestPoint>& found);

}  // namespace ndhull
