#include "approx/reduction/point_reduction.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "approx/reduction/direction_extremes.h"
#include "approx/reduction/furthest_outside.h"
#include "approx/reduction/inner_ellipsoid.h"
#include "approx/reduction/row_bits.h"
#include "approx/reduction/sample_hull.h"
#include "approx/reduction/shard_overview.h"
#include "core/complex/membership.h"
#include "core/dimension_switch.h"
#include "core/frame.h"
#include "core/growth/growth.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Points in the sample that the first hull is grown from; and how many directions, for each dimension, to
/// take the extremes of among the part of the points that are furthest out.
constexpr std::size_t kLeastSample = 1 << 12, kMostSample = 1 << 14, kPointsForASample = 256;
constexpr std::size_t kDirections = 256, kFurthestPart = 128;
/// And in the one that tells whether that is worth it.
constexpr std::size_t kFirstSample = 2048;
/// Points that are located at a time: what membership takes for one block.
constexpr std::size_t kLocatedAtATime = 512;
/// Passes at most, simplices at most, and points for each simplex that make a hull of so many worth growing.
constexpr int kPasses = 4;
constexpr std::size_t kMostRows = 250'000, kPointsForARow = 16;
/// How many times more simplices each further pass has: the first one does most of the work.
constexpr std::size_t kMoreRows = 2;
/// As few points left are no burden.
constexpr std::size_t kFewPoints = 20'000;

double length_sq_of(const double* y, std::size_t rank) { return std::inner_product(y, y + rank, y, 0.0); }

class Reduction {
 public:
  Reduction(const PointShards& shards, std::uint64_t seed) : shards_(shards), blocks_(blocks_of(shards)) {
    work_.options.seed = seed;
    for (const PointShard& part : shards.parts) candidates_.emplace_back(part.points.rows);
  }

  PointsToKeep run(const std::function<bool()>& is_late) {
    if (!find_frame()) return {all_candidates(), {}};
    ranges_ = find_column_ranges(shards_, blocks_);
    if (!ranges_) return {all_candidates(), {}};
    start();
    const std::size_t most_rows = std::min(kMostRows, shards_.rows / kPointsForARow);
    std::size_t left = shards_.rows, rows = most_rows / kMoreRows;
    for (int pass = 0; pass < kPasses; ++pass) {
      work_.options.pause_rows = rows;
      pass == 0 ? grow_first(rows) : static_cast<void>(grow(work_));
      if (pass == 0 && !drops_many()) return {rows_of(shards_), {}};
      const std::size_t before = left;
      left = drop_inside();
      const bool pays = left > kFewPoints && (pass == 0 || left < before - before / 8);
      rows = std::min(most_rows, kMoreRows * rows);
      if (!pays || rows <= work_.complex.row_count || shards_.any(is_late())) break;
      add_named();
    }
    if (!is_to_go_on()) return {all_candidates(), {}};
    for (const PointId id : frame_.simplex) put_back(rows_[id.value]);
    return {all_candidates(), take_begun()};
  }

 private:
  /// The first hull. While one thread grows it another one drops what is inside a part of it, as far as it
  /// comes: that is inside the whole as well. Where a file need not stay in memory it is read no more than it
  /// has to be.
  void grow_first(std::size_t rows) {
    constexpr std::size_t kPart = 8;
    work_.options.pause_rows = rows / kPart;
    grow(work_);
    work_.options.pause_rows = rows;
    const bool is_read_again =
        std::any_of(shards_.parts.begin(), shards_.parts.end(),
                    [](const PointShard& part) { return part.points.is_file_mapping; });
    if (!has_more_threads() || is_read_again) {
      grow(work_);
      return;
    }
    InnerEllipsoid early = ellipsoid_;
    early.fit(work_.complex);
    std::atomic<bool> is_grown = false;
    for_each_block(2, 1, [&](std::size_t task, std::size_t) {
      if (task == 0) {
        run_alone([&](std::size_t, std::size_t) { grow(work_); });
        is_grown = true;
        return;
      }
      for (std::size_t i = 0; i < blocks_.size() && !is_grown; ++i) {
        const ShardBlock& block = blocks_[i];
        early.drop_inside(shards_.parts[block.part].points, block.begin, block.end, candidates_[block.part]);
      }
    });
  }

