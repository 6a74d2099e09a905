// What limits leave time and memory for: the part of approx/growth/certified_growth.h that is asked for it.
#include "approx/growth/certified_growth.h"
#include "approx/growth/work_limits.h"
#include "approx/work_end.h"

namespace ndhull {

bool CertifiedGrowth::may_search(std::size_t points) {
  return noted_memory(limits_.has_memory_to_search(work_, frame_.dimension, point_bytes(), points));
}

bool CertifiedGrowth::has_time_to_cover() {
  const bool has_ended = is_found_otherwise_ || hull_.status == HullStatus::kTimeLimit ||
                         hull_.status == HullStatus::kInterrupted;
  if (has_ended) return false;
  if (options_.stop.stop_requested()) {
    hull_.status = HullStatus::kInterrupted;
  } else if (!limits_.has_time_to_cover(work_, left_out_.size())) {
    hull_.status = HullStatus::kTimeLimit;
  } else {
    return true;
  }
  return false;
}

bool CertifiedGrowth::may_cover() { return has_time_to_cover() && has_memory_to_cover(); }

bool CertifiedGrowth::has_memory_to_cover() {
  return noted_memory(limits_.has_memory_to_cover(work_, frame_.dimension, point_bytes()));
}

bool CertifiedGrowth::has_memory_for_slabs(std::size_t slabs, bool looks_further) {
  return noted_memory(
      limits_.has_memory_for_slabs(work_, frame_.dimension, point_bytes(), slabs, looks_further));
}

bool CertifiedGrowth::noted_memory(bool has_memory) {
  if (!has_memory) hull_.status = HullStatus::kMemoryLimit;
  return has_memory;
}

HullStatus CertifiedGrowth::go_on_within_limit() {
  const HullStatus limit = hull_.status;
  const bool may_go_on = (limit == HullStatus::kTimeLimit || limit == HullStatus::kFacetLimit) &&
                         !options_.stop.stop_requested() &&
                         limits_.has_memory_to_cover(work_, frame_.dimension, point_bytes()) &&
                         limits_.has_time_to_cover(work_, work_.points_outside);
  if (!may_go_on) return HullStatus::kComplete;
  hull_.status = HullStatus::kComplete;
  return limit;
}

bool CertifiedGrowth::is_late() {
  const bool is_stopped = options_.stop.stop_requested();
  if (!is_stopped && !limits_.is_late()) return false;
  if (hull_.status == HullStatus::kComplete)
    hull_.status = is_stopped ? HullStatus::kInterrupted : HullStatus::kTimeLimit;
  return true;
}

WorkEnd CertifiedGrowth::end_of_merging() const {
  constexpr double kShare = 0.8, kMoment = 0.3;
  if (options_.stop.stop_requested()) return WorkEnd(kMoment, {});
  return WorkEnd(kShare * options_.limits.max_seconds, options_.stop, start_);
}

void CertifiedGrowth::note_end(bool is_cut_short) {
  if (!is_cut_short || is_limited()) return;
  hull_.status = options_.stop.stop_requested() ? HullStatus::kInterrupted : HullStatus::kTimeLimit;
}

}  // namespace ndhull
