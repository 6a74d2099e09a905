#include "approx/point_reduction.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/blocks.h"
#include "core/dimension_switch.h"
#include "core/frame.h"
#include "core/growth.h"
#include "core/huge_array.h"
#include "core/membership.h"

namespace ndhull {
namespace {

/// Points in the sample that the first hull is grown from.
constexpr std::size_t kSample = 1 << 14;
/// Rows of the input that one thread takes at a time: 1 MB of 8-d single precision. A multiple of 64.
constexpr std::size_t kRowsInBlock = 1 << 15;
/// Points that are located at a time: what membership takes for one block.
constexpr std::size_t kLocatedAtATime = 512;
/// A point this far inside the hull is dropped. [ratio] As CertifiedGrowth has it.
constexpr double kWellInside = 1e-9;
/// Simplices of the first hull for each dimension; and how many times more in each further pass.
constexpr std::size_t kFirstRows = 64, kMoreRows = 8;
/// Passes at most, simplices at most, and points for each simplex that make a hull of so many worth growing.
constexpr int kPasses = 4;
constexpr std::size_t kMostRows = 250'000, kPointsForARow = 16;
/// As few points left are no burden.
constexpr std::size_t kFewPoints = 20'000;
/// Points outside that each block names for the next hull.
constexpr std::size_t kNamedByBlock = 16;

/// A point that is outside the hull, by at most this gauge, over this simplex.
struct OutsidePoint {
  double gauge;
  std::uint32_t id;
  SimplexId simplex;
  bool operator<(const OutsidePoint& other) const {  // the furthest first
    return gauge != other.gauge ? gauge > other.gauge : id < other.id;
  }
};

/// Copies single rows in ascending order, as doubles; of a mapped file what was passed goes back.
class RowCopier {
 public:
  explicit RowCopier(const PointView& points) : points_(points) {}
  RowCopier(const RowCopier&) = delete;
  RowCopier& operator=(const RowCopier&) = delete;
  ~RowCopier() { give_back_rows(points_, block_, std::min(block_ + kRowsInBlock, points_.rows)); }

  void copy(std::size_t row, double* out) {
    points_.copy_row(row, out);
    if (row < block_ + kRowsInBlock) return;
    give_back_rows(points_, block_, block_ + kRowsInBlock);
    block_ = row / kRowsInBlock * kRowsInBlock;
  }

 private:
  const PointView& points_;
  std::size_t block_ = 0;  // first row of the block that the last row is in
};

class Reduction {
 public:
  Reduction(const PointView& points, std::uint64_t seed) : points_(points) { work_.options.seed = seed; }

  std::vector<std::uint32_t> run(const std::function<bool()>& is_late) {
    candidates_.assign((points_.rows + 63) / 64, ~std::uint64_t{0});
    if (points_.rows % 64 != 0) candidates_.back() >>= 64 - points_.rows % 64;
    if (!find_ranges() || !start()) return all_candidates();
    std::size_t left = points_.rows, rows = kFirstRows * points_.dimension;
    for (int pass = 0; pass < kPasses; ++pass) {
      work_.options.pause_rows = rows;
      grow(work_);
      if (pass == 0 && !drops_many()) break;
      const std::size_t before = left;
      left = drop_inside();
      const bool pays = left > kFewPoints && (pass == 0 || left < before - before / 8);
      rows = std::min({kMostRows, kMoreRows * rows, points_.rows / kPointsForARow});
      if (!pays || rows <= work_.complex.row_count || is_late()) break;
      add_named();
    }
    return all_candidates();
  }

 private:
  std::vector<std::uint32_t> all_candidates() const {
    std::vector<std::uint32_t> ids;
    for (std::size_t word = 0; word < candidates_.size(); ++word) {
      for (std::uint64_t bits = candidates_[word]; bits != 0; bits &= bits - 1)
        ids.push_back(static_cast<std::uint32_t>(64 * word) +
                      static_cast<std::uint32_t>(std::countr_zero(bits)));
    }
    return ids;
  }

  /// Extent of each column over all points; false when one is not finite.
  bool find_ranges() {
    const std::size_t dimension = points_.dimension;
    const std::size_t blocks = (points_.rows + kRowsInBlock - 1) / kRowsInBlock;
    std::vector<double> lows(blocks * dimension, HUGE_VAL), highs(blocks * dimension, -HUGE_VAL);
    std::vector<std::uint8_t> is_finite(blocks, 1);
    for_each_block(points_.rows, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      const std::size_t block = begin / kRowsInBlock;
      for (std::size_t k = 0; k < dimension; ++k) {
        double low = HUGE_VAL, high = -HUGE_VAL, sum = 0.0;
        for (std::size_t row = begin; row < end; ++row) {
          const double x = points_.at(row, k);
          low = std::min(low, x);
          high = std::max(high, x);
          sum += 0.0 * x;  // NaN where x is not finite
        }
        lows[block * dimension + k] = low;
        highs[block * dimension + k] = high;
        if (sum != 0.0) is_finite[block] = 0;
      }
      give_back_rows(points_, begin, end);
    });
    low_.assign(dimension, HUGE_VAL);
    high_.assign(dimension, -HUGE_VAL);
    for (std::size_t i = 0; i < lows.size(); ++i) {
      low_[i % dimension] = std::min(low_[i % dimension], lows[i]);
      high_[i % dimension] = std::max(high_[i % dimension], highs[i]);
    }
    return std::count(is_finite.begin(), is_finite.end(), 0) == 0;
  }

