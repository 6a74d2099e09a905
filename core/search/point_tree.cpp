#include "core/search/point_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

/// Puts neighbours together: splits in halves, each time along the column that is longest in a sample.
class NeighbourOrder {
 public:
  NeighbourOrder(std::size_t dimension, std::vector<float> points)
      : dimension_(dimension), points_(std::move(points)), places_(points_.size() / dimension) {}

  std::vector<std::uint32_t> run() {
    std::iota(places_.begin(), places_.end(), Place{0});
    split(places_);
    std::vector<std::uint32_t> order(places_.size());
    std::transform(places_.begin(), places_.end(), order.begin(), row_of);
    return order;
  }

 private:
  /// A row, and above it its coordinate as bits that are ordered as the numbers are: compared in one step.
  using Place = std::uint64_t;
  static std::uint32_t row_of(Place place) { return static_cast<std::uint32_t>(place); }
  static Place place_of(float key, std::uint32_t row) {
    const auto bits = std::bit_cast<std::uint32_t>(key);
    const std::uint32_t ordered = bits ^ ((bits >> 31) != 0 ? 0xFFFF'FFFFu : 0x8000'0000u);
    return Place{ordered} << 32 | row;
  }

  void split(std::span<Place> places) {
    constexpr std::size_t kInCluster = PointTree::kSize * PointTree::kSize, kWorthAThread = 1 << 13;
    if (places.size() <= PointTree::kSize) return;
    const std::size_t column = longest_column(places);
    for (Place& place : places) {
      const std::uint32_t row = row_of(place);
      place = place_of(points_[std::size_t{row} * dimension_ + column], row);
    }
    const std::size_t unit = places.size() > kInCluster ? kInCluster : PointTree::kSize;
    const std::size_t half = (places.size() + unit - 1) / unit / 2 * unit;
    select(places, half);
    const auto low = places.first(half), high = places.subspan(half);
    if (places.size() < kWorthAThread) {
      split(low);
      split(high);
    } else {
      for_each_block(2, 1, [&](std::size_t side, std::size_t) { split(side == 0 ? low : high); });
    }
  }

