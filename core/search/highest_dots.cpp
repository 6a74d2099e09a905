#include "core/search/highest_dots.h"

#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/search/highest_dots.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <numeric>

#include "core/dimension_switch.h"
#include "core/machine/chosen_lanes-inl.h"
#include "core/machine/mask_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, PointGroups::kSize>;
using BitsTag = hn::RebindToUnsigned<FloatTag>;
using DoubleTag = hn::CappedTag<double, PointGroups::kSize>;

/// Directions, scaled so that the products with scaled points are in [-1, 1]. Some at a time, each step for
/// all of them: the steps of one alone wait for each other.
template <std::size_t D, std::size_t kCount>
struct ScaledDirections {
  explicit ScaledDirections(std::size_t width) : normals(kCount * width) {}

  std::vector<float> normals;  // kCount x dimension
  float doubtful[kCount];   // from here on a product in single precision may be as large as what is attained
  std::size_t own[kCount];  // so many own vertices have products among these; 0: not known
};

// Roundings of the products in single precision, each at most 2^-24 of 1: of both factors, of the sums, and
// one for those of double precision.
inline float product_error(std::size_t dimension) { return static_cast<float>(dimension + 4) * 0x1p-24f; }

template <std::size_t D, std::size_t kCount>
HWY_INLINE void scale_direction(const PointGroups& points, const double* normal, const OwnDots& own,
                                std::size_t facet, ScaledDirections<D, kCount>& scaled, std::size_t at) {
  const std::size_t width = D > 0 ? D : points.dimension();
  const double* column_sizes = points.column_sizes().data();
  constexpr double kSmaller = 0x1p-8;  // the sum is finite so
  double size = 0.0;
  for (std::size_t k = 0; k < width; ++k) size += std::abs(normal[k]) * (column_sizes[k] * kSmaller);
  const double factor = points.product_size() * kSmaller / size;
  for (std::size_t k = 0; k < width; ++k) {
    scaled.normals[at * width + k] = static_cast<float>(normal[k] * column_sizes[k] * factor);
  }
  const double high = own.high[facet];
  scaled.doubtful[at] = static_cast<float>(high * factor) - 3.0f * product_error(width);
  if (!own.close.empty()) {  // |high| factor is at most 1
    scaled.own[at] = own.close[facet];
  } else {
    scaled.own[at] = (high - own.low[facet]) * factor <= double{product_error(width)} ? own.count : 0;
  }
}

alignas(64) constexpr std::uint32_t kFirstIds[PointGroups::kSize] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                                     8, 9, 10, 11, 12, 13, 14, 15};

/// Lists the groups whose balls reach up to what is attained. The sums are below 4, so their errors are below
/// four times those of a product. A NaN is not below 0: it leaves no group out, and places behind the last
/// group are none. Writes up to a vector more.
template <std::size_t D>
std::size_t list_near_groups(const PointGroups& points, const float* normal, float doubtful,
                             std::uint32_t* near) {
  const FloatTag tag;
  const BitsTag id_tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t width = D > 0 ? D : points.dimension();
  const auto base = hn::Set(tag, 4.0f * product_error(width + 2) - doubtful);
  float length_sq = 0.0f;
  for (std::size_t k = 0; k < width; ++k) length_sq += normal[k] * normal[k];
  const auto length = hn::Set(tag, std::sqrt(length_sq) * (1.0f + 0x1p-18f));  // and what the sum has lost
  const auto next = hn::Set(id_tag, static_cast<std::uint32_t>(lanes));
  auto ids = hn::Load(id_tag, kFirstIds);
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < points.count(); begin += lanes) {
    auto reach = hn::MulAdd(length, hn::LoadU(tag, points.radii() + begin), base);
    for (std::size_t k = 0; k < width; ++k)
      reach = hn::MulAdd(hn::Set(tag, normal[k]), hn::LoadU(tag, points.centres(k) + begin), reach);
    const auto is_near = static_cast<std::uint32_t>(bits_of_mask(tag, hn::Not(hn::Lt(reach, hn::Zero(tag)))));
    hn::StoreU(ChosenLanes(id_tag, is_near).to_front(ids), id_tag, near + count);
    count += static_cast<std::size_t>(__builtin_popcount(is_near));
    ids = hn::Add(ids, next);
  }
  while (count > 0 && near[count - 1] >= points.count()) --count;
  return count;
}

/// 1 where a product less `doubtful` is below 0. Such a sum begins with -doubtful: partial sums are below 2,
/// and with the roundings of the factors its error is less than 2 product_error, which is what products as
/// large as those of the own vertices are above `doubtful`.
HWY_INLINE hn::Vec<BitsTag> is_below(hn::Vec<FloatTag> difference) {
  return hn::ShiftRight<31>(hn::BitCast(BitsTag(), difference));
}