  /// The frame and the first simplex, of a sample; false when it spans less than all dimensions.
  bool start() {
    const std::size_t dimension = points_.dimension, step = std::max<std::size_t>(1, points_.rows / kSample);
    std::vector<double> sample;
    {
      RowCopier copier(points_);
      for (std::size_t row = 0; row < points_.rows; row += step) {
        sample.resize(sample.size() + dimension);
        copier.copy(row, sample.data() + sample.size() - dimension);
      }
    }
    const PointView view = PointView::row_major(sample.data(), sample.size() / dimension, dimension);
    frame_ = fit_frame(view);
    if (frame_.rank < dimension || dimension < 2 || dimension > kMaxRank) return false;
    coordinates_.resize(sample.size() + kPadding);
    map_points(view, frame_, coordinates_.data());
    ball_ = find_ball(dimension, coordinates_.data(), view.rows, frame_.simplex);
    ball_.reach = std::max(ball_.reach, reach_of_all());
    work_.rank = dimension;
    work_.point_count = view.rows;
    work_.points = coordinates_.data();
    start_growth(work_, frame_.simplex);
    return true;
  }

  /// No point is longer than this in the frame.
  double reach_of_all() const {
    double length_sq = 0.0;
    for (std::size_t row = 0; row < frame_.rank; ++row) {
      double most = 0.0;
      for (std::size_t k = 0; k < frame_.dimension; ++k) {
        const double largest =
            std::max(std::abs(low_[k] - frame_.centre[k]), std::abs(high_[k] - frame_.centre[k]));
        most += std::abs(frame_.map[row * frame_.dimension + k]) * largest;
      }
      length_sq += most * most;
    }
    return std::sqrt(length_sq) * (1.0 + 1e-14);
  }

  /// Is a part of the sample inside that makes a pass over all points worth its time?
  bool drops_many() const {
    constexpr std::size_t kLookedAt = 512, kWorthAPass = 8;  // one of so many
    const std::size_t step = std::max<std::size_t>(1, work_.point_count / kLookedAt);
    std::vector<PointId> ids;
    for (std::size_t row = 0; row < work_.point_count; row += step)
      ids.push_back(PointId{static_cast<std::uint32_t>(row)});
    const std::vector<LocatedPoint> located = try_inside(work_.complex, coordinates_.data(), ball_, ids);
    const auto inside =
        static_cast<std::size_t>(std::count_if(located.begin(), located.end(), [](const LocatedPoint& point) {
          return point.gauge < -kWellInside;
        }));
    return inside * kWorthAPass >= ids.size();
  }

  /// Drops the candidates that are inside the hull; returns how many are left.
  std::size_t drop_inside() {
    const std::size_t blocks = (points_.rows + kRowsInBlock - 1) / kRowsInBlock;
    std::vector<std::size_t> left(blocks, 0);
    named_.assign(blocks, {});
    for_each_block(points_.rows, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      const std::size_t block = begin / kRowsInBlock;
      left[block] = drop_inside_block(begin, end, named_[block]);
      give_back_rows(points_, begin, end);
    });
    return std::accumulate(left.begin(), left.end(), std::size_t{0});
  }

