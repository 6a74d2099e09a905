#include "core/search/plane_kernels.h"

#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/search/plane_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "core/dimension_switch.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"
#include "core/search/highest_dots.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<double>;
using Lane = hn::Vec<Tag>;

// Simplices that one thread takes at a time: a multiple of all vectors' lanes.
constexpr std::size_t kSimplicesInBlock = 2048;

// Two vectors of facets stay in registers while all points stream by: each broadcast is used twice. D = 0:
// the dimension is known at run time only and the facets' coordinates come from memory.
template <std::size_t D>
void max_dots_of(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
                 std::span<double> max_dot) {
  const Tag tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t width = D > 0 ? D : dimension;
  const std::size_t facet_count = max_dot.size();
  const std::size_t point_count = points.size() / width;
  const std::size_t block = 2 * lanes;
  std::vector<double> transposed(block * width);
  for (std::size_t begin = 0; begin < facet_count; begin += block) {
    const std::size_t used = std::min(block, facet_count - begin);
    for (std::size_t f = 0; f < block; ++f) {
      const double* normal = normals.data() + (begin + std::min(f, used - 1)) * width;
      for (std::size_t k = 0; k < width; ++k) transposed[k * block + f] = normal[k];
    }
    Lane best_low = hn::Set(tag, -HUGE_VAL), best_high = best_low;
    const double* point = points.data();
    if constexpr (D > 0) {
      Lane low[D], high[D];
      for (std::size_t k = 0; k < D; ++k) {
        low[k] = hn::LoadU(tag, transposed.data() + k * block);
        high[k] = hn::LoadU(tag, transposed.data() + k * block + lanes);
      }
      for (std::size_t p = 0; p < point_count; ++p, point += D) {
        Lane x = hn::Set(tag, point[0]);
        Lane dot_low = hn::Mul(low[0], x), dot_high = hn::Mul(high[0], x);
        for (std::size_t k = 1; k < D; ++k) {
          x = hn::Set(tag, point[k]);
          dot_low = hn::MulAdd(low[k], x, dot_low);
          dot_high = hn::MulAdd(high[k], x, dot_high);
        }
        best_low = hn::Max(best_low, dot_low);
        best_high = hn::Max(best_high, dot_high);
      }
    } else {
      for (std::size_t p = 0; p < point_count; ++p, point += width) {
        Lane dot_low = hn::Zero(tag), dot_high = dot_low;
        for (std::size_t k = 0; k < width; ++k) {
          const Lane x = hn::Set(tag, point[k]);
          dot_low = hn::MulAdd(hn::LoadU(tag, transposed.data() + k * block), x, dot_low);
          dot_high = hn::MulAdd(hn::LoadU(tag, transposed.data() + k * block + lanes), x, dot_high);
        }
        best_low = hn::Max(best_low, dot_low);
        best_high = hn::Max(best_high, dot_high);
      }
    }
    hn::StoreU(best_low, tag, transposed.data());
    hn::StoreU(best_high, tag, transposed.data() + lanes);
    std::copy_n(transposed.data(), used, max_dot.data() + begin);
  }
}

template <std::size_t D>
void own_dots_of(const SimplicialComplex& complex, std::size_t first, std::size_t dimension,
                 std::span<const double> normals, std::span<const double> points,
                 std::span<const std::uint32_t> row_of_point, std::span<double> low, std::span<double> high) {
  const std::size_t width = D > 0 ? D : dimension;
  for (std::size_t row = 0; row < low.size(); ++row) {
    const double* normal = normals.data() + row * width;
    double smallest = HUGE_VAL, largest = -HUGE_VAL;
    for (const PointId id : complex.vertices(SimplexId{static_cast<std::uint32_t>(first + row)})) {
      const double* point = points.data() + std::size_t{row_of_point[id.value]} * width;
      double dot = 0.0;
      for (std::size_t k = 0; k < width; ++k) dot = __builtin_fma(normal[k], point[k], dot);
      smallest = std::min(smallest, dot);
      largest = std::max(largest, dot);
    }
    low[row] = smallest;
    high[row] = largest;
  }
}

// Four products at a time: each is a chain that waits for its last addition.
template <std::size_t D>
void listed_dots_of(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
                    const IdRows& lists, std::span<double> low, std::span<double> high,
                    std::span<std::uint32_t> close) {
  constexpr std::size_t kTogether = 4;
  const std::size_t width = D > 0 ? D : dimension;
  std::vector<double> dots;
  for (std::size_t row = 0; row < low.size(); ++row) {
    const double* normal = normals.data() + row * width;
    const std::span<const std::uint32_t> list = lists.row(row);
    dots.resize(std::max(dots.size(), list.size() + kTogether));
    double smallest[kTogether], largest[kTogether];
    std::fill_n(smallest, kTogether, HUGE_VAL);
    std::fill_n(largest, kTogether, -HUGE_VAL);
    for (std::size_t i = 0; i < list.size(); i += kTogether) {
      const double* point[kTogether];
      double dot[kTogether] = {};
      for (std::size_t j = 0; j < kTogether; ++j)
        point[j] = points.data() + std::size_t{list[std::min(i + j, list.size() - 1)]} * width;
      for (std::size_t k = 0; k < width; ++k)
        for (std::size_t j = 0; j < kTogether; ++j) dot[j] = __builtin_fma(normal[k], point[j][k], dot[j]);
      for (std::size_t j = 0; j < kTogether; ++j) {
        dots[i + j] = dot[j];
        smallest[j] = std::min(smallest[j], dot[j]);
        largest[j] = std::max(largest[j], dot[j]);
      }
    }
    low[row] = *std::min_element(smallest, smallest + kTogether);
    high[row] = *std::max_element(largest, largest + kTogether);
    const double least = high[row] - kCloseProducts * std::abs(high[row]);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < list.size(); ++i) count += dots[i] >= least ? 1u : 0u;
    close[row] = count;
  }
}

