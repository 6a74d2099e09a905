// Searches in a tree of points, compiled for each instruction set and chosen at run time.
#include "core/point_tree.h"

#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/point_search.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>

#include "core/blocks.h"
#include "core/dimension_switch.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, PointTree::kSize>;
using DoubleTag = hn::CappedTag<double, PointTree::kSize>;

/// One search: a direction, of length 1 in the cones' coordinates, and the best so far.
template <std::size_t D>
class Search {
 public:
  explicit Search(const PointTree& tree)
      : tree_(tree),
        width_(D > 0 ? D : tree.dimension()),
        scaled_(width_),
        bounds_(tree.clusters().stride),
        along_(bounds_.size()) {
    // Roundings in single precision, each at most 2^-24 of the reach: of the direction, the axes, the sums
    // and what is made of them. The angles of the cones have room for what a root makes of theirs.
    margin_ = static_cast<float>(tree.reach() * static_cast<double>(width_ + 12) * 0x1p-23);
  }

  FurthestPoint run(const double* normal, double known) {
    normal_ = normal;
    scale();
    best_ = known;
    group_ = kNone;
    raise_threshold();
    const Cones& clusters = tree_.clusters();
    bound(clusters, 0, clusters.stride, bounds_.data(), along_.data());
    const auto search = [this](std::size_t group) { search_group(group); };
    const auto live = static_cast<std::ptrdiff_t>(clusters.count);
    for (std::size_t i = 0; i < kFirst && i < clusters.count; ++i) {
      const auto nearest =
          static_cast<std::size_t>(std::max_element(along_.begin(), along_.begin() + live) - along_.begin());
      search_cluster(nearest, search);
      along_[nearest] = -HUGE_VALF;
      bounds_[nearest] = -HUGE_VALF;
    }
    search_clusters(search);
    return {best_, group_ == kNone ? FurthestPoint::kNoRow : row_of_best()};
  }

