// The points of simplices that are gone: each goes to a new simplex that it is above, or is inside. Included
// once per target by growth_kernels.cpp.

#if defined(NDHULL_PARTITION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_PARTITION_INL_H_
#undef NDHULL_PARTITION_INL_H_
#else
#define NDHULL_PARTITION_INL_H_
#endif

#include "core/growth/grower-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

// Hill climbing on the dual graph: a linear program whose vertices are the simplices. In a region it may halt
// at the border: then the gauge is NaN.
template <std::size_t D>
template <bool kInRegion>
std::uint32_t Grower<D>::locate(const double* y, std::uint32_t row, double& gauge) {
  double best = gauge_above<D>(plane(row), y);
  for (;;) {
    const std::uint32_t* around = neighbours(row);
    std::uint32_t best_row = row;
    for (std::size_t k = 0; k < D; ++k) {
      const double candidate = gauge_above<D>(plane(around[k]), y);
      if (candidate > best) {
        best = candidate;
        best_row = around[k];
      }
    }
    if (best_row == row) break;
    if (kInRegion && !is_in_region(plane(best_row))) {
      gauge = NAN;
      return row;
    }
    row = best_row;
  }
  gauge = best;
  return row;
}

// Frees the visible simplices begin .. end and lists those with points in their outside sets.
template <std::size_t D>
void Grower<D>::free_visible(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& with_points) {
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = begin; i < end; ++i) {
    if (i + kAhead < end) __builtin_prefetch(head_ + visible_[i + kAhead]);
    const std::uint32_t row = visible_[i];
    if (region_ == nullptr) state_[row] = SimplexState::kFree;
    books_.free_rows[books_.free_count + i] = row;
    if (head_[row] != 0) with_points.push_back(row);
  }
}

// The points of the simplices that are gone, a chunk at a time.
template <std::size_t D>
void Grower<D>::partition(std::uint32_t apex) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;  // bounds the memory that a first insertion needs
  const std::size_t parts = shares_loops() && visible_count_ >= kManyRidges ? team_->threads() : 1;
  const std::size_t size = (visible_count_ + parts - 1) / parts;
  if (emptied_.size() < parts) emptied_.resize(parts);
  for (std::vector<std::uint32_t>& rows : emptied_) rows.clear();
  const auto free_part = [&](std::size_t begin, std::size_t end) {
    free_visible(begin, end, emptied_[begin / size]);
  };
  if (parts > 1) {
    team_->for_each_block(visible_count_, size, free_part);
  } else {
    free_part(0, visible_count_);
  }
  books_.free_count += visible_count_;
  moved_.clear();
  for (const std::vector<std::uint32_t>& rows : emptied_) {
    for (const std::uint32_t row : rows) {
      std::uint32_t next = head_[row];
      head_[row] = 0;
      while (next != 0) {
        const std::uint32_t id = next - 1;
        next = work_.next_outside[id];
        --books_.points_outside;
        if (id == apex) {
          take_outside(id);
          continue;
        }
        moved_.push_back(id);
        if (moved_.size() == kChunk) place_moved();
      }
    }
  }
  place_moved();
}

template <std::size_t D>
void Grower<D>::list_gauges() {
  std::vector<std::uint32_t> outside;
  work_.heights.list_above(0.0, outside);
  work_.gauges.reset(work_.point_count);
  for (const std::uint32_t id : outside) {
    const std::uint32_t row = work_.heights.row(id);
    work_.gauges.put(id, row, gauge_above<D>(plane(row), point(id)));
  }
}

// Each point starts where the one before it ended; each block starts afresh.
template <std::size_t D>
void Grower<D>::place_moved() {
  constexpr std::size_t kPointsInBlock = 64, kManyPoints = 1024;
  const double least = least_height(work_);
  new_places_.resize(moved_.size());
  const auto place = [&](std::size_t begin, std::size_t end) {
    std::uint32_t start = new_rows_[0];
    for (std::size_t i = begin; i < end; ++i) {
      double gauge = 0.0;
      const double* y = point(moved_[i]);
      start = region_ ? locate<true>(y, start, gauge) : locate<false>(y, start, gauge);
      const std::uint32_t found = start;
      new_places_[i].row = kNoRow;
      if (std::isnan(gauge)) region_->halted.push_back({moved_[i], found});
      if (gauge <= 2.0 * work_.options.shift) continue;
      const double height = height_above(work_, found, gauge);
      if (height > least) new_places_[i] = {found, height, gauge};
    }
  };
  if (moved_.size() > kPointsInBlock && (team_ || (moved_.size() >= kManyPoints && has_team()))) {
    team_->for_each_block(moved_.size(), kPointsInBlock, place);
  } else {
    for (std::size_t begin = 0; begin < moved_.size(); begin += kPointsInBlock)
      place(begin, std::min(begin + kPointsInBlock, moved_.size()));
  }
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    if (new_places_[i].row != kNoRow) {
      put_outside(moved_[i], new_places_[i]);
    } else {
      take_outside(moved_[i]);
    }
  }
  moved_.clear();
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
