// Searches for bundles of directions, compiled for each instruction set and chosen at run time.
#include "core/search/bundle_search.h"

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/search/bundle_search.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <vector>

#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"
#include "core/search/tree_search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

using CountTag = hn::RebindToUnsigned<FloatTag>;

/// Facets in an order in which near normals come together, as many at a time as have few points near.
template <std::size_t D>
class BundleSearch {
 public:
  BundleSearch(const PointTree& tree, const double* normals, const OwnDots& own, double* largest)
      : tree_(tree),
        width_(tree.dimension()),
        normals_(normals),
        own_(own),
        largest_(largest),
        search_(tree),
        directions_(kMost * width_),
        axis_(width_) {}

  void run(std::span<const std::uint32_t> facets) {
    constexpr std::size_t kMostInVain = 8;
    for (std::size_t size = kMost, in_vain = 0; !facets.empty();) {
      const auto bundle = facets.first(std::min(size, facets.size()));
      const bool is_tried = in_vain < kMostInVain;
      if (is_tried) prefetch_all(facets.subspan(bundle.size()));
      if (is_tried && search_bundle(bundle)) {
        size = std::min(2 * size, kMost);
      } else if (size > kLeast) {  // a part of it may be nearer to each other
        size /= 2;
        continue;
      } else {
        ++in_vain;
        search_one_by_one(bundle);
      }
      facets = facets.subspan(bundle.size());
    }
  }

 private:
  static constexpr std::size_t kMost = 64, kLeast = 4;  // facets of a bundle
  static constexpr std::size_t kVectors = 2;            // directions that share what is loaded of a point
  static constexpr std::size_t kMostPoints = 16384;
  static constexpr std::size_t kLevels = 12;  // lengths of points

  HWY_INLINE std::size_t width() const { return D > 0 ? D : width_; }
  const double* normal_of(std::uint32_t facet) const { return normals_ + std::size_t{facet} * width(); }

  /// What the next bundle reads, anywhere in memory.
  void prefetch_all(std::span<const std::uint32_t> facets) const {
    for (const std::uint32_t facet : facets.first(std::min(facets.size(), kMost))) {
      prefetch(normal_of(facet), width());
      prefetch(own_.high.data() + facet);
      prefetch(own_.low.data() + facet);
    }
  }

  void search_one_by_one(std::span<const std::uint32_t> facets) {
    for (const std::uint32_t facet : facets)
      largest_[facet] = search_.run(normal_of(facet), own_.high[facet]).dot;
  }