  void collect(const double* normal, double least, std::vector<FurthestPoint>& found) {
    normal_ = normal;
    scale();
    best_ = least;
    raise_threshold();
    const Cones& clusters = tree_.clusters();
    bound(clusters, 0, clusters.stride, bounds_.data(), along_.data());
    search_clusters([&](std::size_t group) {
      double products[PointTree::kSize];
      store_dots(group, products);
      const std::size_t first = group * PointTree::kSize;
      for (std::size_t i = 0; i < PointTree::kSize && first + i < tree_.point_count(); ++i)
        if (products[i] >= least) found.push_back({products[i], tree_.order()[first + i]});
    });
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  /// Clusters whose axes are nearest to the direction: one of them mostly holds the furthest point.
  static constexpr std::size_t kFirst = 4;

  // By the largest entry first: squares of very large or small ones are none.
  void scale() {
    const double* sizes = tree_.column_sizes().data();
    largest_ = 0.0;
    for (std::size_t k = 0; k < width_; ++k) largest_ = std::max(largest_, std::abs(normal_[k]) * sizes[k]);
    double length_sq = 0.0;
    for (std::size_t k = 0; k < width_; ++k) {
      const double entry = normal_[k] * sizes[k] / largest_;
      length_sq += entry * entry;
    }
    length_ = std::sqrt(length_sq);
    middle_ = 0.0;
    for (std::size_t k = 0; k < width_; ++k) {
      const double scaled = normal_[k] * sizes[k] / largest_ / length_;
      scaled_[k] = static_cast<float>(scaled);
      middle_ += scaled * tree_.middle()[k];
    }
  }

  // A NaN, of a normal without length or the like, leaves nothing out.
  void raise_threshold() { threshold_ = static_cast<float>(best_ / largest_ / length_ - middle_) - margin_; }

  /// Upper bounds, but for the margin, on how far the cones [begin, end) reach, and the cosines to their
  /// axes.
  HWY_INLINE void bound(const Cones& cones, std::size_t begin, std::size_t end, float* bounds,
                        float* cosines) const {
    const FloatTag tag;
    const auto one = hn::Set(tag, 1.0f), zero = hn::Zero(tag);
    for (std::size_t at = begin; at < end; at += hn::Lanes(tag)) {
      auto along = hn::Mul(hn::Set(tag, scaled_[0]), hn::LoadU(tag, cones.axes.data() + at));
      for (std::size_t k = 1; k < width_; ++k) {
        const auto normal = hn::Set(tag, scaled_[k]);
        along = hn::MulAdd(normal, hn::LoadU(tag, cones.axes.data() + k * cones.stride + at), along);
      }
      const auto cosine = hn::LoadU(tag, cones.cosines.data() + at);
      const auto across = hn::Sqrt(hn::Max(hn::NegMulAdd(along, along, one), zero));
      const auto turned = hn::MulAdd(along, cosine, hn::Mul(across, hn::LoadU(tag, cones.sines.data() + at)));
      // In the cone: its whole reach. Behind: what is shortest reaches furthest.
      const auto share = hn::IfThenElse(hn::Lt(along, cosine), hn::Max(turned, zero), one);
      hn::StoreU(hn::Mul(share, hn::LoadU(tag, cones.reaches.data() + at)), tag, bounds + (at - begin));
      hn::StoreU(along, tag, cosines + (at - begin));
    }
  }

  /// Calls `search` with the groups that may reach the threshold, in order.
  template <class Call>
  HWY_INLINE void search_clusters(const Call& search) {
    const FloatTag tag;
    const Cones& clusters = tree_.clusters();
    for (std::size_t begin = 0; begin < clusters.stride; begin += hn::Lanes(tag)) {
      const auto least = hn::Set(tag, threshold_);
      // A NaN is not below: it leaves nothing out.
      if (hn::AllTrue(tag, hn::Lt(hn::LoadU(tag, bounds_.data() + begin), least))) continue;
      for (std::size_t at = begin; at < begin + hn::Lanes(tag) && at < clusters.count; ++at)
        if (!(bounds_[at] < threshold_)) search_cluster(at, search);
    }
  }

  template <class Call>
  HWY_INLINE void search_cluster(std::size_t cluster, const Call& search) {
    const std::size_t begin = cluster * PointTree::kSize;
    float bounds[PointTree::kSize], along[PointTree::kSize];
    bound(tree_.groups(), begin, begin + PointTree::kSize, bounds, along);
    const std::size_t count = std::min(PointTree::kSize, tree_.groups().count - begin);
    for (std::size_t i = 0; i < count; ++i)
      if (!(bounds[i] < threshold_)) search(begin + i);
  }

  HWY_INLINE void search_group(std::size_t group) {
    const DoubleTag tag;
    auto best = hn::Set(tag, -HUGE_VAL);
    for (std::size_t at = 0; at < PointTree::kSize; at += hn::Lanes(tag))
      best = hn::Max(best, dots(group, at));
    const double highest = hn::GetLane(hn::MaxOfLanes(tag, best));
    if (!(highest > best_)) return;
    best_ = highest;
    group_ = group;
    raise_threshold();
  }

  HWY_INLINE hn::VFromD<DoubleTag> dots(std::size_t group, std::size_t at) const {
    const DoubleTag tag;
    auto dot = hn::Mul(hn::Set(tag, normal_[0]), hn::LoadU(tag, tree_.rows(group, 0) + at));
    for (std::size_t k = 1; k < width_; ++k)
      dot = hn::MulAdd(hn::Set(tag, normal_[k]), hn::LoadU(tag, tree_.rows(group, k) + at), dot);
    return dot;
  }

  HWY_INLINE void store_dots(std::size_t group, double* products) const {
    const DoubleTag tag;
    for (std::size_t at = 0; at < PointTree::kSize; at += hn::Lanes(tag))
      hn::StoreU(dots(group, at), tag, products + at);
  }

  std::uint32_t row_of_best() const {
    double products[PointTree::kSize];
    store_dots(group_, products);
    const auto lane =
        static_cast<std::size_t>(std::find(products, products + PointTree::kSize, best_) - products);
    return tree_.order()[std::min(group_ * PointTree::kSize + lane, tree_.point_count() - 1)];
  }

  const PointTree& tree_;
  std::size_t width_;
  const double* normal_ = nullptr;
  std::vector<float> scaled_, bounds_, along_;
  double largest_ = 0.0, length_ = 0.0, middle_ = 0.0, best_ = 0.0;
  float margin_ = 0.0f, threshold_ = 0.0f;
  std::size_t group_ = kNone;  // that holds the best
};

/// Calls `call` with a search. Loops of known length pay most where they are short, and each takes a second
/// to compile.
template <class Call>
void with_search(const PointTree& tree, const Call& call) {
  constexpr std::size_t kFirst = 4, kLast = 9;
  if (tree.dimension() < kFirst || tree.dimension() > kLast) return call(Search<0>(tree));
  call_with_dimension<kFirst, kLast>(tree.dimension(), [&](auto d) { call(Search<d>(tree)); });
}

void find_furthest_any(const PointTree& tree, std::span<const double> normals,
                       std::span<FurthestPoint> furthest) {
  with_search(tree, [&](auto search) {
    for (std::size_t i = 0; i < furthest.size(); ++i)
      furthest[i] = search.run(normals.data() + i * tree.dimension(), furthest[i].dot);
  });
}

void find_above_any(const PointTree& tree, const double* normal, double least,
                    std::vector<FurthestPoint>& found) {
  with_search(tree, [&](auto search) { search.collect(normal, least, found); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {
HWY_EXPORT(find_furthest_any);
HWY_EXPORT(find_above_any);

void find_furthest(const PointTree& tree, std::span<const double> normals,
                   std::span<FurthestPoint> furthest) {
  constexpr std::size_t kDirectionsAtATime = 64;
  for_each_block(furthest.size(), kDirectionsAtATime, [&](std::size_t begin, std::size_t end) {
    HWY_DYNAMIC_DISPATCH(find_furthest_any)
    (tree, normals.subspan(begin * tree.dimension(), (end - begin) * tree.dimension()),
     furthest.subspan(begin, end - begin));
  });
}

void find_above(const PointTree& tree, std::span<const double> normal, double least,
                std::vector<FurthestPoint>& found) {
  HWY_DYNAMIC_DISPATCH(find_above_any)(tree, normal.data(), least, found);
}

}  // namespace ndhull
#endif