// Neighbours are fetched some simplices ahead: they lie anywhere in memory.
template <std::size_t D>
void mark_flat_of(const SimplicialComplex& complex, const double* points, double tolerance,
                  std::span<const std::uint8_t> looks_at, std::span<std::uint8_t> is_flat) {
  constexpr std::size_t kAhead = 4;
  const auto gauge_above = [&](SimplexId simplex, PointId id) {
    const double* plane = complex.plane(simplex).data();
    const double* point = points + std::size_t{id.value} * D;
    double gauge = -1.0;
    for (std::size_t k = 0; k < D; ++k) gauge = __builtin_fma(plane[k], point[k], gauge);
    return gauge;
  };
  // Each block has a list of the other sides: two threads must not write the same mark.
  const std::size_t count = complex.row_count;
  std::vector<std::vector<std::uint32_t>> others((count + kSimplicesInBlock - 1) / kSimplicesInBlock);
  for_each_block(count, kSimplicesInBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      if (row + kAhead < end && looks_at[row + kAhead]) {
        const SimplexId ahead{static_cast<std::uint32_t>(row + kAhead)};
        for (const SimplexId later : complex.neighbours(ahead)) {
          prefetch(complex.neighbours(later).data());
          prefetch(complex.vertices(later).data());
        }
      }
      if (!looks_at[row]) continue;
      const SimplexId simplex{static_cast<std::uint32_t>(row)};
      for (std::size_t k = 0; k < D; ++k) {
        const SimplexId neighbour = complex.neighbours(simplex)[k];
        const auto back = complex.neighbours(neighbour);
        std::size_t slot = 0;
        while (back[slot] != simplex) ++slot;
        double highest = gauge_above(simplex, complex.vertices(neighbour)[slot]);
        // The other side looks at itself when it is one to look at.
        if (!looks_at[neighbour.value])
          highest = std::max(highest, gauge_above(neighbour, complex.vertices(simplex)[k]));
        if (highest <= -tolerance) continue;
        is_flat[row] = 1;
        others[begin / kSimplicesInBlock].push_back(neighbour.value);
      }
    }
  });
  for (const std::vector<std::uint32_t>& block : others)
    for (const std::uint32_t row : block) is_flat[row] = 1;
}

void max_dots_any(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
                  std::span<double> max_dot) {
  if (dimension > kMaxRank) return max_dots_of<0>(dimension, normals, points, max_dot);
  call_with_dimension<1, kMaxRank>(dimension,
                                   [&](auto d) { max_dots_of<d>(dimension, normals, points, max_dot); });
}

void own_dots_any(const SimplicialComplex& complex, std::size_t first, std::size_t dimension,
                  std::span<const double> normals, std::span<const double> points,
                  std::span<const std::uint32_t> row_of_point, std::span<double> low,
                  std::span<double> high) {
  if (dimension > kMaxRank)
    return own_dots_of<0>(complex, first, dimension, normals, points, row_of_point, low, high);
  call_with_dimension<1, kMaxRank>(dimension, [&](auto d) {
    own_dots_of<d>(complex, first, dimension, normals, points, row_of_point, low, high);
  });
}

void listed_dots_any(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
                     const IdRows& lists, std::span<double> low, std::span<double> high,
                     std::span<std::uint32_t> close) {
  if (dimension > kMaxRank) return listed_dots_of<0>(dimension, normals, points, lists, low, high, close);
  call_with_dimension<1, kMaxRank>(
      dimension, [&](auto d) { listed_dots_of<d>(dimension, normals, points, lists, low, high, close); });
}

void mark_flat_any(const SimplicialComplex& complex, const double* points, double tolerance,
                   std::span<const std::uint8_t> looks_at, std::span<std::uint8_t> is_flat) {
  call_with_dimension<2, kMaxRank>(
      complex.rank, [&](auto d) { mark_flat_of<d>(complex, points, tolerance, looks_at, is_flat); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void max_dots(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
              std::span<double> max_dot) {
  NDHULL_BEST_OF(max_dots_any)(dimension, normals, points, max_dot);
}

void own_dots(const SimplicialComplex& complex, std::size_t first, std::size_t dimension,
              std::span<const double> normals, std::span<const double> points,
              std::span<const std::uint32_t> row_of_point, std::span<double> low, std::span<double> high) {
  NDHULL_BEST_OF(own_dots_any)(complex, first, dimension, normals, points, row_of_point, low, high);
}

void listed_dots(std::size_t dimension, std::span<const double> normals, std::span<const double> points,
                 const IdRows& lists, std::span<double> low, std::span<double> high,
                 std::span<std::uint32_t> close) {
  NDHULL_BEST_OF(listed_dots_any)(dimension, normals, points, lists, low, high, close);
}

void mark_flat(const SimplicialComplex& complex, const double* points, double tolerance,
               std::span<const std::uint8_t> looks_at, std::span<std::uint8_t> is_flat) {
  NDHULL_BEST_OF(mark_flat_any)(complex, points, tolerance, looks_at, is_flat);
}

}  // namespace ndhull
#endif
