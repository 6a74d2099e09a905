// Blocked: each block of queries stays in registers and cache while blocks of planes stream by; the block of
// the largest product is remembered and searched at the end, or all where rounding hides which it is.
#include "approx/planes/contains.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "approx/polytope/halfspace_set.h"
#include "core/error.h"
#include "core/frame.h"
#include "core/machine/arena.h"
#include "core/machine/blocks.h"
#include "core/plane_value.h"
#include "core/search/plane_kernels.h"

namespace ndhull {
namespace {

constexpr std::size_t kQueryBlock = 1024;
constexpr std::size_t kPlaneBlock = 256;

class Comparer {
 public:
  Comparer(const PointView& queries, std::span<const double> planes)
      : queries_(queries),
        columns_(queries.dimension + 1),
        halfspaces_(PointView::row_major(planes.data(), planes.size() / columns_, columns_)),
        unit_rows_(planes.begin(), planes.end()) {
    for (std::size_t plane = 0; plane < halfspaces_.count(); ++plane) {
      double* const row = unit_rows_.data() + plane * columns_;
      for (std::size_t k = 0; k < columns_; ++k) row[k] /= halfspaces_.length(plane);
      largest_offset_ = std::max(largest_offset_, std::abs(row[columns_ - 1]));
    }
  }

  /// Queries begin .. begin + out.size().
  void compare(std::size_t begin, std::span<PlaneDistance> out) const {
    std::vector<double> rows(out.size() * columns_, 1.0), best(out.size(), -HUGE_VAL), products(out.size());
    std::vector<double> of_others(best);  // of blocks that are not the best one
    std::vector<std::size_t> block_of(out.size(), 0);
    for (std::size_t query = 0; query < out.size(); ++query)
      queries_.copy_row(begin + query, rows.data() + query * columns_);
    for (std::size_t first = 0; first < halfspaces_.count(); first += kPlaneBlock) {
      const std::size_t used = std::min(kPlaneBlock, halfspaces_.count() - first);
      max_dots(columns_, rows, {unit_rows_.data() + first * columns_, used * columns_}, products);
      for (std::size_t query = 0; query < out.size(); ++query) {
        of_others[query] = std::max(of_others[query], std::min(products[query], best[query]));
        if (!(products[query] > best[query])) continue;
        best[query] = products[query];
        block_of[query] = first;
      }
    }
    std::vector<std::size_t> doubtful;
    for (std::size_t query = 0; query < out.size(); ++query) {
      const double* const row = rows.data() + query * columns_;
      const double least = best[query] - 2.0 * roundoff_of(row);
      const std::size_t end = std::min(block_of[query] + kPlaneBlock, halfspaces_.count());
      if (of_others[query] < least) {
        out[query] = furthest(row, block_of[query], end, least);
      } else {
        out[query] = {-HUGE_VAL, 0};
        best[query] = least;
        doubtful.push_back(query);
      }
    }
    compare_in_all_blocks(rows, best, doubtful, out);
  }

 private:
  /// Of these queries, which several blocks have planes for whose products are at least `least`.
  void compare_in_all_blocks(std::span<const double> rows, std::span<const double> least,
                             std::span<const std::size_t> queries, std::span<PlaneDistance> out) const {
    if (queries.empty()) return;
    std::vector<double> some, products(queries.size());
    for (const std::size_t query : queries) {
      const std::span<const double> row = rows.subspan(query * columns_, columns_);
      some.insert(some.end(), row.begin(), row.end());
    }
    for (std::size_t first = 0; first < halfspaces_.count(); first += kPlaneBlock) {
      const std::size_t used = std::min(kPlaneBlock, halfspaces_.count() - first);
      max_dots(columns_, some, {unit_rows_.data() + first * columns_, used * columns_}, products);
      for (std::size_t k = 0; k < queries.size(); ++k) {
        if (products[k] < least[queries[k]]) continue;
        const PlaneDistance found =
            furthest(some.data() + k * columns_, first, first + used, least[queries[k]]);
        if (found.distance > out[queries[k]].distance) out[queries[k]] = found;
      }
    }
  }

