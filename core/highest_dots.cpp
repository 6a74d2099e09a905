#include "core/highest_dots.h"

#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/highest_dots.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/dimension_switch.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, PointGroups::kSize>;
using DoubleTag = hn::CappedTag<double, PointGroups::kSize>;

/// One direction, scaled so that the products with scaled points are in [-1, 1].
struct ScaledDirection {
  std::vector<float> normal;
  float doubtful = 0.0f;  // from here on a product in single precision may be as large as what is attained
  bool own_are_close = false;  // all own vertices are so high that their products are among these
};

// Roundings of the products in single precision, each at most 2^-24 of 1: of both factors, of the sums, and
// one for those of double precision.
inline float product_error(std::size_t dimension) { return static_cast<float>(dimension + 4) * 0x1p-24f; }

template <std::size_t D>
HWY_INLINE void scale_direction(const PointGroups& points, const double* normal, double low, double high,
                                ScaledDirection& scaled) {
  const std::size_t width = D > 0 ? D : points.dimension();
  const double* column_sizes = points.column_sizes().data();
  double size = 0.0;
  for (std::size_t k = 0; k < width; ++k) size += std::abs(normal[k]) * column_sizes[k];
  const double factor = 1.0 / size;
  for (std::size_t k = 0; k < width; ++k) {
    scaled.normal[k] = static_cast<float>(normal[k] * column_sizes[k] * factor);
  }
  scaled.doubtful = static_cast<float>(high * factor) - 3.0f * product_error(width);
  scaled.own_are_close = (high - low) * factor <= double{product_error(width)};
}

/// Marks the groups whose balls reach up to what is attained, one bit each. The sums are below 4, so their
/// errors are below four times those of a product. A NaN is not below 0: it leaves nothing out.
template <std::size_t D>
void mark_near_groups(const PointGroups& points, const ScaledDirection& direction, std::uint64_t* near) {
  const FloatTag tag;
  const std::size_t width = D > 0 ? D : points.dimension();
  const auto base = hn::Set(tag, 4.0f * product_error(width + 2) - direction.doubtful);
  float length_sq = 0.0f;
  for (std::size_t k = 0; k < width; ++k) length_sq += direction.normal[k] * direction.normal[k];
  const auto length = hn::Set(tag, std::sqrt(length_sq) * (1.0f + 0x1p-18f));  // and what the sum has lost
  constexpr std::size_t kWordBits = 64;
  for (std::size_t word = 0; word < points.padded_count(); word += kWordBits) {
    std::uint64_t bits = 0;
    for (std::size_t at = 0; at < kWordBits; at += hn::Lanes(tag)) {
      const std::size_t begin = word + at;
      auto reach = hn::MulAdd(length, hn::LoadU(tag, points.radii() + begin), base);
      for (std::size_t k = 0; k < width; ++k) {
        const auto normal = hn::Set(tag, direction.normal[k]);
        reach = hn::MulAdd(normal, hn::LoadU(tag, points.centres(k) + begin), reach);
      }
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(tag, hn::Not(hn::Lt(reach, hn::Zero(tag))), bytes);
      std::uint64_t here = 0;
      std::memcpy(&here, bytes, sizeof here);
      bits |= here << at;
    }
    near[word / kWordBits] = bits;
  }
}

/// Calls `call` with each group marked. One loop for 64 groups: its end is what the processor cannot predict.
template <class Call>
HWY_INLINE void for_each_group(std::span<const std::uint64_t> near, const Call& call) {
  std::size_t base = 0;
  for (std::uint64_t bits : near) {
    for (; bits != 0; bits &= bits - 1) call(base + static_cast<std::size_t>(__builtin_ctzll(bits)));
    base += 64;
  }
}

/// How many points of the groups may be as high as what is attained.
template <std::size_t D>
std::size_t count_doubtful(const PointGroups& points, const ScaledDirection& direction,
                           std::span<const std::uint64_t> near) {
  const FloatTag tag;
  const std::size_t width = D > 0 ? D : points.dimension();
  const auto doubtful = hn::Set(tag, direction.doubtful), one = hn::Set(tag, 1.0f);
  auto count = hn::Zero(tag);
  for_each_group(near, [&](std::size_t group) {
    for (std::size_t at = 0; at < PointGroups::kSize; at += hn::Lanes(tag)) {
      auto dot =
          hn::Mul(hn::Set(tag, direction.normal[0]), hn::LoadU(tag, points.scaled_rows(group, 0) + at));
      for (std::size_t k = 1; k < width; ++k) {
        const auto normal = hn::Set(tag, direction.normal[k]);
        dot = hn::MulAdd(normal, hn::LoadU(tag, points.scaled_rows(group, k) + at), dot);
      }
      count = hn::Add(count, hn::IfThenZeroElse(hn::Lt(dot, doubtful), one));
    }
  });
  // Below 2^24 in each lane, or not exact but far from any facet's number of vertices.
  return static_cast<std::size_t>(hn::GetLane(hn::SumOfLanes(tag, count)));
}

