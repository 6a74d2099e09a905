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

#include "core/growth/grower-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

/// An insertion by all threads or alone, whichever takes less.
template <std::size_t D>
typename Grower<D>::Outcome Grower<D>::insert_timed(std::uint32_t apex_id, std::uint32_t seed) {
  if (new_count_ < kManyRidges || !has_team()) {
    is_shared_ = true;
    return insert(apex_id, seed);
  }
  is_shared_ = sharing_.shares(new_count_);
  PhaseClock clock(true);
  const Outcome outcome = insert(apex_id, seed);
  double seconds = 0.0;
  clock.lap(seconds);
  if (outcome == Outcome::kAdded && new_count_ >= kManyRidges) sharing_.took(is_shared_, new_count_, seconds);
  return outcome;
}

/// Starts the other threads, if there are any and they are not there yet.
template <std::size_t D>
bool Grower<D>::has_team() {
  if (!team_ && threads_ > 1) team_ = std::make_unique<Team>(threads_);
  return team_ != nullptr;
}

/// Marks what was found without the other shares since they last had all marks.
template <std::size_t D>
void Grower<D>::mark_found_alone(std::uint8_t* marks) {
  for (std::size_t i = shared_visible_; i < visible_count_; ++i) marks[visible_[i]] = visible_mark();
  for (std::size_t i = shared_horizon_; i < horizon_count_; ++i) marks[horizon_[i].hidden] = hidden_mark_;
}

/// Keeps what no lower share has found as well, and marks what the others have found.
template <std::size_t D>
void Grower<D>::merge_share(std::size_t s) {
  std::uint8_t* const marks = share_marks(s);
  for (std::size_t lower = 0; lower < s; ++lower) {  // what two lower ones found is marked as well
    const SearchResult& found = shares_[lower].result;
    for (std::size_t i = 0; i < found.visible_count; ++i) {
      std::uint8_t& mark = marks[found.visible[i]];
      mark = mark >= visible_mark() ? duplicate_mark() : visible_mark();
    }
  }
  SearchShare& share = shares_[s];
  const SearchResult& own = share.result;
  const std::size_t of_first = shares_[0].result.visible_count;  // it keeps all
  const std::size_t at = visible_count_ + s * of_first;
  std::uint32_t* const visible = s < 2 ? visible_.data() + at : share.kept_visible.data();
  double* const gauge = s < 2 ? visible_gauge_.data() + at : share.kept_gauge.data();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < own.visible_count; ++i) {
    const std::uint32_t row = own.visible[i];
    visible[kept] = row;
    gauge[kept] = own.gauge[i];
    kept += marks[row] == visible_mark() ? 1u : 0u;
  }
  share.kept = kept;
  // The first share has had no duplicates to look for: it copies the second one's ridges too.
  std::size_t horizon_at = horizon_count_;
  for (std::size_t other = 0; other < shares_.size(); ++other) {
    const SearchResult& found = shares_[other].result;
    if (other == 1 ? s == 0 : other == s)
      std::copy_n(found.horizon, found.horizon_count, horizon_.data() + horizon_at);
    horizon_at += found.horizon_count;
    if (other == s) continue;
    for (std::size_t i = 0; i < found.horizon_count; ++i) marks[found.horizon[i].hidden] = hidden_mark_;
    if (other < s) continue;
    for (std::size_t i = 0; i < found.visible_count; ++i) marks[found.visible[i]] = visible_mark();
  }
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
  for_shares([&](std::size_t s) { merge_share(s); });
  // Where the finds of the first two shares go is known before; the others wait for what the lower ones keep.
  if (parts > 2) {
    for_shares([&](std::size_t s) {
      std::size_t at = visible_count_;
      for (std::size_t lower = 0; lower < s; ++lower) at += shares_[lower].kept;
      if (s < 2) return;
      std::copy_n(shares_[s].kept_visible.data(), shares_[s].kept, visible_.data() + at);
      std::copy_n(shares_[s].kept_gauge.data(), shares_[s].kept, visible_gauge_.data() + at);
    });
  }
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