  /// Bound of the error of a product of unit row and query: gamma_{d+2} times the sizes of its terms, twice,
  /// which covers the rounding of the unit rows too.
  double roundoff_of(const double* row) const {
    double size = largest_offset_;
    for (std::size_t k = 0; k + 1 < columns_; ++k) size += std::abs(row[k]);
    return static_cast<double>(columns_ + 3) * 0x1p-52 * size;
  }

  /// The largest distance among planes whose product is at least `least`, by values whose sign is exact.
  PlaneDistance furthest(const double* query, std::size_t begin, std::size_t end, double least) const {
    PlaneDistance found{-HUGE_VAL, static_cast<std::uint32_t>(begin)};
    const std::span<const double> x{query, columns_ - 1};
    for (std::size_t plane = begin; plane < end; ++plane) {
      const double* const row = unit_rows_.data() + plane * columns_;
      double product = 0.0;
      for (std::size_t k = 0; k < columns_; ++k) product += row[k] * query[k];
      if (product < least) continue;
      const double distance = distance_of(x, plane);
      if (distance > found.distance) found = {distance, static_cast<std::uint32_t>(plane)};
    }
    return found;
  }

  double distance_of(std::span<const double> x, std::size_t plane) const {
    const std::span<const double> normal = halfspaces_.normal(plane);
    const double offset = halfspaces_.offset(plane), length = halfspaces_.length(plane);
    const CentredPlane exact{.normal = normal, .reference = {}, .offset = offset};
    const double value = plane_value(exact, x, DoubtfulSign::kExtendedThenExact);
    const double size = std::abs(value);
    constexpr double kSmallest = 0x1p-900, kLargest = 0x1p+1000;
    if (size == 0.0 || (size >= kSmallest && size <= kLargest)) return value / length;
    // The value may be no double where the distance is one: with a normal of length 1/4 to 1/2 it is a part
    // of the distance. What the scaling rounds is far below the value; its sign is known.
    const int exponent = -2 - std::ilogb(length);
    std::vector<double> scaled(normal.begin(), normal.end());
    for (double& component : scaled) component = std::ldexp(component, exponent);
    const CentredPlane short_plane{.normal = scaled, .reference = {}, .offset = std::ldexp(offset, exponent)};
    if (!std::isfinite(short_plane.offset)) return value / length;
    const double part = plane_value(short_plane, x, DoubtfulSign::kExtendedThenExact);
    const double distance = std::abs(part) / std::ldexp(length, exponent);
    return std::copysign(std::max(distance, std::numeric_limits<double>::denorm_min()), value);
  }

  const PointView& queries_;
  std::size_t columns_;
  HalfspaceSet halfspaces_;
  std::vector<double> unit_rows_;
  double largest_offset_ = 0.0;
};

}  // namespace

std::vector<PlaneDistance> distances_to_planes(const PointView& queries, std::span<const double> planes,
                                               unsigned threads) {
  if (planes.empty()) throw Error(ErrorCode::kEmptyInput, "found no planes, expected one or more");
  if (planes.size() % (queries.dimension + 1) != 0) {
    throw Error(ErrorCode::kUsage, "found " + std::to_string(planes.size()) +
                                       " numbers of planes, expected rows of " +
                                       std::to_string(queries.dimension + 1));
  }
  check_finite(queries);
  const Comparer comparer(queries, planes);
  std::vector<PlaneDistance> distances(queries.rows);
  tbb::task_arena arena = arena_of(threads);
  arena.execute([&] {
    for_each_block(queries.rows, kQueryBlock, [&](std::size_t begin, std::size_t end) {
      comparer.compare(begin, {distances.data() + begin, end - begin});
    });
  });
  return distances;
}

}  // namespace ndhull