  std::size_t drop_inside_block(std::size_t begin, std::size_t end, std::vector<OutsidePoint>& named) {
    const std::size_t dimension = points_.dimension;
    std::vector<double> rows(kLocatedAtATime * dimension), mapped(kLocatedAtATime * dimension + kPadding);
    std::vector<std::uint32_t> ids;
    std::vector<LocatedPoint> located;
    std::size_t left = 0;
    const auto locate = [&] {
      located.resize(ids.size());
      map_points(PointView::row_major(rows.data(), ids.size(), dimension), frame_, mapped.data());
      try_inside(work_.complex, coordinates_.data(), ball_, mapped.data(), located);
      for (std::size_t i = 0; i < ids.size(); ++i) {
        if (located[i].gauge < -kWellInside) {
          candidates_[ids[i] / 64] &= ~(std::uint64_t{1} << (ids[i] % 64));
          continue;
        }
        ++left;
        if (std::isfinite(located[i].gauge)) named.push_back({located[i].gauge, ids[i], located[i].simplex});
      }
      keep_furthest(named);
      ids.clear();
    };
    for (std::size_t word = begin / 64; word < (end + 63) / 64; ++word) {
      for (std::uint64_t bits = candidates_[word]; bits != 0; bits &= bits - 1) {
        const auto id =
            static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(bits));
        points_.copy_row(id, rows.data() + ids.size() * dimension);
        ids.push_back(id);
        if (ids.size() == kLocatedAtATime) locate();
      }
    }
    if (!ids.empty()) locate();
    return left;
  }

  /// The furthest few, one a simplex.
  static void keep_furthest(std::vector<OutsidePoint>& points) {
    std::sort(points.begin(), points.end());
    std::size_t used = 0;
    for (std::size_t i = 0; i < points.size() && used < kNamedByBlock; ++i) {
      const bool is_new =
          std::none_of(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(used),
                       [&](const OutsidePoint& point) { return point.simplex == points[i].simplex; });
      if (is_new) points[used++] = points[i];
    }
    points.resize(used);
  }

  /// Puts the points that the blocks named into the outside sets of the hull that they were located in.
  void add_named() {
    const std::size_t dimension = points_.dimension;
    std::vector<double> rows;
    std::vector<SimplexId> simplices;
    RowCopier copier(points_);
    for (const std::vector<OutsidePoint>& block : named_) {
      for (const OutsidePoint& point : block) {
        rows.resize(rows.size() + dimension);
        copier.copy(point.id, rows.data() + rows.size() - dimension);
        simplices.push_back(point.simplex);
      }
    }
    const std::size_t first = work_.point_count, count = simplices.size();
    coordinates_.resize((first + count) * dimension + kPadding);
    map_points(PointView::row_major(rows.data(), count, dimension), frame_,
               coordinates_.data() + first * dimension);
    work_.point_count = first + count;
    work_.points = coordinates_.data();
    work_.next_outside.resize(work_.point_count, 0);
    work_.height.resize(work_.point_count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      const double* plane = work_.complex.plane(simplices[i]).data();
      double gauge = -1.0;
      for (std::size_t k = 0; k < dimension; ++k)
        gauge += plane[k] * coordinates_[(first + i) * dimension + k];
      if (gauge <= 2.0 * work_.options.shift) continue;
      push_outside(work_, static_cast<std::uint32_t>(first + i), simplices[i].value, gauge);
    }
  }

  static constexpr std::size_t kPadding = 8;  // vector loads may read behind the last point

  const PointView& points_;
  std::vector<std::uint64_t> candidates_;  // a bit a point
  std::vector<double> low_, high_;         // of each column
  Frame frame_;
  std::vector<double> coordinates_;  // of the points that the hull is grown from
  HullBall ball_;
  GrowthWork work_;
  std::vector<std::vector<OutsidePoint>> named_;  // by each block
};

template <class Scalar>
void copy_rows(const PointView& points, const std::vector<std::uint32_t>& ids, std::vector<Scalar>& out) {
  out.resize(ids.size() * points.dimension);
  std::vector<double> row(points.dimension);
  RowCopier copier(points);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    copier.copy(ids[i], row.data());
    for (std::size_t k = 0; k < points.dimension; ++k)
      out[i * points.dimension + k] = static_cast<Scalar>(row[k]);
  }
}

}  // namespace

// Systems map 2 MiB of a file at once where they can: whatever is read next to what was given back would
// bring it all again. So whole such parts go, also those that another thread is reading: its pages come
// again.
void give_back_rows(const PointView& points, std::size_t begin, std::size_t end) {
  if (!points.is_file_mapping || begin >= end) return;
  constexpr std::uintptr_t kMappedAtOnce = std::uintptr_t{1} << 21;
  const std::size_t size = points.type == ScalarType::kFloat32 ? sizeof(float) : sizeof(double);
  const std::size_t columns = points.column_stride == 1 ? 1 : points.dimension;
  const auto data = reinterpret_cast<std::uintptr_t>(points.data);
  const std::uintptr_t data_end = data + points.rows * points.dimension * size;
  for (std::size_t column = 0; column < columns; ++column) {
    const std::uintptr_t at = data + column * points.column_stride * size;
    const std::uintptr_t first = (at + begin * points.row_stride * size) / kMappedAtOnce * kMappedAtOnce;
    const std::uintptr_t last =
        (at + end * points.row_stride * size + kMappedAtOnce - 1) / kMappedAtOnce * kMappedAtOnce;
    discard_pages(reinterpret_cast<void*>(std::max(first, data)),
                  reinterpret_cast<void*>(std::min(last, data_end)));
  }
}

ReducedPoints::ReducedPoints(const PointView& points, std::vector<std::uint32_t> ids)
    : dimension_(points.dimension), ids_(std::move(ids)) {
  if (points.type == ScalarType::kFloat32) {
    copy_rows(points, ids_, floats_);
  } else {
    copy_rows(points, ids_, doubles_);
  }
}

PointView ReducedPoints::view() const {
  return floats_.empty() ? PointView::row_major(doubles_.data(), ids_.size(), dimension_)
                         : PointView::row_major(floats_.data(), ids_.size(), dimension_);
}

std::uint64_t ReducedPoints::bytes() const {
  return doubles_.size() * sizeof(double) + floats_.size() * sizeof(float) +
         ids_.size() * sizeof(std::uint32_t);
}

std::vector<std::uint32_t> find_points_to_keep(const PointView& points, std::uint64_t seed,
                                               const std::function<bool()>& is_late) {
  return Reduction(points, seed).run(is_late);
}

}  // namespace ndhull