  /// Is the hull general, and well shaped also beside points that the sample has not?
  bool is_to_go_on() const {
    constexpr double kWellShaped = 1000.0;  // as for any frame (core/frame.cpp)
    return work_.shifted_points.empty() && work_.counters.set_aside == 0 &&
           reach_of_kept() <= kWellShaped * ball_.inner_radius;
  }

  void put_back(std::size_t row) {
    for (std::size_t part = 0; part < candidates_.size(); ++part) {
      const PointShard& shard = shards_.parts[part];
      if (row >= shard.first_row && row - shard.first_row < shard.points.rows)
        candidates_[part].put_back(row - shard.first_row);
    }
  }

  BegunHull take_begun() {
    ball_.reach = reach_of_kept();
    frame_.column_min = ranges_->low;
    frame_.column_max = ranges_->high;
    return {std::move(frame_), ball_, take_grown(work_), std::move(rows_)};
  }

  std::vector<std::uint32_t> all_candidates() const {
    std::vector<std::uint32_t> ids;
    for (std::size_t part = 0; part < candidates_.size(); ++part) {
      const PointShard& shard = shards_.parts[part];
      candidates_[part].for_each(0, shard.points.rows, [&](std::size_t row) {
        ids.push_back(static_cast<std::uint32_t>(shard.first_row + row));
      });
    }
    return ids;
  }

  /// The sample and its frame; false when it spans less than all dimensions, or when most points are
  /// vertices.
  bool find_frame() {
    const std::size_t dimension = shards_.dimension;
    if (dimension < 2 || dimension > kMaxRank) return false;
    const std::vector<double> first = take_sample(shards_, kFirstSample).rows;
    sample_ = take_sample(shards_, std::clamp(shards_.rows / kPointsForASample, kLeastSample, kMostSample));
    for (std::size_t i = 0; i < sample().rows; ++i)
      rows_.push_back(static_cast<std::uint32_t>(i * sample_.step));
    const auto is_finite = [](double x) { return std::isfinite(x); };
    if (!std::all_of(first.begin(), first.end(), is_finite)) return false;
    if (!std::all_of(sample_.rows.begin(), sample_.rows.end(), is_finite)) return false;
    bool is_held = false;
    const PointView first_view = PointView::row_major(first.data(), first.size() / dimension, dimension);
    const auto hold = [&] { is_held = holds_some_of(first_view, work_.options.seed); };
    const auto fit = [&] { frame_ = fit_frame(sample()); };
    if (has_more_threads()) {  // the frame may be found for nothing
      for_each_block(2, 1, [&](std::size_t task, std::size_t) { task == 0 ? hold() : fit(); });
    } else {
      hold();
      if (is_held) fit();
    }
    return is_held && frame_.rank == dimension;
  }

  PointView sample() const {
    return PointView::row_major(sample_.rows.data(), sample_.rows.size() / shards_.dimension,
                                shards_.dimension);
  }

  /// The first simplex, of the sample and the points that are furthest along some directions.
  void start() {
    const std::size_t dimension = shards_.dimension;
    work_.rank = dimension;
    append(sample());
    sample_size_ = work_.point_count;
    shape_ = SampleShape(frame_, coordinates_.data(), sample_size_);
    const RowList extremes = find_direction_extremes(shards_, shape_, length_of_furthest(),
                                                     kDirections * dimension, work_.options.seed);
    append(PointView::row_major(extremes.rows.data(), extremes.ids.size(), dimension));
    rows_.insert(rows_.end(), extremes.ids.begin(), extremes.ids.end());
    ball_ = find_ball(dimension, coordinates_.data(), work_.point_count, frame_.simplex);
    const double reach = reach_of_all();
    ball_.reach = std::max(ball_.reach, reach);
    ellipsoid_ = InnerEllipsoid(shape_, reach);
    work_.options.in_regions = true;
    start_growth(work_, frame_.simplex, FirstPoints());
  }

  /// Appends points to those that the hull is grown from.
  void append(const PointView& points) {
    const std::size_t first = work_.point_count, dimension = shards_.dimension;
    coordinates_.resize((first + points.rows) * dimension + kPadding);
    map_points(points, frame_, coordinates_.data() + first * dimension);
    work_.point_count = first + points.rows;
    work_.points = coordinates_.data();
  }

