// Doubles are binary fractions: sums and products of them are exact in CGAL's Gmpzf (an integer of any length
// times a power of two), and quotients in Gmpq. Orientation is CGAL's filtered predicate: intervals first,
// exact numbers where they leave the sign open.
//
// This file is compiled apart from the rest, with -frounding-math: CGAL changes the rounding mode inside.

#include "core/exact_orientation.h"

#include <CGAL/Epick_d.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Gmpzf.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace ndhull {
namespace {

/// Rows of the augmented system, solved in place by Gauss-Jordan elimination. False: singular.
bool solve(std::vector<std::vector<CGAL::Gmpq>>& rows) {
  const std::size_t size = rows.size();
  for (std::size_t column = 0; column < size; ++column) {
    std::size_t pivot = column;
    while (pivot < size && CGAL::is_zero(rows[pivot][column])) ++pivot;
    if (pivot == size) return false;
    std::swap(rows[pivot], rows[column]);
    for (std::size_t row = 0; row < size; ++row) {
      if (row == column || CGAL::is_zero(rows[row][column])) continue;
      const CGAL::Gmpq factor = rows[row][column] / rows[column][column];
      for (std::size_t k = column; k <= size; ++k) rows[row][k] -= factor * rows[column][k];
    }
  }
  for (std::size_t row = 0; row < size; ++row) rows[row][size] /= rows[row][row];
  return true;
}

}  // namespace

double exact_plane_value(const CentredPlane& plane, std::span<const double> point) {
  CGAL::Gmpzf value = CGAL::Gmpzf(plane.offset) - CGAL::Gmpzf(plane.claimed) * CGAL::Gmpzf(plane.unit);
  for (std::size_t k = 0; k < plane.normal.size(); ++k) {
    CGAL::Gmpzf difference(point[k]);
    if (!plane.reference.empty()) difference -= CGAL::Gmpzf(plane.reference[k]);
    value += difference * CGAL::Gmpzf(plane.normal[k]);
  }
  const CGAL::Sign sign = CGAL::sign(value);
  if (sign == CGAL::ZERO) return 0.0;
  const double rounded = CGAL::to_double(value);
  if (rounded != 0.0) return rounded;
  return std::copysign(std::numeric_limits<double>::denorm_min(), sign == CGAL::POSITIVE ? 1.0 : -1.0);
}

int exact_orientation(std::span<const double> points, std::size_t dimension) {
  using Kernel = CGAL::Epick_d<CGAL::Dynamic_dimension_tag>;
  std::vector<Kernel::Point_d> rows;
  rows.reserve(dimension + 1);
  for (std::size_t row = 0; row <= dimension; ++row) {
    const double* const begin = points.data() + row * dimension;
    rows.emplace_back(static_cast<int>(dimension), begin, begin + dimension);
  }
  const Kernel kernel(static_cast<int>(dimension));
  return static_cast<int>(kernel.orientation_d_object()(rows.begin(), rows.end()));
}

HeightTest exact_height_test(std::span<const double> vertices, std::span<const double> normal,
                             std::span<const double> point, double outer, double inner, double unit) {
  const std::size_t d = normal.size();
  // Unknowns lambda_1 .. lambda_d, height; one equation for each coordinate and one for the sum.
  std::vector<std::vector<CGAL::Gmpq>> rows(d + 1, std::vector<CGAL::Gmpq>(d + 2));
  for (std::size_t k = 0; k < d; ++k) {
    for (std::size_t i = 0; i < d; ++i) rows[k][i] = CGAL::Gmpq(vertices[i * d + k]);
    rows[k][d] = CGAL::Gmpq(normal[k]);
    rows[k][d + 1] = CGAL::Gmpq(point[k]);
  }
  for (std::size_t i = 0; i < d; ++i) rows[d][i] = CGAL::Gmpq(1);
  rows[d][d + 1] = CGAL::Gmpq(1);
  if (!solve(rows)) return HeightTest::kSingular;

  CGAL::Gmpq positive(0);
  for (std::size_t i = 0; i < d; ++i) {
    if (CGAL::is_positive(rows[i][d + 1])) positive += rows[i][d + 1];
  }
  const CGAL::Gmpq width = (CGAL::Gmpq(outer) - CGAL::Gmpq(inner)) * CGAL::Gmpq(unit);
  return rows[d][d + 1] <= width * positive ? HeightTest::kWithin : HeightTest::kAbove;
}

}  // namespace ndhull