/// How many points of the groups may be as high as what is attained.
template <std::size_t D>
std::size_t count_doubtful(const PointGroups& points, const float* normal, float doubtful,
                           std::span<const std::uint32_t> near) {
  const FloatTag tag;
  const BitsTag bits_tag;
  const std::size_t width = D > 0 ? D : points.dimension();
  const auto minus_doubtful = hn::Set(tag, -doubtful);
  auto below = hn::Zero(bits_tag);
  for (const std::uint32_t group : near) {
    for (std::size_t at = 0; at < PointGroups::kSize; at += hn::Lanes(tag)) {
      auto difference = minus_doubtful;
      for (std::size_t k = 0; k < width; ++k) {
        const auto coordinates = hn::LoadU(tag, points.scaled_rows(group, k) + at);
        difference = hn::MulAdd(hn::Set(tag, normal[k]), coordinates, difference);
      }
      below = hn::Add(below, is_below(difference));
    }
  }
  return near.size() * PointGroups::kSize - hn::GetLane(hn::SumOfLanes(bits_tag, below));
}

template <std::size_t D>
double largest_in_groups(const PointGroups& points, const double* normal, std::span<const std::uint32_t> near,
                         double largest) {
  const DoubleTag tag;
  const std::size_t width = D > 0 ? D : points.dimension();
  auto best = hn::Set(tag, largest);
  for (const std::uint32_t group : near) {
    for (std::size_t at = 0; at < PointGroups::kSize; at += hn::Lanes(tag)) {
      auto dot = hn::Mul(hn::Set(tag, normal[0]), hn::LoadU(tag, points.rows(group, 0) + at));
      for (std::size_t k = 1; k < width; ++k) {
        dot = hn::MulAdd(hn::Set(tag, normal[k]), hn::LoadU(tag, points.rows(group, k) + at), dot);
      }
      best = hn::Max(best, dot);
    }
  }
  return hn::GetLane(hn::MaxOfLanes(tag, best));
}

/// The groups near each facet.
template <std::size_t D>
void highest_dots_near(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                       std::span<double> largest) {
  constexpr std::size_t kBatch = 32;
  const std::size_t width = D > 0 ? D : points.dimension();
  const std::size_t row = points.padded_count() + PointGroups::kSize;
  ScaledDirections<D, kBatch> directions(width);
  std::vector<std::uint32_t> near(kBatch * row);
  std::size_t near_count[kBatch];
  for (std::size_t first = 0; first < largest.size(); first += kBatch) {
    const std::size_t used = std::min(kBatch, largest.size() - first);
    for (std::size_t i = 0; i < used; ++i) {
      const std::size_t facet = first + i;
      scale_direction(points, normals.data() + facet * width, own, facet, directions, i);
    }
    for (std::size_t i = 0; i < used; ++i) {
      near_count[i] = list_near_groups<D>(points, directions.normals.data() + i * width,
                                          directions.doubtful[i], near.data() + i * row);
    }
    for (std::size_t i = 0; i < used; ++i) {
      const std::size_t facet = first + i;
      const std::span<const std::uint32_t> groups(near.data() + i * row, near_count[i]);
      largest[facet] = own.high[facet];
      if (directions.own[i] > 0 && count_doubtful<D>(points, directions.normals.data() + i * width,
                                                     directions.doubtful[i], groups) == directions.own[i]) {
        continue;  // the own vertices are, and no other point is
      }
      largest[facet] = largest_in_groups<D>(points, normals.data() + facet * width, groups, own.high[facet]);
    }
  }
}

