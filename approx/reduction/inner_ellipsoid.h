// An ellipsoid inside a growing hull: most points of a large set are inside it, which is proven in some
// nanoseconds each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "approx/reduction/row_bits.h"
#include "approx/reduction/sample_shape.h"
#include "core/complex/simplicial_complex.h"
#include "core/points.h"

namespace ndhull {

/// |z| < radius, with z as a sample's shape has it (approx/reduction/sample_shape.h): L z = y - m.
///
/// Proof  The simplices of a growing hull close around 0, and a segment from there to a point that is below
///        all their planes meets none of them: so they close around that point too, and it is inside. A point
///        is below plane a when a.(y - m) < 1 - a.m. The z that substitution computes solves (L + E) z = y -
///        m with |E| <= (n + 2) u |L| for each element (Higham. Accuracy and Stability of Numerical
///        Algorithms, 2nd ed., thm. 8.5), so a.(y - m) <= |z| (|L'a| + (n + 2) u ||L|'|a||). What the shift
///        and the rounding of planes, sums and squares add is far below the thousandth that is taken off.
class InnerEllipsoid {
 public:
  /// Contains nothing.
  InnerEllipsoid() = default;
  /// `reach`: no point is longer than this in the frame, nor is the sum of the absolute terms of its
  /// coordinates.
  InnerEllipsoid(const SampleShape& shape, double reach);

  /// The size: as large as the hull contains one.
  void fit(const SimplicialComplex& complex);
  /// Points that are looked at together: one bit each.
  static constexpr std::size_t kPoints = kWhitenedPoints;
  /// Which of these rows of the input, at most kPoints, are well inside the hull? A bit each; 0 when that is
  /// not proven.
  std::uint64_t contains(const PointView& points, std::span<const std::size_t> rows) const;

  /// Drops of the rows from `begin` to before `end` (as RowBits has them) those inside. What is inside by
  /// this is inside every later hull of the growth by far more than rounding.
  void drop_inside(const PointView& points, std::size_t begin, std::size_t end, RowBits& rows) const;

 private:
  double radius_below(std::span<const double> plane) const;

  SampleShape shape_;
  double rounding_ = 0.0;  // of a point in the frame
  double radius_sq_ = 0.0;
};

}  // namespace ndhull