template <std::size_t D>
double largest_in_groups(const PointGroups& points, const double* normal, std::span<const std::uint64_t> near,
                         double largest) {
  const DoubleTag tag;
  const std::size_t width = D > 0 ? D : points.dimension();
  auto best = hn::Set(tag, largest);
  for_each_group(near, [&](std::size_t group) {
    for (std::size_t at = 0; at < PointGroups::kSize; at += hn::Lanes(tag)) {
      auto dot = hn::Mul(hn::Set(tag, normal[0]), hn::LoadU(tag, points.rows(group, 0) + at));
      for (std::size_t k = 1; k < width; ++k) {
        dot = hn::MulAdd(hn::Set(tag, normal[k]), hn::LoadU(tag, points.rows(group, k) + at), dot);
      }
      best = hn::Max(best, dot);
    }
  });
  return hn::GetLane(hn::MaxOfLanes(tag, best));
}

/// One facet at a time: the groups near it.
template <std::size_t D>
void highest_dots_near(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                       std::span<double> largest) {
  const std::size_t width = D > 0 ? D : points.dimension();
  ScaledDirection direction;
  direction.normal.resize(width);
  std::vector<std::uint64_t> near(points.padded_count() / 64);
  for (std::size_t facet = 0; facet < largest.size(); ++facet) {
    const double* normal = normals.data() + facet * width;
    scale_direction<D>(points, normal, own.low[facet], own.high[facet], direction);
    mark_near_groups<D>(points, direction, near.data());
    largest[facet] = own.high[facet];
    if (direction.own_are_close && count_doubtful<D>(points, direction, near) == own.count) {
      continue;  // the own vertices are, and no other point is
    }
    largest[facet] = largest_in_groups<D>(points, normal, near, own.high[facet]);
  }
}

/// A vector of facets at a time, and all points: where points are few or their balls large.
template <std::size_t D>
void highest_dots_all(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                      std::span<double> largest) {
  const FloatTag tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t width = D > 0 ? D : points.dimension();
  ScaledDirection direction;
  direction.normal.resize(width);
  std::vector<float> transposed(width * lanes);
  float doubtful[PointGroups::kSize], counts[PointGroups::kSize];
  bool own_are_close[PointGroups::kSize];
  std::vector<std::uint64_t> all((points.count() + 63) / 64, ~std::uint64_t{0});
  all.back() >>= 64 * all.size() - points.count();
  for (std::size_t begin = 0; begin < largest.size(); begin += lanes) {
    const std::size_t used = std::min(lanes, largest.size() - begin);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t facet = begin + std::min(lane, used - 1);
      scale_direction<D>(points, normals.data() + facet * width, own.low[facet], own.high[facet], direction);
      for (std::size_t k = 0; k < width; ++k) transposed[k * lanes + lane] = direction.normal[k];
      doubtful[lane] = direction.doubtful;
      own_are_close[lane] = direction.own_are_close;
    }
    const auto threshold = hn::LoadU(tag, doubtful), one = hn::Set(tag, 1.0f);
    auto count = hn::Zero(tag);
    for (std::size_t point = 0; point < points.point_count(); ++point) {
      const float* x = points.scaled_rows(point / PointGroups::kSize, 0) + point % PointGroups::kSize;
      auto dot = hn::Mul(hn::LoadU(tag, transposed.data()), hn::Set(tag, *x));
      for (std::size_t k = 1; k < width; ++k) {
        x += PointGroups::kSize;
        dot = hn::MulAdd(hn::LoadU(tag, transposed.data() + k * lanes), hn::Set(tag, *x), dot);
      }
      count = hn::Add(count, hn::IfThenZeroElse(hn::Lt(dot, threshold), one));
    }
    hn::StoreU(count, tag, counts);
    for (std::size_t lane = 0; lane < used; ++lane) {
      const std::size_t facet = begin + lane;
      largest[facet] = own.high[facet];
      if (own_are_close[lane] && counts[lane] == static_cast<float>(own.count)) continue;
      largest[facet] = largest_in_groups<D>(points, normals.data() + facet * width, all, own.high[facet]);
    }
  }
}

