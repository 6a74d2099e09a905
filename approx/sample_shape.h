// Where the points of a large set are, and how they scatter: coordinates in which they are about as wide in
// all directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/row_bits.h"
#include "approx/sample_shape_kernel.h"
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

  /// z of up to kWhitenedPoints points of the input, and |z|^2.
  ///
  /// Shapes    points: count x dimension. z: rank x kWhitenedPoints, the points in columns.
  /// Rounding  products are rounded before they are added, in the order of substitution: the same on every
  ///           machine.
  void whiten(const double* points, std::size_t count, double* z, double* length_sq) const;

 private:
  std::size_t rank_ = 0, dimension_ = 0;
  bool is_diagonal_ = false;
  std::vector<double> centre_, map_;  // of the frame
  std::vector<double> mean_, factor_, inverse_pivots_;
};

/// Copies rows begin .. end of a view that are among `rows`, kWhitenedPoints at a time, and calls look(ids,
/// their coordinates as doubles, how many).
template <class Look>
void for_some_rows(const PointView& points, std::size_t begin, std::size_t end, const RowBits& rows,
                   const Look& look) {
  std::vector<double> copies(kWhitenedPoints * points.dimension);
  std::vector<std::size_t> ids(kWhitenedPoints);
  std::size_t count = 0;
  rows.for_each(begin, end, [&](std::size_t row) {
    points.copy_row(row, copies.data() + count * points.dimension);
    ids[count++] = row;
    if (count < kWhitenedPoints) return;
    look(ids.data(), copies.data(), count);
    count = 0;
  });
  if (count > 0) look(ids.data(), copies.data(), count);
}

}  // namespace ndhull
