#include "core/linear/greedy_simplex.h"

#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/linear/greedy_simplex.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "core/machine/blocks.h"
#include "core/machine/huge_array.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

// Plain loops over columns, for the compiler to turn into vectors: without fused operations, so that all
// instruction sets give the same bits. A few rows at a time stay in the first-level cache.
constexpr std::size_t kRows = 256;

namespace hn = hwy::HWY_NAMESPACE;

/// The first of the largest values.
std::size_t find_largest(std::span<const double> values) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag), whole = values.size() / lanes * lanes;
  auto largest_lanes = hn::Set(tag, -HUGE_VAL);
  for (std::size_t i = 0; i < whole; i += lanes)
    largest_lanes = hn::Max(largest_lanes, hn::LoadU(tag, values.data() + i));
  double largest = hn::GetLane(hn::MaxOfLanes(tag, largest_lanes));
  for (std::size_t i = whole; i < values.size(); ++i) largest = std::max(largest, values[i]);
  std::size_t place = 0;
  while (place < whole &&
         hn::AllFalse(tag, hn::Eq(hn::LoadU(tag, values.data() + place), hn::Set(tag, largest))))
    place += lanes;
  while (place + 1 < values.size() && values[place] != largest) ++place;  // NaN equals nothing
  return place;
}

/// Moves each row by -origin, takes its part along `direction` (unit, or zero) out of it, and squares its
/// length. Columns: dimension x stride.
void reduce_rows(double* columns, std::size_t stride, std::size_t begin, std::size_t end,
                 std::span<const double> origin, std::span<const double> direction, double* length_sq) {
  for (std::size_t first = begin; first < end; first += kRows) {
    const std::size_t count = std::min(kRows, end - first);
    double along[kRows] = {}, sum[kRows] = {};
    for (std::size_t k = 0; k < direction.size(); ++k) {
      const double* column = columns + k * stride + first;
      for (std::size_t i = 0; i < count; ++i) along[i] += (column[i] - origin[k]) * direction[k];
    }
    for (std::size_t k = 0; k < direction.size(); ++k) {
      double* column = columns + k * stride + first;
      for (std::size_t i = 0; i < count; ++i) {
        column[i] = (column[i] - origin[k]) - along[i] * direction[k];
        sum[i] += column[i] * column[i];
      }
    }
    std::copy_n(sum, count, length_sq + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

namespace {

/// What is left of the points, as columns.
class Residuals {
 public:
  Residuals(const PointView& points, std::span<const double> middle, std::span<const double> scale)
      : dimension_(points.dimension), count_(points.rows), columns_(dimension_ * count_), length_sq_(count_) {
    if (points.type == ScalarType::kFloat64) {
      fill(static_cast<const double*>(points.data), points, middle, scale);
    } else {
      fill(static_cast<const float*>(points.data), points, middle, scale);
    }
  }

  std::vector<double> mean() const {
    std::vector<double> result(dimension_, 0.0);
    constexpr std::size_t kSums = 16;  // side by side: one sum would wait for itself
    for (std::size_t k = 0; k < dimension_; ++k) {
      double sums[kSums] = {};
      for (std::size_t row = 0; row < count_; ++row) sums[row % kSums] += columns_[k * count_ + row];
      for (const double sum : sums) result[k] += sum / static_cast<double>(count_);
    }
    return result;
  }

  /// Returns the longest row after reduce_rows, of equal ones the first.
  std::size_t reduce(std::span<const double> origin, std::span<const double> direction) {
    for_each_block(count_, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      NDHULL_BEST_OF(reduce_rows)
      (columns_.data(), count_, begin, end, origin, direction, length_sq_.data());
    });
    return NDHULL_BEST_OF(find_largest)(length_sq_);
  }

  double length(std::size_t row) const { return std::sqrt(length_sq_[row]); }
  std::vector<double> row(std::size_t row) const {
    std::vector<double> values(dimension_);
    for (std::size_t k = 0; k < dimension_; ++k) values[k] = columns_[k * count_ + row];
    return values;
  }

 private:
  template <class Scalar>
  void fill(const Scalar* data, const PointView& points, std::span<const double> middle,
            std::span<const double> scale) {
    for_each_block(count_, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = 0; k < dimension_; ++k) {
        const Scalar* from = data + begin * points.row_stride + k * points.column_stride;
        double* to = columns_.data() + k * count_ + begin;
        for (std::size_t row = begin; row < end; ++row, from += points.row_stride)
          *to++ = (static_cast<double>(*from) - middle[k]) * scale[k];
      }
    });
  }

  static constexpr std::size_t kRowsInBlock = 4096;  // of 16 columns half a megabyte
  std::size_t dimension_, count_;
  HugeArray<double> columns_;
  std::vector<double> length_sq_;
};

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

}  // namespace

GreedySimplex choose_simplex(const PointView& points, std::span<const double> middle,
                             std::span<const double> scale, double tolerance) {
  const std::size_t dimension = points.dimension;
  const std::vector<double> zero(dimension, 0.0);
  GreedySimplex simplex;
  Residuals residuals(points, middle, scale);
  const std::size_t first = residuals.reduce(residuals.mean(), zero);
  simplex.points.push_back(PointId{static_cast<std::uint32_t>(first)});
  std::vector<double> origin = residuals.row(first), direction = zero;
  for (std::size_t step = 0; step < dimension; ++step) {
    const std::size_t furthest = residuals.reduce(origin, direction);
    origin = zero;
    const double length = residuals.length(furthest);
    if (length <= tolerance) break;
    direction = residuals.row(furthest);
    for (double& x : direction) x /= length;
    // Twice is enough (Kahan; Parlett. The Symmetric Eigenvalue Problem, 1980, sec. 6-9).
    for (std::size_t before = 0; before < step; ++before) {
      const std::span<const double> other(simplex.directions.data() + before * dimension, dimension);
      const double along = dot(direction, other);
      for (std::size_t k = 0; k < dimension; ++k) direction[k] -= along * other[k];
    }
    const double rest = std::sqrt(dot(direction, direction));
    for (double& x : direction) x /= rest;
    simplex.directions.insert(simplex.directions.end(), direction.begin(), direction.end());
    simplex.points.push_back(PointId{static_cast<std::uint32_t>(furthest)});
  }
  return simplex;
}

}  // namespace ndhull
#endif
