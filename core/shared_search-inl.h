// The visible set where it is large: several threads search from the same wave. Included once per target by
// growth_kernels.cpp.
//
// A wave is the visible simplices that the wave before found. Each share takes a part of it and searches with
// marks of its own, so no thread waits for what another one has just written. What two shares find belongs to
// the lower one: put together in the order of the shares, the finds are those of one thread, in its order.
// Then each share marks what the others found.

#if defined(NDHULL_SHARED_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_SHARED_SEARCH_INL_H_
#undef NDHULL_SHARED_SEARCH_INL_H_
#else
#define NDHULL_SHARED_SEARCH_INL_H_
#endif

#include "core/grower-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

/// Shares of a wave: one for each thread, with the marks of all searches so far.
template <std::size_t D>
void Grower<D>::make_shares() {
  const std::size_t capacity = work_.complex.state.capacity();
  shares_.resize(team_->threads());
  for (std::size_t s = 0; s < shares_.size(); ++s) {
    SearchShare& share = shares_[s];
    if (s > 0) share.marks = HugeArray<std::uint8_t>(capacity);
    share.visible = HugeArray<std::uint32_t>(capacity);
    share.gauge = HugeArray<double>(capacity);
    share.horizon = HugeArray<HorizonRidge>(capacity * D);
  }
}

/// Marks what was found without the other shares since they last had all marks.
template <std::size_t D>
void Grower<D>::mark_found_alone(std::uint8_t* marks) {
  for (std::size_t i = shared_visible_; i < visible_count_; ++i) marks[visible_[i]] = visible_mark();
  for (std::size_t i = shared_horizon_; i < horizon_count_; ++i) marks[horizon_[i].hidden] = hidden_mark_;
}

/// Searches from the visible simplices begin .. end.
template <std::size_t D>
void Grower<D>::search_wave(const double* apex, double threshold, std::size_t begin, std::size_t end) {
  const std::size_t parts = shares_.size();
  const auto for_shares = [&](const auto& work) {
    team_->for_each_block(parts, 1, [&](std::size_t s, std::size_t) { work(s); });
  };
  for_shares([&](std::size_t s) {
    SearchShare& share = shares_[s];
    if (s > 0) mark_found_alone(share_marks(s));
    share.result = {
        share.visible.data(), share.gauge.data(), share.horizon.data(), 0, 0, HUGE_VAL, -HUGE_VAL, false};
    search<false>(apex, threshold, share_marks(s), begin + (end - begin) * s / parts,
                  begin + (end - begin) * (s + 1) / parts, share.result);
  });
  // What a lower share found as well is marked as a duplicate of it (and what two lower ones found).
  for_shares([&](std::size_t s) {
    std::uint8_t* const marks = share_marks(s);
    for (std::size_t lower = 0; lower < s; ++lower) {
      const SearchResult& found = shares_[lower].result;
      for (std::size_t i = 0; i < found.visible_count; ++i) {
        std::uint8_t& mark = marks[found.visible[i]];
        mark = mark >= visible_mark() ? duplicate_mark() : visible_mark();
      }
    }
    const SearchResult& own = shares_[s].result;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < own.visible_count; ++i)
      kept += marks[own.visible[i]] == visible_mark() ? 1u : 0u;
    shares_[s].kept = kept;
  });
  for_shares([&](std::size_t s) {
    const SearchResult& own = shares_[s].result;
    std::uint8_t* const marks = share_marks(s);
    std::size_t visible_at = visible_count_, horizon_at = horizon_count_;
    for (std::size_t lower = 0; lower < s; ++lower) {
      visible_at += shares_[lower].kept;
      horizon_at += shares_[lower].result.horizon_count;
    }
    std::copy_n(own.horizon, own.horizon_count, horizon_.data() + horizon_at);
    const std::size_t visible_end = visible_at + shares_[s].kept;
    for (std::size_t i = 0; visible_at < visible_end; ++i) {
      visible_[visible_at] = own.visible[i];
      visible_gauge_[visible_at] = own.gauge[i];
      visible_at += marks[own.visible[i]] == visible_mark() ? 1u : 0u;
    }
    for (std::size_t other = 0; other < parts; ++other) {
      if (other == s) continue;
      const SearchResult& found = shares_[other].result;
      for (std::size_t i = 0; i < found.horizon_count; ++i) marks[found.horizon[i].hidden] = hidden_mark_;
      if (other < s) continue;
      for (std::size_t i = 0; i < found.visible_count; ++i) marks[found.visible[i]] = visible_mark();
    }
  });
  for (const SearchShare& share : shares_) {
    visible_count_ += share.kept;
    horizon_count_ += share.result.horizon_count;
    lowest_visible_ = std::min(lowest_visible_, share.result.lowest);
    highest_hidden_ = std::max(highest_hidden_, share.result.highest);
  }
  shared_visible_ = visible_count_;
  shared_horizon_ = horizon_count_;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
