#include "core/point_tree.h"

#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/point_tree.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <numeric>

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
    const auto live = static_cast<std::ptrdiff_t>(clusters.count);
    for (std::size_t i = 0; i < kFirst && i < clusters.count; ++i) {
      const auto nearest =
          static_cast<std::size_t>(std::max_element(along_.begin(), along_.begin() + live) - along_.begin());
      search_cluster(nearest);
      along_[nearest] = -HUGE_VALF;
      bounds_[nearest] = -HUGE_VALF;
    }
    const FloatTag tag;
    for (std::size_t begin = 0; begin < clusters.stride; begin += hn::Lanes(tag)) {
      const auto least = hn::Set(tag, threshold_);
      // A NaN is not below: it leaves nothing out.
      if (hn::AllTrue(tag, hn::Lt(hn::LoadU(tag, bounds_.data() + begin), least))) continue;
      for (std::size_t at = begin; at < begin + hn::Lanes(tag) && at < clusters.count; ++at)
        if (!(bounds_[at] < threshold_)) search_cluster(at);
    }
    return {best_, group_ == kNone ? FurthestPoint::kNoRow : row_of_best()};
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

  void search_cluster(std::size_t cluster) {
    const std::size_t begin = cluster * PointTree::kSize;
    float bounds[PointTree::kSize], along[PointTree::kSize];
    bound(tree_.groups(), begin, begin + PointTree::kSize, bounds, along);
    const std::size_t count = std::min(PointTree::kSize, tree_.groups().count - begin);
    for (std::size_t i = 0; i < count; ++i)
      if (!(bounds[i] < threshold_)) search_group(begin + i);
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

  std::uint32_t row_of_best() const {
    const DoubleTag tag;
    double products[PointTree::kSize];
    for (std::size_t at = 0; at < PointTree::kSize; at += hn::Lanes(tag))
      hn::StoreU(dots(group_, at), tag, products + at);
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

template <std::size_t D>
void find_furthest_of(const PointTree& tree, std::span<const double> normals,
                      std::span<FurthestPoint> furthest) {
  Search<D> search(tree);
  for (std::size_t i = 0; i < furthest.size(); ++i)
    furthest[i] = search.run(normals.data() + i * tree.dimension(), furthest[i].dot);
}

void find_furthest_any(const PointTree& tree, std::span<const double> normals,
                       std::span<FurthestPoint> furthest) {
  // Loops of known length pay most where they are short, and each takes a second to compile.
  constexpr std::size_t kFirst = 4, kLast = 9;
  if (tree.dimension() < kFirst || tree.dimension() > kLast)
    return find_furthest_of<0>(tree, normals, furthest);
  call_with_dimension<kFirst, kLast>(tree.dimension(),
                                     [&](auto d) { find_furthest_of<d>(tree, normals, furthest); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {
HWY_EXPORT(find_furthest_any);

namespace {

/// Puts neighbours together: splits in halves, each time along the column that is longest in a sample.
class NeighbourOrder {
 public:
  NeighbourOrder(std::size_t dimension, std::vector<float> points)
      : dimension_(dimension), points_(std::move(points)), places_(points_.size() / dimension) {}

  std::vector<std::uint32_t> run() {
    for (std::size_t i = 0; i < places_.size(); ++i) places_[i].row = static_cast<std::uint32_t>(i);
    split(places_);
    std::vector<std::uint32_t> order(places_.size());
    std::transform(places_.begin(), places_.end(), order.begin(),
                   [](const Place& place) { return place.row; });
    return order;
  }

 private:
  struct Place {
    float key;
    std::uint32_t row;
    bool operator<(const Place& other) const { return key != other.key ? key < other.key : row < other.row; }
  };

  void split(std::span<Place> places) {
    constexpr std::size_t kInCluster = PointTree::kSize * PointTree::kSize, kWorthAThread = 1 << 13;
    if (places.size() <= PointTree::kSize) return;
    const std::size_t column = longest_column(places);
    for (Place& place : places) place.key = points_[std::size_t{place.row} * dimension_ + column];
    const std::size_t unit = places.size() > kInCluster ? kInCluster : PointTree::kSize;
    const std::size_t half = (places.size() + unit - 1) / unit / 2 * unit;
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(half), places.end());
    const auto low = places.first(half), high = places.subspan(half);
    if (places.size() < kWorthAThread) {
      split(low);
      split(high);
    } else {
      tbb::parallel_invoke([&] { split(low); }, [&] { split(high); });
    }
  }

  std::size_t longest_column(std::span<const Place> places) const {
    constexpr std::size_t kSample = 32;
    const std::size_t step = std::max<std::size_t>(1, places.size() / kSample);
    std::size_t longest = 0;
    float longest_extent = -1.0f;
    for (std::size_t k = 0; k < dimension_; ++k) {
      float low = HUGE_VALF, high = -HUGE_VALF;
      for (std::size_t i = 0; i < places.size(); i += step) {
        const float x = points_[std::size_t{places[i].row} * dimension_ + k];
        low = std::min(low, x);
        high = std::max(high, x);
      }
      if (high - low <= longest_extent) continue;
      longest_extent = high - low;
      longest = k;
    }
    return longest;
  }

  std::size_t dimension_;
  std::vector<float> points_;
  std::vector<Place> places_;
};

Cones make_cones(std::size_t dimension, std::size_t count) {
  constexpr float kNowhere = -0x1p100f;  // as a reach
  Cones cones;
  cones.count = count;
  cones.stride = (count + PointTree::kSize - 1) / PointTree::kSize * PointTree::kSize;
  cones.axes.resize(cones.stride * dimension);
  cones.reaches.assign(cones.stride, kNowhere);
  cones.cosines.assign(cones.stride, -2.0f);
  cones.sines.assign(cones.stride, 0.0f);
  return cones;
}

}  // namespace

PointTree::PointTree(std::size_t dimension, std::span<const double> points) : dimension_(dimension) {
  find_columns(points);
  std::vector<float> scaled(points.size());
  for (std::size_t i = 0; i < points.size(); i += dimension)
    for (std::size_t k = 0; k < dimension; ++k)
      scaled[i + k] = static_cast<float>(points[i + k] / column_sizes_[k]);
  order_ = NeighbourOrder(dimension, std::move(scaled)).run();
  fill(points);
}

PointTree::PointTree(std::size_t dimension, std::span<const double> points, std::vector<std::uint32_t> order)
    : dimension_(dimension), order_(std::move(order)) {
  find_columns(points);
  fill(points);
}

void PointTree::find_columns(std::span<const double> points) {
  column_sizes_.assign(dimension_, 1.0);
  middle_.assign(dimension_, 0.0);
  std::vector<double> low(dimension_, HUGE_VAL), high(dimension_, -HUGE_VAL);
  for (std::size_t i = 0; i < points.size(); i += dimension_) {
    for (std::size_t k = 0; k < dimension_; ++k) {
      low[k] = std::min(low[k], points[i + k]);
      high[k] = std::max(high[k], points[i + k]);
    }
  }
  for (std::size_t k = 0; k < dimension_; ++k) {
    const double largest = std::max(std::abs(low[k]), std::abs(high[k]));
    if (largest > 0.0) column_sizes_[k] = std::ldexp(1.0, std::clamp(std::ilogb(largest) + 1, -1000, 1023));
    middle_[k] = 0.5 * (low[k] / column_sizes_[k]) + 0.5 * (high[k] / column_sizes_[k]);
  }
}

void PointTree::fill(std::span<const double> points) {
  const std::size_t group_count = (order_.size() + kSize - 1) / kSize;
  groups_ = make_cones(dimension_, group_count);
  clusters_ = make_cones(dimension_, (group_count + kSize - 1) / kSize);
  rows_.resize(group_count * dimension_ * kSize);
  constexpr std::size_t kClustersAtATime = 4;
  for_each_block(clusters_.count, kClustersAtATime, [&](std::size_t first, std::size_t last) {
    for (std::size_t cluster = first; cluster < last; ++cluster) {
      const std::size_t begin = cluster * kSize, end = std::min(begin + kSize, group_count);
      for (std::size_t group = begin; group < end; ++group) {
        for (std::size_t i = 0; i < kSize; ++i) {
          const std::size_t row = order_[std::min(group * kSize + i, order_.size() - 1)];
          for (std::size_t k = 0; k < dimension_; ++k)
            rows_[(group * dimension_ + k) * kSize + i] = points[row * dimension_ + k];
        }
        fill_cone(group, group + 1, groups_, group);
      }
      fill_cone(begin, end, clusters_, cluster);
    }
  });
  for (std::size_t i = 0; i < clusters_.count; ++i) reach_ = std::max(reach_, double{clusters_.reaches[i]});
}

// The axis goes through the mean of the points, seen from the middle of all.
void PointTree::fill_cone(std::size_t first_group, std::size_t last_group, Cones& cones, std::size_t cone) {
  constexpr std::size_t kMostPoints = kSize * kSize;
  // A cone's angle is wider than its points need by this, and at least this: then the root of 1 - cosine^2 in
  // single precision turns a direction by less. [radian]
  constexpr double kTurn = 2e-3;
  double along[kMostPoints] = {}, length_sq[kMostPoints] = {};
  const std::size_t count = (last_group - first_group) * kSize;
  std::vector<double> axis(dimension_);
  double axis_sq = 0.0;
  const auto for_each_of = [&](std::size_t k, const auto& call) {
    const double per_size = 1.0 / column_sizes_[k];
    for (std::size_t group = first_group; group < last_group; ++group) {
      const double* row = rows(group, k);
      for (std::size_t i = 0; i < kSize; ++i)
        call((group - first_group) * kSize + i, row[i] * per_size - middle_[k]);
    }
  };
  for (std::size_t k = 0; k < dimension_; ++k) {
    for_each_of(k, [&](std::size_t, double x) { axis[k] += x; });
    axis_sq += axis[k] * axis[k];
  }
  const double per_length = axis_sq > 0.0 ? 1.0 / std::sqrt(axis_sq) : 0.0;
  for (std::size_t k = 0; k < dimension_; ++k) {
    axis[k] *= per_length;
    cones.axes[k * cones.stride + cone] = static_cast<float>(axis[k]);
    const double entry = axis[k];
    for_each_of(k, [&](std::size_t i, double x) {
      along[i] += x * entry;
      length_sq[i] += x * x;
    });
  }
  double cosine = 1.0, reach_sq = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    reach_sq = std::max(reach_sq, length_sq[i]);
    if (length_sq[i] > 0.0) cosine = std::min(cosine, along[i] / std::sqrt(length_sq[i]));
  }
  const double angle = std::min(std::acos(std::clamp(cosine, -1.0, 1.0)) + kTurn, M_PI);
  cones.reaches[cone] = static_cast<float>(std::sqrt(reach_sq)) * (1.0f + 0x1p-20f) + 0x1p-40f;
  cones.cosines[cone] = static_cast<float>(std::cos(angle));
  cones.sines[cone] = static_cast<float>(std::sin(angle));
}

void find_furthest(const PointTree& tree, std::span<const double> normals,
                   std::span<FurthestPoint> furthest) {
  constexpr std::size_t kDirectionsAtATime = 64;
  for_each_block(furthest.size(), kDirectionsAtATime, [&](std::size_t begin, std::size_t end) {
    HWY_DYNAMIC_DISPATCH(find_furthest_any)
    (tree, normals.subspan(begin * tree.dimension(), (end - begin) * tree.dimension()),
     furthest.subspan(begin, end - begin));
  });
}

}  // namespace ndhull
#endif
