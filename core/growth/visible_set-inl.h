// The visible set of an apex and its horizon. Included once per target by growth_kernels.cpp.
//
// Breadth first, in batches that go through three stages: list the neighbours met for the first time and
// fetch their planes; test them, the batch before being tested while those planes are on their way; collect
// the horizon. Whether a neighbour is new, visible or hidden cannot be predicted, so no stage has a branch on
// it.

#if defined(NDHULL_VISIBLE_SET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_VISIBLE_SET_INL_H_
#undef NDHULL_VISIBLE_SET_INL_H_
#else
#define NDHULL_VISIBLE_SET_INL_H_
#endif

#include "core/growth/grower-inl.h"
#include "core/growth/row_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

/// Neighbours of one batch that were met for the first time.
template <std::size_t D>
struct FirstMet {
  // Visible simplices in a batch. Measured: more planes at once than caches can be waiting for hold up
  // everything else.
  static constexpr std::size_t kBatch = D <= 6 ? 16 : 4;
  std::uint32_t rows[kBatch * D];
  std::size_t count = 0;
};

/// Lists the neighbours of visible simplices begin .. end that were not met before, marks them as hidden
/// until they are tested, and fetches their planes.
template <std::size_t D>
HWY_INLINE void Grower<D>::list_first_met(std::uint8_t* marks, std::size_t begin, std::size_t end,
                                          FirstMet<D>& met) {
  const std::uint8_t hidden = hidden_mark_;
  const std::uint32_t* const topology = topology_;
  const std::uint32_t* const visible = visible_.data();
  std::size_t count = 0;
  if (D >= 8) {  // where marks are many
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t* around = topology + std::size_t{visible[i]} * 2 * D + D;
      for (std::size_t k = 0; k < D; ++k) __builtin_prefetch(marks + around[k]);
    }
  }
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint32_t* around = topology + std::size_t{visible[i]} * 2 * D + D;
    for (std::size_t k = 0; k < D; ++k) {
      const std::uint32_t neighbour = around[k];
      const std::uint8_t mark = marks[neighbour];
      met.rows[count] = neighbour;
      count += mark < hidden ? 1 : 0;
      marks[neighbour] = mark < hidden ? hidden : mark;
    }
  }
  met.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    const double* record = planes_ + std::size_t{met.rows[i]} * D;
    __builtin_prefetch(record);
    if (D > 8 || (D & (D - 1)) != 0) __builtin_prefetch(record + D - 1);
  }
}

/// Tests what was listed; the visible ones are appended in the order of the list.
template <std::size_t D>
template <bool kInRegion>
HWY_INLINE void Grower<D>::test_first_met(const double* apex, double threshold, std::uint8_t* marks,
                                          const FirstMet<D>& met, SearchResult& result) {
  const std::uint8_t hidden = hidden_mark_;
  const double* const planes = planes_;
  std::uint32_t* const visible = result.visible;
  double* const gauges = result.gauge;
  std::size_t count = result.visible_count;
  double lowest = result.lowest, highest = result.highest;
  bool is_cut = false;
  for (std::size_t i = 0; i < met.count; ++i) {
    const std::uint32_t row = met.rows[i];
    const double* const record = planes + std::size_t{row} * D;
    if (kInRegion) is_cut |= !is_in_region(record);
    const double gauge = gauge_above<D>(record, apex);
    const bool is_visible = gauge > threshold;
    visible[count] = row;
    gauges[count] = gauge;
    count += is_visible ? 1 : 0;
    marks[row] = is_visible ? visible_mark() : hidden;
    const double if_visible = is_visible ? gauge : HUGE_VAL, if_hidden = is_visible ? -HUGE_VAL : gauge;
    lowest = if_visible < lowest ? if_visible : lowest;
    highest = if_hidden > highest ? if_hidden : highest;
  }
  for (std::size_t i = result.visible_count; i < count; ++i) fetch_row<D>(topology_, visible[i]);
  result.visible_count = count;
  result.lowest = lowest;
  result.highest = highest;
  result.is_cut |= is_cut;
}