  /// |z| of the part of the sample that is furthest out: the least.
  double length_of_furthest() const {
    std::vector<double> lengths(sample_size_ + kWhitenedPoints), z(work_.rank * kWhitenedPoints);
    std::vector<std::size_t> rows;
    for (std::size_t first = 0; first < sample_size_; first += kWhitenedPoints) {
      rows.resize(std::min(kWhitenedPoints, sample_size_ - first));
      std::iota(rows.begin(), rows.end(), first);
      shape_.whiten(sample(), rows, z.data(), lengths.data() + first);
    }
    lengths.resize(sample_size_);
    const auto at =
        lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() - lengths.size() / kFurthestPart);
    if (at == lengths.end()) return 0.0;
    std::nth_element(lengths.begin(), at, lengths.end());
    return std::sqrt(*at);
  }

  /// No point is longer than this in the frame, nor is the sum of the sizes of its terms.
  double reach_of_all() const {
    double length_sq = 0.0;
    for (std::size_t row = 0; row < frame_.rank; ++row) {
      double most = 0.0;
      for (std::size_t k = 0; k < frame_.dimension; ++k) {
        const double largest = std::max(std::abs(ranges_->low[k] - frame_.centre[k]),
                                        std::abs(ranges_->high[k] - frame_.centre[k]));
        most += std::abs(frame_.map[row * frame_.dimension + k]) * largest;
      }
      length_sq += most * most;
    }
    return std::sqrt(length_sq) * (1.0 + 1e-14);
  }

  /// The longest of those that are left and of the hull's points, which all others are within the hull of.
  double reach_of_kept() const {
    double longest_sq = longest_left_ * longest_left_;
    for (std::size_t point = 0; point < work_.point_count; ++point)
      longest_sq = std::max(longest_sq, length_sq_of(coordinates_.data() + point * work_.rank, work_.rank));
    return std::sqrt(longest_sq) * (1.0 + 1e-14);
  }

  /// Is a part of the sample inside that makes a pass over all points worth its time?
  bool drops_many() const {
    constexpr std::size_t kLookedAt = 512, kWorthAPass = 8;  // one of so many
    const std::size_t step = std::max<std::size_t>(1, sample_size_ / kLookedAt);
    std::vector<PointId> ids;
    for (std::size_t row = 0; row < sample_size_; row += step)
      ids.push_back(PointId{static_cast<std::uint32_t>(row)});
    const std::vector<LocatedPoint> located = try_inside(work_.complex, coordinates_.data(), ball_, ids);
    const auto inside =
        static_cast<std::size_t>(std::count_if(located.begin(), located.end(), [](const LocatedPoint& point) {
          return point.gauge < -kWellInside;
        }));
    return inside * kWorthAPass >= ids.size();
  }

  /// Drops the candidates that are inside the hull; returns how many are left, in all processes.
  std::size_t drop_inside() {
    std::vector<LeftInBlock> left(blocks_.size());
    std::vector<std::vector<OutsidePoint>> named(blocks_.size());
    ellipsoid_.fit(work_.complex);
    for_each_shard_block(shards_, blocks_, [&](std::size_t index, const ShardBlock& block) {
      left[index] = drop_inside_block(block, named[index]);
    });
    named_.clear();
    for (const std::vector<OutsidePoint>& points : named)
      named_.insert(named_.end(), points.begin(), points.end());
    keep_furthest(named_);
    std::vector<double> said(2, 0.0);
    for (const LeftInBlock& block : left) {
      said[0] += static_cast<double>(block.count);
      said[1] = std::max(said[1], block.longest_sq);
    }
    said = shards_.all_gather(std::move(said));
    double all = 0.0;
    longest_left_ = 0.0;
    for (std::size_t at = 0; at < said.size(); at += 2) {
      all += said[at];
      longest_left_ = std::max(longest_left_, std::sqrt(said[at + 1]));
    }
    return static_cast<std::size_t>(all);
  }

  struct LeftInBlock {
    std::size_t count = 0;
    double longest_sq = 0.0;  // of their lengths in the frame
  };

  LeftInBlock drop_inside_block(const ShardBlock& block, std::vector<OutsidePoint>& named) {
    const std::size_t dimension = shards_.dimension;
    const PointShard& part = shards_.parts[block.part];
    RowBits& candidates = candidates_[block.part];
    std::vector<double> rows(kLocatedAtATime * dimension), mapped(kLocatedAtATime * dimension + kPadding);
    std::vector<std::size_t> ids;
    std::vector<LocatedPoint> located;
    LeftInBlock left;
    const auto locate = [&] {
      located.resize(ids.size());
      map_points(PointView::row_major(rows.data(), ids.size(), dimension), frame_, mapped.data());
      try_inside(work_.complex, coordinates_.data(), ball_, mapped.data(), located);
      for (std::size_t i = 0; i < ids.size(); ++i) {
        if (located[i].gauge < -kWellInside) {
          candidates.drop(ids[i]);
          continue;
        }
        ++left.count;
        left.longest_sq = std::max(left.longest_sq, length_sq_of(mapped.data() + i * dimension, dimension));
        const auto id = static_cast<std::uint32_t>(part.first_row + ids[i]);
        if (std::isfinite(located[i].gauge)) named.push_back({located[i].gauge, id, located[i].simplex});
      }
      ids.clear();
    };
    ellipsoid_.drop_inside(part.points, block.begin, block.end, candidates);
    candidates.for_each(block.begin, block.end, [&](std::size_t row) {
      part.points.copy_row(row, rows.data() + ids.size() * dimension);
      ids.push_back(row);
      if (ids.size() == kLocatedAtATime) locate();
    });
    if (!ids.empty()) locate();
    keep_furthest(named);
    return left;
  }

  /// Puts the points that were named into the outside sets of the hull that they were located in.
  void add_named() {
    const std::size_t dimension = shards_.dimension, entry = 3 + dimension;
    std::sort(named_.begin(), named_.end(),
              [](const OutsidePoint& a, const OutsidePoint& b) { return a.id < b.id; });
    std::vector<double> said;
    RowCopier copier(shards_);
    for (const OutsidePoint& point : named_) {
      said.insert(said.end(),
                  {point.gauge, static_cast<double>(point.id), static_cast<double>(point.simplex.value)});
      said.resize(said.size() + dimension);
      copier.copy(point.id, said.data() + said.size() - dimension);
    }
    said = shards_.all_gather(std::move(said));
    named_.clear();
    for (std::size_t at = 0; at < said.size(); at += entry) {
      named_.push_back({said[at], static_cast<std::uint32_t>(said[at + 1]),
                        SimplexId{static_cast<std::uint32_t>(said[at + 2])}});
    }
    std::vector<OutsidePoint> chosen = named_;
    keep_furthest(chosen);
    std::sort(chosen.begin(), chosen.end(),
              [](const OutsidePoint& a, const OutsidePoint& b) { return a.id < b.id; });
    std::vector<double> rows;
    for (std::size_t i = 0, used = 0; i < named_.size() && used < chosen.size(); ++i) {
      if (named_[i].id != chosen[used].id) continue;
      rows.insert(rows.end(), said.data() + i * entry + 3, said.data() + (i + 1) * entry);
      ++used;
    }
    const std::size_t first = work_.point_count;
    append(PointView::row_major(rows.data(), chosen.size(), dimension));
    for (const OutsidePoint& point : chosen) rows_.push_back(point.id);
    work_.next_outside.resize(work_.point_count, 0);
    work_.heights.extend(work_.point_count);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const double* plane = work_.complex.plane(chosen[i].simplex).data();
      double gauge = -1.0;
      for (std::size_t k = 0; k < dimension; ++k)
        gauge += plane[k] * coordinates_[(first + i) * dimension + k];
      if (gauge <= 2.0 * work_.options.shift) continue;
      push_outside(work_, static_cast<std::uint32_t>(first + i), chosen[i].simplex.value, gauge);
    }
  }

  static constexpr std::size_t kPadding = 8;  // vector loads may read behind the last point

  const PointShards& shards_;
  std::vector<ShardBlock> blocks_;
  std::vector<RowBits> candidates_;  // of each part
  std::optional<ColumnRanges> ranges_;
  RowSample sample_;
  Frame frame_;
  std::vector<std::uint32_t> rows_;  // of the points that the hull is grown from
  std::vector<double> coordinates_;  // of these, in the frame
  std::size_t sample_size_ = 0;      // of these, the first
  HullBall ball_;
  SampleShape shape_;
  InnerEllipsoid ellipsoid_;
  GrowthWork work_;
  std::vector<OutsidePoint> named_;
  double longest_left_ = 0.0;  // in the frame
};

}  // namespace

PointsToKeep find_points_to_keep(const PointShards& shards, std::uint64_t seed,
                                 const std::function<bool()>& is_late) {
  return Reduction(shards, seed).run(is_late);
}

}  // namespace ndhull
