// A search in a tree of points. Included once per target by the sources that search.

#if defined(NDHULL_TREE_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_TREE_SEARCH_INL_H_
#undef NDHULL_TREE_SEARCH_INL_H_
#else
#define NDHULL_TREE_SEARCH_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dimension_switch.h"
#include "core/machine/mask_bits-inl.h"
#include "core/machine/prefetch.h"
#include "core/search/point_tree.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, PointTree::kSize>;

/// One search: a direction, of length 1 in the enclosures' coordinates, and the best so far.
template <std::size_t D>
class TreeSearch {
 public:
  explicit TreeSearch(const PointTree& tree)
      : tree_(tree),
        width_(tree.dimension()),
        scaled_(width_),
        bounds_(tree.clusters().stride),
        along_(bounds_.size()),
        lately_(kLately * width_) {
    // Roundings in single precision, each at most 2^-24 of the reach: of the direction, the axes, the sums
    // (of two products a coordinate for boxes) and what is made of them. The angles of the cones have room for
    // what a root makes of theirs.
    // And in double precision, of products from which the middle's is taken off.
    double far = tree.reach();
    for (const double x : tree.middle()) far += std::abs(x);
    margin_ = static_cast<float>(tree.reach() * static_cast<double>(2 * width_ + 12) * 0x1p-23 +
                                 far * static_cast<double>(4 * width_ + 32) * 0x1p-52);
  }

  /// Turns to a direction along which a product is known to be attained.
  void aim(const double* normal, double known) {
    normal_ = normal;
    scale();
    best_ = known;
    place_ = kNone;
    raise_threshold();
  }
  /// Of length 1, in the enclosures' coordinates, as what follows.
  const float* direction() const { return scaled_.data(); }
  /// How far points may reach that have a larger product than is known, by all that is rounded.
  float threshold() const { return threshold_; }
  /// What a product in single precision must be then.
  float point_threshold() const { return point_threshold_; }
  float margin() const { return margin_; }
  double size_of(double product) const { return std::abs(product) * per_size_; }

  FurthestPoint run(const double* normal, double known) {
    aim(normal, known);
    const Enclosures& clusters = tree_.clusters();
    look_at_latest();
    bound(clusters, 0, clusters.stride, bounds_.data(), along_.data());
    const auto search = [this](std::size_t group) { search_group(group); };
    const std::size_t first = place_ == kNone ? kFirst : 1;
    for (std::size_t i = 0; i < first && i < clusters.count; ++i) {
      const std::size_t nearest = nearest_cluster();
      search_cluster(nearest, search);
      along_[nearest] = -HUGE_VALF;
      bounds_[nearest] = -HUGE_VALF;
    }
    search_clusters(search);
    if (place_ == kNone) return {best_, FurthestPoint::kNoRow};
    remember(place_);
    return {best_, tree_.order()[place_]};
  }

  void collect(const double* normal, double least, std::vector<FurthestPoint>& found) {
    aim(normal, least);
    const Enclosures& clusters = tree_.clusters();
    bound(clusters, 0, clusters.stride, bounds_.data(), along_.data());
    search_clusters([&](std::size_t group) {
      for_each_near(group, [&](std::size_t place) {
        const double product = product_with(place);
        if (product >= least) found.push_back({product, tree_.order()[place]});
      });
    });
  }

  /// Lists the places of all points that reach as far along a direction, given as `direction` is, as
  /// `least_of` says for points no longer than its argument, and hardly more; not all where they are more than
  /// `most`. `lowest`: it is nowhere less.
  template <class LeastOf>
  void list_near(const float* direction, float lowest, const LeastOf& least_of, std::size_t most,
                 std::vector<std::uint32_t>& places) {
    std::copy_n(direction, width(), scaled_.data());
    threshold_ = lowest;
    const Enclosures& clusters = tree_.clusters();
    bound(clusters, 0, clusters.stride, bounds_.data(), along_.data());
    for (std::size_t cluster = 0; cluster < clusters.count && places.size() <= most; ++cluster) {
      threshold_ = least_of(clusters.reaches[cluster]);
      if (bounds_[cluster] < threshold_) continue;
      search_cluster(cluster, [&](std::size_t group) {
        point_threshold_ = least_of(tree_.groups().reaches[group]);
        for_each_near(group, [&](std::size_t place) { places.push_back(static_cast<std::uint32_t>(place)); });
      });
    }
  }

