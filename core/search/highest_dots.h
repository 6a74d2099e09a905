// How far along each of many directions do points reach? The products that outer offsets are made of.
//
// Idea. A facet's own vertices are the highest points along its normal, or nearly so. What is needed is a
// proof that no other point is higher: groups of near points are left out by a ball around them, the points
// of the others by a product in single precision, and only what both leave in doubt is computed in double
// precision. All bounds include their own rounding, so the result is the same, digit for digit, as that of
// all products.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// Points in groups of neighbours, each with a ball around it.
class PointGroups {
 public:
  static constexpr std::size_t kSize =
      16;  ///< points in a group: a vector of floats where vectors are longest

  /// Shapes  points: any number of rows x dimension, at least one.
  /// `in_order`: leave the points as they are and do not look for neighbours; for few directions.
  /// Cost    O(n log n) comparisons for n points.
  PointGroups(std::size_t dimension, std::span<const double> points, bool in_order);

  std::size_t dimension() const { return dimension_; }
  std::size_t point_count() const { return point_count_; }
  std::size_t count() const { return count_; }
  std::size_t padded_count() const { return padded_count_; }  ///< a multiple of 64

  /// Powers of two; a column divided by its size is in [-1, 1], if it holds nothing above 2^1023. The float
  /// tables hold columns scaled so.
  std::span<const double> column_sizes() const { return column_sizes_; }
  /// What a product of scaled entries is to be at most: less than 1 where columns are not in [-1, 1].
  double product_size() const { return product_size_; }
  /// Coordinate k of the kSize points of a group.
  const double* rows(std::size_t group, std::size_t k) const {
    return rows_.data() + (group * dimension_ + k) * kSize;
  }
  const float* scaled_rows(std::size_t group, std::size_t k) const {
    return scaled_rows_.data() + (group * dimension_ + k) * kSize;
  }
  /// Coordinate k of the balls' centres, and their radii; those behind the last group hold nothing.
  const float* centres(std::size_t k) const { return centres_.data() + k * padded_count_; }
  const float* radii() const { return radii_.data(); }

 private:
  void fill_group(std::size_t group, std::span<const double> points, std::span<const std::uint32_t> members);
  void find_centre(std::size_t group);

  std::size_t dimension_, point_count_, count_, padded_count_;
  std::vector<double> column_sizes_;
  double product_size_ = 1.0;
  std::vector<double> rows_;
  std::vector<float> scaled_rows_, centres_, radii_;
};

/// A part of the largest product: smaller than what products in single precision are off by.
inline constexpr double kCloseProducts = 1e-9;

/// What is known of the products of facets' normals with their own vertices.
struct OwnDots {
  std::span<const double> low, high;  ///< smallest and largest, one a facet
  std::size_t count = 0;              ///< vertices that each of the facets has; 0: they differ
  /// Where they differ: how many are within kCloseProducts of the largest, one a facet.
  std::span<const std::uint32_t> close;
};

/// Largest dot product of each normal with any of the points.
///
/// Shapes  normals: facets x dimension; largest: one a facet. The own vertices are among the points.
/// Error   each dot product is a chain of fused multiply-adds from the first coordinate on: at most
///         gamma_dimension sum |n_k x_k| (Higham. Accuracy and Stability of Numerical Algorithms, 2nd ed.,
///         eq. 3.5).
/// Cost    at most facets x points x dimension fused multiply-adds; for the facets of many points in 5-d a
///         tenth.
void highest_dots(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                  std::span<double> largest);

}  // namespace ndhull