/// Vectors of facets at a time, and all points: where points are few or their balls large.
template <std::size_t D>
void highest_dots_all(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                      std::span<double> largest) {
  constexpr std::size_t kVectors = 2;  // facets that share what is loaded of a point
  const FloatTag tag;
  const BitsTag bits_tag;
  const std::size_t lanes = hn::Lanes(tag), batch = kVectors * lanes;
  const std::size_t width = D > 0 ? D : points.dimension();
  ScaledDirections<D, kVectors * PointGroups::kSize> directions(width);
  std::vector<float> transposed(width * batch);
  std::uint32_t below_count[kVectors * PointGroups::kSize];
  std::vector<std::uint32_t> all(points.count());
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t first = 0; first < largest.size(); first += batch) {
    const std::size_t used = std::min(batch, largest.size() - first);
    for (std::size_t lane = 0; lane < batch; ++lane) {
      const std::size_t facet = first + std::min(lane, used - 1);
      scale_direction(points, normals.data() + facet * width, own, facet, directions, lane);
      for (std::size_t k = 0; k < width; ++k)
        transposed[k * batch + lane] = directions.normals[lane * width + k];
    }
    const auto zero = hn::Zero(tag);
    const auto minus_0 = hn::Sub(zero, hn::LoadU(tag, directions.doubtful));
    const auto minus_1 = hn::Sub(zero, hn::LoadU(tag, directions.doubtful + lanes));
    auto below_0 = hn::Zero(bits_tag), below_1 = below_0;
    std::size_t left = points.point_count();
    for (std::size_t group = 0; group < points.count(); ++group) {
      const float* const rows = points.scaled_rows(group, 0);
      const std::size_t size = std::min(left, PointGroups::kSize);
      left -= size;
      for (std::size_t i = 0; i < size; ++i) {
        const float* const x = rows + i;
        auto above_0 = minus_0, above_1 = minus_1;
        for (std::size_t k = 0; k < width; ++k) {
          const auto coordinate = hn::Set(tag, x[k * PointGroups::kSize]);
          above_0 = hn::MulAdd(hn::LoadU(tag, transposed.data() + k * batch), coordinate, above_0);
          above_1 = hn::MulAdd(hn::LoadU(tag, transposed.data() + k * batch + lanes), coordinate, above_1);
        }
        below_0 = hn::Add(below_0, is_below(above_0));
        below_1 = hn::Add(below_1, is_below(above_1));
      }
    }
    hn::StoreU(below_0, bits_tag, below_count);
    hn::StoreU(below_1, bits_tag, below_count + lanes);
    for (std::size_t lane = 0; lane < used; ++lane) {
      const std::size_t facet = first + lane;
      largest[facet] = own.high[facet];
      if (directions.own[lane] > 0 && points.point_count() - below_count[lane] == directions.own[lane])
        continue;
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
  if (balls_are_large && (own.count > 0 || !own.close.empty())) {
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
    if (largest >= 0x1p1022) product_size_ = 0.25;
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
  for (std::size_t k = 0; k < dimension_; ++k) {
    for (std::size_t i = 0; i < kSize; ++i) {  // the last point fills the last group
      const double x = points[members[std::min(i, members.size() - 1)] * dimension_ + k];
      const std::size_t at = (group * dimension_ + k) * kSize + i;
      rows_[at] = x;
      scaled_rows_[at] = static_cast<float>(x / column_sizes_[k]);
    }
  }
  find_centre(group);
  double distance_sq[kSize] = {};
  for (std::size_t k = 0; k < dimension_; ++k) {
    const double centre{centres_[k * padded_count_ + group]};
    for (std::size_t i = 0; i < kSize; ++i) {
      const double away = rows_[(group * dimension_ + k) * kSize + i] / column_sizes_[k] - centre;
      distance_sq[i] += away * away;
    }
  }
  const double radius = std::sqrt(*std::max_element(distance_sq, distance_sq + kSize));
  radii_[group] = static_cast<float>(radius) * (1.0f + 0x1p-20f) + 0x1p-40f;
}

// Near that of the smallest ball: from the mean towards the furthest point, by less each time (Badoiu,
// Clarkson. Smaller core-sets for balls. SODA 2003). Balls around the mean would leave half as many groups
// again in doubt.
void PointGroups::find_centre(std::size_t group) {
  constexpr std::size_t kSteps = 24;
  const float* const rows = scaled_rows(group, 0);
  float* const centre = centres_.data() + group;
  for (std::size_t k = 0; k < dimension_; ++k) {
    const float sum = std::accumulate(rows + k * kSize, rows + (k + 1) * kSize, 0.0f);
    centre[k * padded_count_] = sum / static_cast<float>(kSize);
  }
  for (std::size_t step = 0; step < kSteps; ++step) {
    float distance_sq[kSize] = {};
    for (std::size_t k = 0; k < dimension_; ++k) {
      for (std::size_t i = 0; i < kSize; ++i) {
        const float away = rows[k * kSize + i] - centre[k * padded_count_];
        distance_sq[i] += away * away;
      }
    }
    const auto furthest =
        static_cast<std::size_t>(std::max_element(distance_sq, distance_sq + kSize) - distance_sq);
    for (std::size_t k = 0; k < dimension_; ++k) {
      float& entry = centre[k * padded_count_];
      entry += (rows[k * kSize + furthest] - entry) / static_cast<float>(step + 2);
    }
  }
}

void highest_dots(const PointGroups& points, std::span<const double> normals, const OwnDots& own,
                  std::span<double> largest) {
  NDHULL_BEST_OF(highest_dots_any)(points, normals, own, largest);
}

}  // namespace ndhull
#endif