  /// The largest product of a direction with any of these points, or what is known. `rows`: their coordinates,
  /// as the tree's groups have them.
  double highest_of(const double* normal, double known, std::span<const std::uint32_t> places,
                    const float* rows) {
    aim(normal, known);
    for (std::size_t first = 0; first < places.size(); first += PointTree::kSize) {
      for_each_of(rows + first * width(), [&](std::size_t lane) {
        if (first + lane < places.size()) try_place(places[first + lane]);
      });
    }
    return best_;
  }

 private:
  /// Known when it is compiled where D is not 0: then loops over it are unrolled.
  HWY_INLINE std::size_t width() const { return D > 0 ? D : width_; }

  static constexpr std::size_t kNone = ~std::size_t{0};
  /// Clusters whose axes are nearest to the direction: one of them mostly holds the furthest point.
  static constexpr std::size_t kFirst = 4;

  /// The points that were furthest along the latest directions, whole vectors of them: directions that come
  /// one after the other are often near each other.
  static constexpr std::size_t kLately = 4 * PointTree::kSize;

  void remember(std::size_t place) {
    if (std::find(latest_places_.begin(), latest_places_.end(), place) != latest_places_.end()) return;
    const std::size_t at = next_latest_ % kLately;
    ++next_latest_;
    if (latest_places_.size() < kLately) {
      latest_places_.push_back(place);
    } else {
      latest_places_[at] = place;
    }
    const std::size_t vector = at / PointTree::kSize, lane = at % PointTree::kSize;
    for (std::size_t k = 0; k < width(); ++k) {
      const float x = tree_.scaled_rows(place / PointTree::kSize, k)[place % PointTree::kSize];
      lately_[(vector * width() + k) * PointTree::kSize + lane] = x;
    }
  }

  /// Raises the best by one of each vector of the latest.
  HWY_INLINE void look_at_latest() {
    float products[PointTree::kSize];
    const FloatTag tag;
    for (std::size_t first = 0; first < latest_places_.size(); first += PointTree::kSize) {
      for (std::size_t at = 0; at < PointTree::kSize; at += hn::Lanes(tag))
        hn::StoreU(scaled_dots(lately_.data() + first * width() + at), tag, products + at);
      const std::size_t count = std::min(PointTree::kSize, latest_places_.size() - first);
      std::size_t highest = 0;
      for (std::size_t i = 1; i < count; ++i)
        if (products[i] > products[highest]) highest = i;
      try_place(latest_places_[first + highest]);
    }
  }

  HWY_INLINE std::size_t nearest_cluster() const {
    const FloatTag tag;
    auto largest = hn::Set(tag, -HUGE_VALF);
    for (std::size_t at = 0; at < along_.size(); at += hn::Lanes(tag))
      largest = hn::Max(largest, hn::LoadU(tag, along_.data() + at));
    const float nearest = hn::GetLane(hn::MaxOfLanes(tag, largest));
    const auto found = std::find(along_.begin(), along_.end(), nearest) - along_.begin();
    return std::min(static_cast<std::size_t>(found), tree_.clusters().count - 1);
  }

  // By the largest entry first: squares of very large or small ones are none.
  void scale() {
    const double* sizes = tree_.column_sizes().data();
    largest_ = 0.0;
    for (std::size_t k = 0; k < width(); ++k) largest_ = std::max(largest_, std::abs(normal_[k]) * sizes[k]);
    const double per_largest = 1.0 / largest_;
    double length_sq = 0.0;
    for (std::size_t k = 0; k < width(); ++k) {
      const double entry = normal_[k] * sizes[k] * per_largest;
      length_sq += entry * entry;
    }
    const double per_length = 1.0 / std::sqrt(length_sq);
    middle_ = 0.0;
    for (std::size_t k = 0; k < width(); ++k) {
      const double scaled = normal_[k] * sizes[k] * per_largest * per_length;
      scaled_[k] = static_cast<float>(scaled);
      middle_ += scaled * tree_.middle()[k];
    }
    per_size_ = per_largest * per_length;
  }