/// Appends the ridges of visible simplices begin .. end whose other side is hidden.
template <std::size_t D>
HWY_INLINE void Grower<D>::collect_horizon(const std::uint8_t* marks, std::size_t begin, std::size_t end,
                                           SearchResult& result) {
  const std::uint8_t hidden = hidden_mark_;
  const std::uint32_t* const topology = topology_;
  const std::uint32_t* const visible = visible_.data();
  HorizonRidge* const horizon = result.horizon;
  std::size_t count = result.horizon_count;
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint32_t* around = topology + std::size_t{visible[i]} * 2 * D + D;
    for (std::size_t k = 0; k < D; ++k) {
      const std::uint32_t neighbour = around[k];
      horizon[count] = {static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(k), 0, neighbour};
      count += marks[neighbour] == hidden ? 1 : 0;
    }
  }
  result.horizon_count = count;
}

/// Searches from the visible simplices begin .. end, or, when what is found is appended to the list itself,
/// until there are no more or so many that threads may share them. In a region it ends at the border. Returns
/// where it ended.
template <std::size_t D>
template <bool kInRegion>
std::size_t Grower<D>::search(const double* apex, double threshold, std::uint8_t* marks, std::size_t begin,
                              std::size_t end, SearchResult& result) {
  FirstMet<D> lists[2];
  std::size_t tested = begin, listed = begin, turn = 0;
  const bool is_open = result.visible == visible_.data();
  const std::size_t most = shares_.empty() || !is_shared_ ? SIZE_MAX : kManyVisible;
  for (;;) {
    std::size_t limit = end;
    if (is_open) limit = result.visible_count - listed < most ? result.visible_count : listed;
    if (tested == limit || (kInRegion && result.is_cut)) return tested;
    const std::size_t list_end = std::min(listed + FirstMet<D>::kBatch, limit);
    list_first_met(marks, listed, list_end, lists[turn]);
    turn ^= 1;
    test_first_met<kInRegion>(apex, threshold, marks, lists[turn], result);
    lists[turn].count = 0;
    collect_horizon(marks, tested, listed, result);
    tested = listed;
    listed = list_end;
  }
}

template <std::size_t D>
template <bool kInRegion>
void Grower<D>::find_visible(const double* apex_in, std::uint32_t seed, double threshold) {
  alignas(64) double apex[D];
  for (std::size_t k = 0; k < D; ++k) apex[k] = apex_in[k];
  next_marks();
  const double gauge = gauge_above<D>(plane(seed), apex);
  marks_[seed] = visible_mark();
  visible_[0] = seed;
  visible_gauge_[0] = gauge;
  visible_count_ = 1;
  horizon_count_ = 0;
  lowest_visible_ = gauge;
  highest_hidden_ = -HUGE_VAL;
  shared_visible_ = shared_horizon_ = 0;
  is_cut_ = false;
  for (std::size_t begin = 0; begin < visible_count_;) {
    if (is_shared_ && !shares_.empty() && visible_count_ - begin >= kManyVisible) {
      const std::size_t end = visible_count_;
      search_wave(apex, threshold, begin, end);
      begin = end;
    } else {
      SearchResult result{visible_.data(), visible_gauge_.data(), horizon_.data(), visible_count_,
                          horizon_count_,  lowest_visible_,       highest_hidden_, false};
      begin = search<kInRegion>(apex, threshold, marks_.data(), begin, 0, result);
      visible_count_ = result.visible_count;
      horizon_count_ = result.horizon_count;
      lowest_visible_ = result.lowest;
      highest_hidden_ = result.highest;
      is_cut_ = result.is_cut;
      if (is_cut_) return;
    }
  }
}

/// Makes marks of earlier searches old. When marks run out all are cleared; after a small search in a large
/// complex its own marks are, so that this costs little beside the searches. One that was cut has not listed
/// all that it marked.
template <std::size_t D>
void Grower<D>::next_marks() {
  constexpr unsigned kLastMark = 250, kMarksOfSearch = 3;
  const std::size_t marked = visible_count_ + horizon_count_;
  if (shared_visible_ == 0 && !is_cut_ && marked < books_.row_count / 512) {
    for (std::size_t i = 0; i < visible_count_; ++i) marks_[visible_[i]] = 0;
    for (std::size_t i = 0; i < horizon_count_; ++i) marks_[horizon_[i].hidden] = 0;
  } else if (hidden_mark_ + 2 * kMarksOfSearch > kLastMark) {
    std::fill_n(marks_.data(), books_.row_count, std::uint8_t{0});
    for (std::size_t s = 1; s < shares_.size(); ++s)
      std::fill_n(shares_[s].marks.data(), books_.row_count, std::uint8_t{0});
    hidden_mark_ = 1;
  } else {
    hidden_mark_ = static_cast<std::uint8_t>(hidden_mark_ + kMarksOfSearch);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
