// The coordinates that facets are fitted in: an isometric image of the data in length units, so that a
// direction's products are distances, also with --unit-cube and for flat data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/search/point_tree.h"
#include "core/search/support.h"

namespace ndhull {

/// Images of points y of the frame: z with R^T z = y (R: gradient_factor, rank x rank, upper triangular).
///
/// Shapes  coordinates: any number of rows x rank; points: some of these. Result: points x rank.
/// Cost    O(rank^2) a point, shared by all threads.
std::vector<double> map_to_lengths(std::size_t rank, std::span<const double> gradient_factor,
                                   const double* coordinates, std::span<const PointId> points);

/// Points that say how wide a facet is: the vertices of the complex and the points that reach out furthest.
///
/// Shapes  a point of the frame has the image that map_to_lengths says; the plane a of the frame has the
///         normal R a, whose length is one over its distance from the frame's centre.
class WidthSpace {
 public:
  /// vertices and others: points without repetition; coordinates: any number of rows x rank, in the frame;
  /// planes: about so many will be looked for, at most.
  WidthSpace(std::size_t rank, std::vector<double> gradient_factor, const double* coordinates,
             std::size_t point_count, std::span<const PointId> vertices, std::span<const PointId> others,
             std::size_t planes = SIZE_MAX);

  std::size_t rank() const { return rank_; }
  std::size_t vertex_count() const { return vertex_count_; }
  /// How many other points there are, in parts of the vertices: where these are points that growth left out,
  /// how much shorter it was than the exact hull's.
  double share_of_others() const {
    return static_cast<double>(table_.count()) / static_cast<double>(vertex_count_) - 1.0;
  }
  std::span<const double> gradient_factor() const { return factor_; }
  /// Of the input, of which some are in the space.
  std::size_t point_count() const { return row_of_point_.size(); }
  const SupportTable& table() const { return table_; }
  const double* row(std::uint32_t row) const { return rows_.data() + std::size_t{row} * rank_; }
  PointId point_of(std::uint32_t row) const { return point_of_row_[row]; }
  /// Of a vertex or other point that was given.
  std::uint32_t row_of(PointId point) const { return row_of_point_[point.value]; }

  /// So many points, and planes, that products of a direction with all of them are to be avoided.
  bool is_large() const { return tree_.has_value(); }
  /// The furthest point along a direction, where a product that is attained is known. Its row is none when no
  /// other point reaches further. Precondition: is_large(). Cost  some 1 to 10 us (core/search/point_tree.h).
  FurthestPoint furthest(std::span<const double> normal, double attained) const;
  /// Appends the points that are as far along `normal` as `least`. Precondition: is_large().
  void find_above(std::span<const double> normal, double least, std::vector<FurthestPoint>& found) const;

  /// The unit normal of a plane of the frame.
  void normal_of(std::span<const double> plane, double* normal) const;
  /// How far a plane of the frame is from the frame's centre.
  double distance_of(std::span<const double> plane) const;
  /// The plane of the frame with this unit normal at `height` from the centre.
  void plane_of(const double* normal, double height, double* plane) const;
  /// m with m . a = (R a) . normal for all a: the sign says on which side of `normal` a plane faces. Of a
  /// point of the space in place of a normal: the point in the frame.
  void facing(const double* normal, double* m) const;

 private:
  std::size_t rank_ = 0, vertex_count_ = 0;
  std::vector<double> factor_;
  std::vector<PointId> point_of_row_;
  std::vector<std::uint32_t> row_of_point_;
  std::vector<double> rows_;
  SupportTable table_;
  std::optional<PointTree> tree_;
};

}  // namespace ndhull