  // A NaN, of a normal without length or the like, leaves nothing out.
  void raise_threshold() {
    constexpr float kSpare = 0x1p-40f;  // as enclosures have
    threshold_ = static_cast<float>(best_ * per_size_ - middle_) - margin_;
    point_threshold_ = threshold_ - kSpare;
  }

  /// Upper bounds, but for the margin, on how far the enclosures [begin, end) reach, and the cosines to the
  /// axes of their cones. Boxes are looked at where a cone of the vector reaches the threshold.
  HWY_INLINE void bound(const Enclosures& level, std::size_t begin, std::size_t end, float* bounds,
                        float* cosines) const {
    const FloatTag tag;
    const auto one = hn::Set(tag, 1.0f), zero = hn::Zero(tag), threshold = hn::Set(tag, threshold_);
    for (std::size_t at = begin; at < end; at += hn::Lanes(tag)) {
      auto along = hn::Mul(hn::Set(tag, scaled_[0]), hn::LoadU(tag, level.axes.data() + at));
      for (std::size_t k = 1; k < width(); ++k) {
        const auto normal = hn::Set(tag, scaled_[k]);
        along = hn::MulAdd(normal, hn::LoadU(tag, level.axes.data() + k * level.stride + at), along);
      }
      const auto cosine = hn::LoadU(tag, level.cosines.data() + at);
      const auto across = hn::Sqrt(hn::Max(hn::NegMulAdd(along, along, one), zero));
      const auto turned = hn::MulAdd(along, cosine, hn::Mul(across, hn::LoadU(tag, level.sines.data() + at)));
      // In the cone: its whole reach. Behind: what is shortest reaches furthest.
      const auto share = hn::IfThenElse(hn::Lt(along, cosine), hn::Max(turned, zero), one);
      auto reach = hn::Mul(share, hn::LoadU(tag, level.reaches.data() + at));
      if (!hn::AllTrue(tag, hn::Lt(reach, threshold))) reach = least_of(reach, box_reach(level, at));
      hn::StoreU(reach, tag, bounds + (at - begin));
      hn::StoreU(along, tag, cosines + (at - begin));
    }
  }

  HWY_INLINE hn::VFromD<FloatTag> box_reach(const Enclosures& level, std::size_t at) const {
    const FloatTag tag;
    auto reach = hn::Zero(tag);
    for (std::size_t k = 0; k < width(); ++k) {
      const auto normal = hn::Set(tag, scaled_[k]);
      const std::size_t from = k * level.stride + at;
      reach = hn::MulAdd(normal, hn::LoadU(tag, level.centres.data() + from), reach);
      reach = hn::MulAdd(hn::Abs(normal), hn::LoadU(tag, level.half_sizes.data() + from), reach);
    }
    return reach;
  }

  /// A NaN bounds nothing, and stays.
  static HWY_INLINE hn::VFromD<FloatTag> least_of(hn::VFromD<FloatTag> a, hn::VFromD<FloatTag> b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
  }

  /// Calls `call` with the places of those entries that are not below the threshold, in order. A NaN is not
  /// below: it leaves nothing out.
  template <class Call>
  HWY_INLINE void for_each_above(const float* bounds, std::size_t count, const Call& call) {
    const FloatTag tag;
    for (std::size_t begin = 0; begin < count; begin += hn::Lanes(tag)) {
      const auto is_below = hn::Lt(hn::LoadU(tag, bounds + begin), hn::Set(tag, threshold_));
      if (hn::AllTrue(tag, is_below)) continue;
      for (std::uint64_t bits = bits_of_mask(tag, hn::Not(is_below)); bits != 0; bits &= bits - 1) {
        const std::size_t at = begin + static_cast<std::size_t>(__builtin_ctzll(bits));
        if (at < count && !(bounds[at] < threshold_)) call(at);  // it may have been raised since
      }
    }
  }

  /// Calls `search` with the groups that may reach the threshold, in order.
  template <class Call>
  HWY_INLINE void search_clusters(const Call& search) {
    for_each_above(bounds_.data(), tree_.clusters().count,
                   [&](std::size_t cluster) { search_cluster(cluster, search); });
  }