template <std::size_t D>
void highest_dots_of(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                     std::span<double> largest) {
  // On spheres, where a ball of 16 out of so many points is about as large as a facet.
  const bool balls_are_large =
      points.dimension() > 16 || points.point_count() >> (points.dimension() + 2) == 0;
  if (balls_are_large && own.count > 0) {
    highest_dots_all<D>(points, normals, own, largest);
  } else {
    highest_dots_near<D>(points, normals, own, largest);
  }
}

void highest_dots_any(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                      std::span<double> largest) {
  if (points.dimension() > kMaxRank) return highest_dots_of<0>(points, normals, own, largest);
  call_with_dimension<1, kMaxRank>(points.dimension(),
                                   [&](auto d) { highest_dots_of<d>(points, normals, own, largest); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {
HWY_EXPORT(highest_dots_any);

namespace {

/// Splits at multiples of the group size, each time along the column that is longest (in units of its size).
void order_by_neighbourhood(std::span<const double> points, std::span<const double> column_sizes,
                            std::span<std::uint32_t> members) {
  const std::size_t dimension = column_sizes.size();
  if (members.size() <= PointGroups::kSize) return;
  std::size_t longest = 0;
  double longest_extent = -1.0;
  for (std::size_t k = 0; k < dimension; ++k) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const std::uint32_t row : members) {
      low = std::min(low, points[row * dimension + k]);
      high = std::max(high, points[row * dimension + k]);
    }
    if ((high - low) / column_sizes[k] > longest_extent) {
      longest_extent = (high - low) / column_sizes[k];
      longest = k;
    }
  }
  const std::size_t groups = (members.size() + PointGroups::kSize - 1) / PointGroups::kSize;
  const std::size_t half = groups / 2 * PointGroups::kSize;
  std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(half), members.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double x = points[a * dimension + longest], y = points[b * dimension + longest];
                     return x != y ? x < y : a < b;
                   });
  order_by_neighbourhood(points, column_sizes, members.first(half));
  order_by_neighbourhood(points, column_sizes, members.subspan(half));
}

}  // namespace

PointGroups::PointGroups(std::size_t dimension, std::span<const double> points, bool in_order)
    : dimension_(dimension), point_count_(points.size() / dimension), column_sizes_(dimension, 1.0) {
  const std::size_t point_count = point_count_;
  count_ = (point_count + kSize - 1) / kSize;
  padded_count_ = (count_ + 63) / 64 * 64;
  for (std::size_t k = 0; k < dimension; ++k) {
    double largest = 0.0;
    for (std::size_t row = 0; row < point_count; ++row) {
      largest = std::max(largest, std::abs(points[row * dimension + k]));
    }
    if (largest > 0.0) column_sizes_[k] = std::ldexp(1.0, std::min(std::ilogb(largest) + 1, 1023));
  }
  std::vector<std::uint32_t> order(point_count);
  std::iota(order.begin(), order.end(), 0);
  if (!in_order) order_by_neighbourhood(points, column_sizes_, order);
  rows_.resize(count_ * dimension * kSize);
  scaled_rows_.resize(rows_.size());
  centres_.resize(padded_count_ * dimension);
  radii_.assign(padded_count_, -0x1p100f);
  for (std::size_t group = 0; group < count_; ++group) {
    const std::size_t size = std::min(kSize, point_count - group * kSize);
    fill_group(group, points, {order.data() + group * kSize, size});
  }
}

void PointGroups::fill_group(std::size_t group, std::span<const double> points,
                             std::span<const std::uint32_t> members) {
  double distance_sq[kSize] = {};
  for (std::size_t k = 0; k < dimension_; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kSize; ++i) {  // the last point fills the last group
      const double x = points[members[std::min(i, members.size() - 1)] * dimension_ + k];
      const std::size_t at = (group * dimension_ + k) * kSize + i;
      rows_[at] = x;
      scaled_rows_[at] = static_cast<float>(x / column_sizes_[k]);
      sum += x / column_sizes_[k];
    }
    const auto centre = static_cast<float>(sum / static_cast<double>(kSize));
    centres_[k * padded_count_ + group] = centre;
    for (std::size_t i = 0; i < kSize; ++i) {
      const double away = rows_[(group * dimension_ + k) * kSize + i] / column_sizes_[k] - double{centre};
      distance_sq[i] += away * away;
    }
  }
  const double radius = std::sqrt(*std::max_element(distance_sq, distance_sq + kSize));
  radii_[group] = static_cast<float>(radius) * (1.0f + 0x1p-20f) + 0x1p-40f;
}

void highest_dots(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                  std::span<double> largest) {
  HWY_DYNAMIC_DISPATCH(highest_dots_any)(points, normals, own, largest);
}

}  // namespace ndhull
#endif
