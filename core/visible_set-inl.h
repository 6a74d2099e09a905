// The visible set of an apex and its horizon. Included once per target by growth_kernels.cpp.

#if defined(NDHULL_VISIBLE_SET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_VISIBLE_SET_INL_H_
#undef NDHULL_VISIBLE_SET_INL_H_
#else
#define NDHULL_VISIBLE_SET_INL_H_
#endif

#include "core/grower-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

// Breadth first from `seed`. Neighbours are tested in batches: the fetches of a batch overlap, which is
// where the time of an insertion went before (memory latency).
template <std::size_t D>
void Grower<D>::find_visible(const double* apex_in, std::uint32_t seed, double threshold) {
  alignas(64) double apex[D];
  for (std::size_t k = 0; k < D; ++k) apex[k] = apex_in[k];
  visible_count_ = 0;
  horizon_count_ = 0;
  double lowest = gauge_above<D>(plane(seed), apex);
  double highest = -HUGE_VAL;
  state_[seed] = SimplexState::kVisible;
  visible_[0] = seed;
  visible_gauge_[0] = lowest;
  std::size_t visible_count = 1, horizon_count = 0;
  for (std::size_t begin = 0, end = 0; begin < visible_count; begin = end) {
    end = begin + kBatch < visible_count ? begin + kBatch : visible_count;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t* around = neighbours(visible_[i]);
      for (std::size_t k = 0; k < D; ++k) {
        const char* record = reinterpret_cast<const char*>(plane(around[k]));
        __builtin_prefetch(record);
        if (D > 8) __builtin_prefetch(record + 64);
        __builtin_prefetch(state_ + around[k]);
      }
    }
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t* around = neighbours(visible_[i]);
      for (std::size_t k = 0; k < D; ++k) {
        const std::uint32_t neighbour = around[k];
        SimplexState now = state_[neighbour];
        if (now == SimplexState::kLive) {
          const double gauge = gauge_above<D>(plane(neighbour), apex);
          if (gauge > threshold) {
            lowest = gauge < lowest ? gauge : lowest;
            state_[neighbour] = SimplexState::kVisible;
            visible_[visible_count] = neighbour;
            visible_gauge_[visible_count] = gauge;
            ++visible_count;
            __builtin_prefetch(vertices(neighbour));
            continue;
          }
          highest = gauge > highest ? gauge : highest;
          state_[neighbour] = SimplexState::kHidden;
          now = SimplexState::kHidden;
        }
        if (now == SimplexState::kHidden) {
          horizon_[horizon_count++] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k),
                                       neighbour};
        }
      }
    }
  }
  visible_count_ = visible_count;
  horizon_count_ = horizon_count;
  lowest_visible_ = lowest;
  highest_hidden_ = highest;
}

template <std::size_t D>
void Grower<D>::forget_visible() {
  for (std::size_t i = 0; i < visible_count_; ++i) state_[visible_[i]] = SimplexState::kLive;
  for (std::size_t i = 0; i < horizon_count_; ++i) state_[horizon_[i].hidden] = SimplexState::kLive;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