  template <class Call>
  HWY_INLINE void search_cluster(std::size_t cluster, const Call& search) {
    const std::size_t begin = cluster * PointTree::kSize;
    float bounds[PointTree::kSize], along[PointTree::kSize];
    bound(tree_.groups(), begin, begin + PointTree::kSize, bounds, along);
    const std::size_t count = std::min(PointTree::kSize, tree_.groups().count - begin);
    for_each_above(bounds, count,
                   [&](std::size_t i) {  // all on their way from memory before the first is used
                     for (std::size_t k = 0; k < width(); ++k) prefetch(tree_.scaled_rows(begin + i, k));
                   });
    for_each_above(bounds, count, [&](std::size_t i) { search(begin + i); });
  }

  /// Calls `call` with the places of a group that may reach the best.
  template <class Call>
  HWY_INLINE void for_each_near(std::size_t group, const Call& call) const {
    for_each_of(tree_.scaled_rows(group, 0), [&](std::size_t lane) {
      const std::size_t place = group * PointTree::kSize + lane;
      if (place < tree_.point_count()) call(place);
    });
  }

  /// Those of kSize points, by their coordinates. The margin has room for the rounding of products in single
  /// precision too.
  template <class Call>
  HWY_INLINE void for_each_of(const float* rows, const Call& call) const {
    const FloatTag tag;
    const auto least = hn::Set(tag, point_threshold_);
    for (std::size_t at = 0; at < PointTree::kSize; at += hn::Lanes(tag)) {
      const auto is_below = hn::Lt(scaled_dots(rows + at), least);
      if (hn::AllTrue(tag, is_below)) continue;
      for (std::uint64_t bits = bits_of_mask(tag, hn::Not(is_below)); bits != 0; bits &= bits - 1)
        call(at + static_cast<std::size_t>(__builtin_ctzll(bits)));
    }
  }

  HWY_INLINE void search_group(std::size_t group) {
    for_each_near(group, [this](std::size_t place) { try_place(place); });
  }

  HWY_INLINE void try_place(std::size_t place) {
    const double product = product_with(place);
    if (!(product > best_)) return;
    best_ = product;
    place_ = place;
    raise_threshold();
  }

  /// As vectors would have it: a fused chain where the instruction set has such.
  HWY_INLINE double product_with(std::size_t place) const {
    const hn::CappedTag<double, 1> tag;
    const double* point = tree_.point(place);
    auto product = hn::Mul(hn::Set(tag, normal_[0]), hn::Set(tag, point[0]));
    for (std::size_t k = 1; k < width(); ++k)
      product = hn::MulAdd(hn::Set(tag, normal_[k]), hn::Set(tag, point[k]), product);
    return hn::GetLane(product);
  }

  /// Products with `kSize` points in single precision, `row` being the first coordinates of Lanes of them.
  HWY_INLINE hn::VFromD<FloatTag> scaled_dots(const float* row) const {
    const FloatTag tag;
    auto dot = hn::Mul(hn::Set(tag, scaled_[0]), hn::LoadU(tag, row));
    for (std::size_t k = 1; k < width(); ++k)
      dot = hn::MulAdd(hn::Set(tag, scaled_[k]), hn::LoadU(tag, row + k * PointTree::kSize), dot);
    return dot;
  }

  const PointTree& tree_;
  std::size_t width_;
  const double* normal_ = nullptr;
  std::vector<float> scaled_, bounds_, along_;
  std::vector<float> lately_;  // the latest points, as the groups of the tree
  std::vector<std::size_t> latest_places_;
  std::size_t next_latest_ = 0;
  double largest_ = 0.0, per_size_ = 0.0, middle_ = 0.0, best_ = 0.0;
  float margin_ = 0.0f, threshold_ = 0.0f, point_threshold_ = 0.0f;
  std::size_t place_ = kNone;  // of the best
};

/// Calls `call` with the tree's dimension, or with 0. Loops of known length pay most where they are short, and
/// each takes a second to compile.
template <class Call>
void with_tree_dimension(const PointTree& tree, const Call& call) {
  constexpr std::size_t kFirst = 4, kLast = 9;
  if (tree.dimension() < kFirst || tree.dimension() > kLast)
    return call(std::integral_constant<std::size_t, 0>());
  call_with_dimension<kFirst, kLast>(tree.dimension(), call);
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per target
