// Mapping points into the frame, and planes out of it. With a full map the sums are compensated, which needs
// fused multiply-add to be fast: compiled for each instruction set, chosen at run time.
#include <algorithm>
#include <vector>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/frame_map.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include "core/frame.h"
#include "core/machine/blocks.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

/// Sum of map[k] * (offset[k] + error[k]) as if computed in twice the working precision and rounded once.
HWY_INLINE double compensated_dot(const double* map, const double* offset, const double* error,
                                  std::size_t count) {
  double sum = 0.0, lost = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    lost += map[k] * error[k];
    const double product = map[k] * offset[k];
    const double product_error = __builtin_fma(map[k], offset[k], -product);
    const double next = sum + product;  // Knuth's two-sum
    const double part = next - sum;
    lost += ((sum - (next - part)) + (product - part)) + product_error;
    sum = next;
  }
  return sum + lost;
}

void map_full(const PointView& points, const Frame& frame, double* out) {
  constexpr std::size_t kPointsInBlock = 4096;
  for_each_block(points.rows, kPointsInBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<double> offset(points.dimension), error(points.dimension);
    for (std::size_t row = begin; row < end; ++row) {
      for (std::size_t k = 0; k < points.dimension; ++k) {
        // Of thin data entries of the map are so large that the rounding of a difference would count.
        const double x = points.at(row, k), difference = x - frame.centre[k];
        const double part = difference - x;
        offset[k] = difference;
        error[k] = (x - (difference - part)) - (frame.centre[k] + part);
      }
      for (std::size_t r = 0; r < frame.rank; ++r) {
        out[row * frame.rank + r] = compensated_dot(frame.map.data() + r * points.dimension, offset.data(),
                                                    error.data(), points.dimension);
      }
    }
  });
}

void combine_rows(const double* weights, std::size_t count, std::size_t rank, const double* columns,
                  std::size_t width, double* out) {
  const std::vector<double> no_error(rank, 0.0);
  std::vector<double> row(width);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < width; ++k)
      row[k] = compensated_dot(columns + k * rank, weights + i * rank, no_error.data(), rank);
    std::copy(row.begin(), row.end(), out + i * width);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

namespace {

template <class Scalar>
void map_diagonal(const Scalar* data, const PointView& points, const Frame& frame, double* out) {
  struct Column {
    std::size_t offset;
    double centre, scale;
  };
  std::vector<Column> columns;
  for (std::size_t r = 0; r < frame.rank; ++r) {
    std::size_t k = 0;
    while (frame.map[r * frame.dimension + k] == 0.0) ++k;
    columns.push_back({k * points.column_stride, frame.centre[k], frame.map[r * frame.dimension + k]});
  }
  constexpr std::size_t kPointsInBlock = 4096;
  for_each_block(points.rows, kPointsInBlock, [&](std::size_t begin, std::size_t end) {
    double* to = out + begin * frame.rank;
    for (std::size_t row = begin; row < end; ++row) {
      const Scalar* from = data + row * points.row_stride;
      for (const Column& column : columns)
        *to++ = (static_cast<double>(from[column.offset]) - column.centre) * column.scale;
    }
  });
}

}  // namespace

void map_points(const PointView& points, const Frame& frame, double* out) {
  if (!frame.is_diagonal) {
    NDHULL_BEST_OF(map_full)(points, frame, out);
    return;
  }
  if (points.type == ScalarType::kFloat64) {
    map_diagonal(static_cast<const double*>(points.data), points, frame, out);
  } else {
    map_diagonal(static_cast<const float*>(points.data), points, frame, out);
  }
}

void map_normals(const double* planes, std::size_t count, std::span<const double> columns, std::size_t rank,
                 double* out) {
  NDHULL_BEST_OF(combine_rows)(planes, count, rank, columns.data(), columns.size() / rank, out);
}

}  // namespace ndhull
#endif