  /// As std::nth_element; without a branch on what is compared, which cannot be foreseen.
  static void select(std::span<Place> places, std::size_t nth) {
    constexpr std::size_t kFew = 64, kSample = 15;
    while (places.size() > kFew) {
      std::array<Place, kSample> sample;
      for (std::size_t i = 0; i < kSample; ++i)
        sample[i] = places[(2 * i + 1) * places.size() / (2 * kSample)];
      std::sort(sample.begin(), sample.end());
      const Place pivot = sample[nth * kSample / places.size()];
      std::size_t below = 0;
      for (Place& place : places) {
        const Place moved = place;
        place = places[below];
        places[below] = moved;
        below += moved < pivot ? 1u : 0u;
      }
      if (nth < below) {
        places = places.first(below);
      } else {
        places = places.subspan(below);
        nth -= below;
      }
      if (below == 0) break;  // the pivot is the least of all: rare, and no progress
    }
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(nth), places.end());
  }

  std::size_t longest_column(std::span<const Place> places) const {
    constexpr std::size_t kSample = 32;
    const std::size_t step = std::max<std::size_t>(1, places.size() / kSample);
    std::size_t longest = 0;
    float longest_extent = -1.0f;
    for (std::size_t k = 0; k < dimension_; ++k) {
      float low = HUGE_VALF, high = -HUGE_VALF;
      for (std::size_t i = 0; i < places.size(); i += step) {
        const float x = points_[std::size_t{row_of(places[i])} * dimension_ + k];
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

/// Columns about as long as each other get the same size: points of a ball stay those of a ball.
void make_alike(std::span<double> sizes) {
  constexpr double kAlike = 0.5;
  std::vector<std::size_t> columns(sizes.size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  std::sort(columns.begin(), columns.end(),
            [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  double size = HUGE_VAL;
  for (const std::size_t k : columns) {
    if (!(sizes[k] >= kAlike * size)) size = sizes[k];
    sizes[k] = size;
  }
}

Enclosures make_enclosures(std::size_t dimension, std::size_t count) {
  constexpr float kNowhere = -0x1p100f;  // as a reach
  Enclosures level;
  level.count = count;
  level.stride = (count + PointTree::kSize - 1) / PointTree::kSize * PointTree::kSize;
  for (std::vector<float>* columns : {&level.axes, &level.centres, &level.half_sizes})
    columns->resize(level.stride * dimension);
  level.reaches.assign(level.stride, kNowhere);
  level.cosines.assign(level.stride, -2.0f);
  level.sines.assign(level.stride, 0.0f);
  return level;
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

std::vector<std::uint32_t> PointTree::place_of_rows() const {
  std::vector<std::uint32_t> place_of(order_.size());
  for (std::uint32_t place = 0; place < place_of.size(); ++place) place_of[order_[place]] = place;
  return place_of;
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
    // Not less than a part of what doubles round off from far away.
    constexpr double kFurthest = 16.0, kLeast = 0x1p-1000;
    const double largest = std::max(std::abs(low[k]), std::abs(high[k])), half = 0.5 * high[k] - 0.5 * low[k];
    if (largest > 0.0) column_sizes_[k] = std::max({half, largest / kFurthest, kLeast});
  }
  make_alike(column_sizes_);
  for (std::size_t k = 0; k < dimension_; ++k)
    middle_[k] = 0.5 * (low[k] / column_sizes_[k]) + 0.5 * (high[k] / column_sizes_[k]);
}

void PointTree::fill(std::span<const double> points) {
  const std::size_t group_count = (order_.size() + kSize - 1) / kSize;
  groups_ = make_enclosures(dimension_, group_count);
  clusters_ = make_enclosures(dimension_, (group_count + kSize - 1) / kSize);
  points_.resize(order_.size() * dimension_);
  scaled_rows_.resize(group_count * dimension_ * kSize);
  std::vector<double> per_size(dimension_);
  for (std::size_t k = 0; k < dimension_; ++k) per_size[k] = 1.0 / column_sizes_[k];
  constexpr std::size_t kClustersAtATime = 4;
  for_each_block(clusters_.count, kClustersAtATime, [&](std::size_t first, std::size_t last) {
    for (std::size_t cluster = first; cluster < last; ++cluster) {
      const std::size_t begin = cluster * kSize, end = std::min(begin + kSize, group_count);
      for (std::size_t group = begin; group < end; ++group) {
        for (std::size_t i = 0; i < kSize; ++i) {
          const std::size_t place = std::min(group * kSize + i, order_.size() - 1);
          const std::size_t ahead = std::min(place + kSize, order_.size() - 1);
          prefetch(points.data() + std::size_t{order_[ahead]} * dimension_);
          const double* from = points.data() + std::size_t{order_[place]} * dimension_;
          double* const copy = points_.data() + place * dimension_;
          float* const scaled = scaled_rows_.data() + group * dimension_ * kSize + i;
          for (std::size_t k = 0; k < dimension_; ++k) {
            copy[k] = from[k];
            scaled[k * kSize] = static_cast<float>(from[k] * per_size[k] - middle_[k]);
          }
        }
        enclose(group, group + 1, groups_, group);
      }
      enclose(begin, end, clusters_, cluster);
    }
  });
  for (std::size_t i = 0; i < clusters_.count; ++i) {
    double corner_sq = 0.0;
    for (std::size_t k = 0; k < dimension_; ++k) {
      const std::size_t at = k * clusters_.stride + i;
      const double furthest = std::abs(double{clusters_.centres[at]}) + clusters_.half_sizes[at];
      corner_sq += furthest * furthest;
    }
    point_reach_ = std::max(point_reach_, double{clusters_.reaches[i]});
    reach_ = std::max({reach_, point_reach_, std::sqrt(corner_sq)});
  }
}

// The cone's axis goes through the mean of the points, seen from the middle of all.
void PointTree::enclose(std::size_t first_group, std::size_t last_group, Enclosures& level, std::size_t at) {
  constexpr std::size_t kMostPoints = kSize * kSize;
  // A cone's angle is wider than its points need by this, and at least this: then the root of 1 - cosine^2 in
  // single precision turns a direction by less. [radian]
  constexpr double kTurn = 2e-3;
  // Of the least that is reached, for what is left of a threshold when a middle far away is taken off.
  constexpr float kSpare = 0x1p-40f;
  double along[kMostPoints] = {}, length_sq[kMostPoints] = {};
  const std::size_t count = (last_group - first_group) * kSize;
  std::vector<double> axis(dimension_);
  double axis_sq = 0.0;
  const auto for_each_of = [&](std::size_t k, const auto& call) {
    for (std::size_t group = first_group; group < last_group; ++group) {
      const float* row = scaled_rows(group, k);
      for (std::size_t i = 0; i < kSize; ++i) call((group - first_group) * kSize + i, double{row[i]});
    }
  };
  for (std::size_t k = 0; k < dimension_; ++k) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for_each_of(k, [&](std::size_t, double x) {
      axis[k] += x;
      low = std::min(low, x);
      high = std::max(high, x);
    });
    const auto centre = static_cast<float>(0.5 * low + 0.5 * high);
    const double half = std::max(high - double{centre}, double{centre} - low);
    level.centres[k * level.stride + at] = centre;
    level.half_sizes[k * level.stride + at] = std::nextafter(static_cast<float>(half), HUGE_VALF) + kSpare;
    axis_sq += axis[k] * axis[k];
  }
  const double per_length = axis_sq > 0.0 ? 1.0 / std::sqrt(axis_sq) : 0.0;
  for (std::size_t k = 0; k < dimension_; ++k) {
    axis[k] *= per_length;
    level.axes[k * level.stride + at] = static_cast<float>(axis[k]);
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
  level.reaches[at] = static_cast<float>(std::sqrt(reach_sq)) * (1.0f + 0x1p-20f) + kSpare;
  level.cosines[at] = static_cast<float>(std::cos(angle));
  level.sines[at] = static_cast<float>(std::sin(angle));
}

}  // namespace ndhull
