// Where the points of a large set are, and how they scatter: coordinates in which they are about as wide in
// all directions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "approx/reduction/sample_shape_kernel.h"
#include "core/frame.h"
#include "core/points.h"

namespace ndhull {

/// z with L z = y - m: y a point in the frame, m and L L' mean and covariance of a sample. L is the identity
/// where rounding hides the scatter.
class SampleShape {
 public:
  SampleShape() = default;
  /// `points`: count x frame.rank, in the frame; at most kMaxRank columns.
  SampleShape(const Frame& frame, const double* points, std::size_t count);

  std::size_t rank() const { return rank_; }
  std::size_t dimension() const { return dimension_; }
  const std::vector<double>& mean() const { return mean_; }
  /// L: rank x rank, row-major, a lower triangle.
  const std::vector<double>& factor() const { return factor_; }

  /// z of up to kWhitenedPoints rows of the input, and |z|^2.
  ///
  /// Shapes    z: rank x kWhitenedPoints, the rows in columns; behind the last one anything. The same for
  ///           length_sq.
  /// Rounding  products are rounded before they are added, in the order of substitution: the same on every
  ///           machine.
  void whiten(const PointView& points, std::span<const std::size_t> rows, double* z, double* length_sq) const;

 private:
  std::size_t rank_ = 0, dimension_ = 0;
  bool is_diagonal_ = false;
  std::vector<double> centre_, map_;  // of the frame
  std::vector<double> mean_, factor_, inverse_pivots_;
};

}  // namespace ndhull
