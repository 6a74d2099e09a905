// The hull proves n.(x - r) + c <= w for every point x: reference r, centred offset c, w the outer offset in
// input units, all of them doubles. A row holds n and one number b, so what is wanted is
//   b <= c - n.r - w - E,   E a bound on the error of evaluating n.x + b in doubles.
// Every rounding below is bounded by gamma_k = k u / (1 - k u) times the sum of the absolute terms, whatever
// the order of summation, and b is moved outwards by these bounds. Source: Higham. Accuracy and Stability of
// Numerical Algorithms, 2nd ed., 2002, sections 3.1 and 4.2.
#include "approx/planes/written_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "approx/reduction/point_reduction.h"
#include "core/error.h"

namespace ndhull {
namespace {

double gamma_bound(std::size_t operations) {
  const double rounding = static_cast<double>(operations) * 0x1p-53;
  return rounding / (1.0 - rounding);
}

/// Calls use(row) for all rows; of many, those that were used need no memory any more.
template <class Use>
void for_each_row(const PointView& points, const Use& use) {
  constexpr std::size_t kRowsInBlock = std::size_t{1} << 15;
  for (std::size_t begin = 0; begin < points.rows; begin += kRowsInBlock) {
    const std::size_t end = std::min(points.rows, begin + kRowsInBlock);
    for (std::size_t row = begin; row < end; ++row) use(row);
    if (points.rows >= kPointsToReduce) give_back_rows(points, begin, end);
  }
}

/// The highest value of n . x + b over all points, as exact arithmetic would have it at most, or, with
/// direction -1, the lowest, as it would have it at least.
double furthest_value(std::span<const double> plane, const PointView& points, std::span<const double> largest,
                      double direction) {
  const std::size_t dimension = points.dimension;
  double furthest = -HUGE_VAL, size = std::abs(plane[dimension]);
  for (std::size_t k = 0; k < dimension; ++k) size += std::abs(plane[k]) * largest[k];
  for_each_row(points, [&](std::size_t row) {
    double value = plane[dimension];
    for (std::size_t k = 0; k < dimension; ++k) value += plane[k] * points.at(row, k);
    furthest = std::max(furthest, direction * value);
  });
  const double underflow = static_cast<double>(2 * dimension + 4) * std::numeric_limits<double>::denorm_min();
  return direction * (furthest + gamma_bound(dimension + 5) * size + underflow);
}

}  // namespace

std::string_view to_string(PlaneKind kind) {
  switch (kind) {
    case PlaneKind::kOuter: return "outer";
    case PlaneKind::kMean: return "mean";
    case PlaneKind::kInner: return "inner";
  }
  return "unknown";
}

std::vector<double> largest_coordinates(const PointView& points) {
  std::vector<double> largest(points.dimension, 0.0);
  for_each_row(points, [&](std::size_t row) {
    for (std::size_t k = 0; k < points.dimension; ++k) {
      largest[k] = std::max(largest[k], std::abs(points.at(row, k)));
    }
  });
  return largest;
}

WrittenPlanes::WrittenPlanes(const Hull& hull, const PointView& points, PlaneKind kind)
    : hull_(hull), kind_(kind), largest_(points.dimension, 0.0) {
  if (kind == PlaneKind::kMean) return;
  largest_ = largest_coordinates(points);
}

double written_offset(const CentredPlane& plane, std::span<const double> largest, double direction) {
  const std::span<const double> normal = plane.normal;
  const std::size_t dimension = normal.size();
  const double claimed = plane.claimed * plane.unit;
  double offset = plane.offset;
  double size = std::abs(offset), evaluated_size = 0.0;
  for (std::size_t k = 0; k < dimension; ++k) {
    const double product = normal[k] * plane.reference[k];
    offset -= product;
    size += std::abs(product);
    evaluated_size += std::abs(normal[k]) * largest[k];
  }
  offset -= claimed;
  size += std::abs(claimed);
  // Operations in one term: its product, dimension + 1 additions. Three spare ones cover the roundings of the
  // sizes themselves, which are smaller by another factor u.
  const double rounding_error = gamma_bound(dimension + 5) * size;
  const double evaluation_error = gamma_bound(dimension + 5) * (evaluated_size + std::abs(offset));
  // Below the normal range a product is off by half the smallest number, not by a ratio.
  const double underflow = static_cast<double>(2 * dimension + 4) * std::numeric_limits<double>::denorm_min();
  const double moved = offset - direction * (rounding_error + evaluation_error + underflow);
  return std::nextafter(moved, -direction * HUGE_VAL);
}

void WrittenPlanes::fill(FacetId facet, std::span<double> row) const {
  const std::span<const double> normal = hull_.normal(facet);
  NDHULL_CHECK(row.size() == normal.size() + 1);
  std::copy(normal.begin(), normal.end(), row.begin());
  double& offset = row[normal.size()];
  CentredPlane plane{normal, hull_.reference, hull_.centred_offset(facet), 0.0,
                     hull_.input_per_length_unit(facet)};
  switch (kind_) {
    case PlaneKind::kOuter:
      plane.claimed = hull_.outer_offset(facet);
      offset = written_offset(plane, largest_, 1.0);
      break;
    case PlaneKind::kMean: offset = hull_.offset(facet); break;
    case PlaneKind::kInner:
      plane.claimed = hull_.inner_offset(facet);
      offset = written_offset(plane, largest_, -1.0);
      break;
  }
  if (!std::isfinite(offset)) {
    throw Error(ErrorCode::kNotFinite, "plane of facet " + std::to_string(facet.value) +
                                           ": found an offset beyond the range of doubles, expected a finite "
                                           "one; divide the coordinates by a power of two");
  }
}

std::vector<double> subspace_planes(std::span<const double> equations, const PointView& points,
                                    PlaneKind kind) {
  std::vector<double> rows;
  if (equations.empty()) return rows;
  const std::size_t dimension = points.dimension, columns = dimension + 1;
  const std::vector<double> largest = largest_coordinates(points), origin(dimension, 0.0);
  std::vector<double> plane(columns);
  for (std::size_t equation = 0; equation < equations.size(); equation += columns) {
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t k = 0; k < columns; ++k) plane[k] = sign * equations[equation + k];
      if (kind != PlaneKind::kMean) {
        const double direction = kind == PlaneKind::kOuter ? 1.0 : -1.0;
        const double furthest = furthest_value(plane, points, largest, direction);
        plane[dimension] = written_offset(
            {{plane.data(), dimension}, origin, plane[dimension], furthest, 1.0}, largest, direction);
      }
      rows.insert(rows.end(), plane.begin(), plane.end());
    }
  }
  return rows;
}

}  // namespace ndhull