  /// No: points that may be above the planes are too many.
  bool search_bundle(std::span<const std::uint32_t> facets) {
    for (std::size_t i = 0; i < facets.size(); ++i) aim_at(facets[i], i);
    for (std::size_t i = facets.size(); i < kMost; ++i) {
      for (std::size_t k = 0; k < width(); ++k) directions_[k * kMost + i] = 0.0f;
      point_thresholds_[i] = 1.0f;
    }
    if (!find_axis(facets.size())) return false;
    places_.clear();
    search_.list_near(
        axis_.data(), least_of_level_[levels_ - 1], [&](float reach) { return least_of(reach); }, kMostPoints,
        places_);
    if (places_.size() > kMostPoints) return false;
    copy_rows();
    count_near();
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const double high = own_.high[facets[i]];
      largest_[facets[i]] = own_count_[i] > 0 && near_count_[i] == own_count_[i]
                                ? high
                                : search_.highest_of(normal_of(facets[i]), high, places_, rows_.data());
    }
    return true;
  }

  void aim_at(std::uint32_t facet, std::size_t at) {
    const double high = own_.high[facet], low = own_.low[facet];
    search_.aim(normal_of(facet), high);
    for (std::size_t k = 0; k < width(); ++k) directions_[k * kMost + at] = search_.direction()[k];
    thresholds_[at] = search_.threshold();
    point_thresholds_[at] = search_.point_threshold();
    // What is as near to the highest as this is counted for sure: the margin is four times what products in
    // single precision are off by.
    const double close = 0.25 * double{search_.margin()};
    if (!own_.close.empty()) {
      own_count_[at] = search_.size_of(high) * kCloseProducts <= close ? own_.close[facet] : 0;
    } else {
      own_count_[at] = search_.size_of(high - low) <= close ? static_cast<std::uint32_t>(own_.count) : 0;
    }
  }

  /// A point x no longer than r with n.x >= t, where n is turned from the axis by an angle a, has
  ///   axis.x >= t cos a - sqrt(r^2 - t^2) sin a, where t >= 0:
  /// what reaches far along n has little of its length across it. Of points that are all about as long as t,
  /// as on a sphere, that leaves those near the facets; where few are much longer it is found for several r.
  bool find_axis(std::size_t count) {
    double length_sq = 0.0;
    for (std::size_t k = 0; k < width(); ++k) {
      double sum = 0.0;
      for (std::size_t i = 0; i < count; ++i) sum += double{directions_[k * kMost + i]};
      axis_[k] = static_cast<float>(sum);
      length_sq += double{axis_[k]} * double{axis_[k]};
    }
    const double per_length = 1.0 / std::sqrt(length_sq);
    for (float& entry : axis_) entry = static_cast<float>(double{entry} * per_length);
    const double reach = tree_.point_reach();
    const double first = *std::min_element(thresholds_, thresholds_ + count);
    if (!(first >= 0.0)) return false;
    constexpr double kLevelStep = 0.04;  // of the longest: more levels leave hardly fewer points
    const double span = std::max(reach - first, 0.0);
    levels_ = std::clamp(static_cast<std::size_t>(span / (kLevelStep * reach)), std::size_t{1}, kLevels);
    level_step_ = static_cast<float>(span / static_cast<double>(levels_)) * (1.0f + 0x1p-10f);
    first_level_ = static_cast<float>(first);
    double lowest[kLevels];
    std::fill_n(lowest, kLevels, HUGE_VAL);
    for (std::size_t i = 0; i < count; ++i) {
      double chord_sq = 0.0;
      for (std::size_t k = 0; k < width(); ++k) {
        const double turn = double{directions_[k * kMost + i]} - double{axis_[k]};
        chord_sq += turn * turn;
      }
      const double t{thresholds_[i]};
      if (!(t >= 0.0 && chord_sq <= 2.0)) return false;  // NaN, too
      const double cosine = 1.0 - 0.5 * chord_sq, sine = std::sqrt(chord_sq * (1.0 - 0.25 * chord_sq));
      for (std::size_t level = 0; level < levels_; ++level) {
        const double r = length_of(level);
        const double least = t * cosine - std::sqrt(std::max(r * r - t * t, 0.0)) * sine;
        lowest[level] = std::min(lowest[level], least);
      }
    }
    for (std::size_t level = 0; level < levels_; ++level)
      least_of_level_[level] = static_cast<float>(lowest[level]) - search_.margin();
    return true;
  }

  /// Of the longest points of a level; none is longer than those of the last.
  double length_of(std::size_t level) const {
    return double{first_level_} + static_cast<double>(level + 1) * double{level_step_};
  }
  /// For points no longer than `reach`.
  float least_of(float reach) const {
    std::size_t level = 0;
    while (level + 1 < levels_ && !(reach <= length_of(level))) ++level;
    return least_of_level_[level];
  }

  void copy_rows() {
    const std::size_t groups = (places_.size() + PointTree::kSize - 1) / PointTree::kSize;
    rows_.resize(groups * width() * PointTree::kSize);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const float* const from =
          tree_.scaled_rows(places_[i] / PointTree::kSize, 0) + places_[i] % PointTree::kSize;
      float* const to =
          rows_.data() + i / PointTree::kSize * width() * PointTree::kSize + i % PointTree::kSize;
      for (std::size_t k = 0; k < width(); ++k) to[k * PointTree::kSize] = from[k * PointTree::kSize];
    }
  }

  /// How many of the listed points may have the highest product with each direction.
  void count_near() {
    const FloatTag tag;
    const CountTag count_tag;
    const std::size_t lanes = hn::Lanes(tag);
    for (std::size_t first = 0; first < kMost; first += kVectors * lanes) {
      const auto minus_0 = hn::Neg(hn::LoadU(tag, point_thresholds_ + first));
      const auto minus_1 = hn::Neg(hn::LoadU(tag, point_thresholds_ + first + lanes));
      auto below_0 = hn::Zero(count_tag), below_1 = below_0;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        const float* const x =
            rows_.data() + i / PointTree::kSize * width() * PointTree::kSize + i % PointTree::kSize;
        auto above_0 = minus_0, above_1 = minus_1;
        for (std::size_t k = 0; k < width(); ++k) {
          const auto coordinate = hn::Set(tag, x[k * PointTree::kSize]);
          const float* const entries = directions_.data() + k * kMost + first;
          above_0 = hn::MulAdd(hn::LoadU(tag, entries), coordinate, above_0);
          above_1 = hn::MulAdd(hn::LoadU(tag, entries + lanes), coordinate, above_1);
        }
        below_0 = hn::Add(below_0, hn::ShiftRight<31>(hn::BitCast(count_tag, above_0)));
        below_1 = hn::Add(below_1, hn::ShiftRight<31>(hn::BitCast(count_tag, above_1)));
      }
      const auto all = hn::Set(count_tag, static_cast<std::uint32_t>(places_.size()));
      hn::StoreU(hn::Sub(all, below_0), count_tag, near_count_ + first);
      hn::StoreU(hn::Sub(all, below_1), count_tag, near_count_ + first + lanes);
    }
  }

  const PointTree& tree_;
  std::size_t width_;
  const double* normals_;
  const OwnDots& own_;
  double* largest_;
  TreeSearch<D> search_;
  std::vector<float> directions_;  // dimension x kMost
  std::vector<float> axis_;
  float thresholds_[kMost], point_thresholds_[kMost];
  std::size_t levels_ = 1;
  float first_level_ = 0.0f, level_step_ = 0.0f;
  float least_of_level_[kLevels];
  std::uint32_t own_count_[kMost], near_count_[kMost];
  std::vector<std::uint32_t> places_;  // of points near the bundle
  std::vector<float> rows_;            // their coordinates, as the tree's groups have them
};

void search_bundles_any(const PointTree& tree, std::span<const double> normals,
                        std::span<const std::uint32_t> facets, const OwnDots& own,
                        std::span<double> largest) {
  with_tree_dimension(
      tree, [&](auto d) { BundleSearch<d>(tree, normals.data(), own, largest.data()).run(facets); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void highest_dots(const PointTree& tree, std::span<const double> normals,
                  std::span<const std::uint32_t> order, const OwnDots& own, std::span<double> largest) {
  constexpr std::size_t kFacetsAtATime = 1024;
  for_each_block(order.size(), kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    NDHULL_BEST_OF(search_bundles_any)(tree, normals, order.subspan(begin, end - begin), own, largest);
  });
}

}  // namespace ndhull
#endif
