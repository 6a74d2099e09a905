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

/// Fetches the planes around the visible simplices begin .. end.
template <std::size_t D>
HWY_INLINE void Grower<D>::fetch_neighbours(std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint32_t* around = neighbours(visible_[i]);
    for (std::size_t k = 0; k < D; ++k) {
      const char* record = reinterpret_cast<const char*>(plane(around[k]));
      __builtin_prefetch(record);
      if (D > 8) __builtin_prefetch(record + 64);
      __builtin_prefetch(state_ + around[k]);
    }
  }
}

/// Lowers the claim on a row to `key`; false when it was as low already.
template <std::size_t D>
bool Grower<D>::claim(std::uint32_t row, std::uint32_t key) {
  const std::atomic_ref<std::uint32_t> claim(claims_[row]);
  std::uint32_t lowest = claim.load(std::memory_order_relaxed);
  while (lowest == 0 || key < lowest) {
    if (claim.compare_exchange_weak(lowest, key, std::memory_order_relaxed)) return true;
  }
  return false;
}

// A block of visible simplices' neighbours. Two threads that test the same simplex find the same; the one
// that meets it first in the order of one thread's search has the lowest key and lists it.
template <std::size_t D>
void Grower<D>::search_block(const double* apex, double threshold, std::size_t chunk, std::size_t begin,
                             std::size_t end, VisibleBlock& block) {
  block.found.clear();
  block.horizon.clear();
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (std::size_t batch = begin; batch < end; batch += kBatch) {
    const std::size_t batch_end = std::min(batch + kBatch, end);
    fetch_neighbours(batch, batch_end);
    for (std::size_t i = batch; i < batch_end; ++i) {
      const std::uint32_t* around = neighbours(visible_[i]);
      for (std::size_t k = 0; k < D; ++k) {
        const std::uint32_t neighbour = around[k];
        const auto key = static_cast<std::uint32_t>((i - chunk) * D + k + 1);
        SimplexState now = load_shared(state_[neighbour]);
        if (now == SimplexState::kLive) {
          const double gauge = gauge_above<D>(plane(neighbour), apex);
          if (gauge > threshold) {
            lowest = gauge < lowest ? gauge : lowest;
            store_shared(state_[neighbour], SimplexState::kFound);
            if (claim(neighbour, key)) block.found.push_back({neighbour, key, gauge});
            continue;
          }
          highest = gauge > highest ? gauge : highest;
          store_shared(state_[neighbour], SimplexState::kHidden);
          now = SimplexState::kHidden;
        }
        if (now == SimplexState::kHidden) {
          block.horizon.push_back(
              {static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(k), 0, neighbour});
        } else if (now == SimplexState::kFound && claim(neighbour, key)) {
          block.found.push_back({neighbour, key, gauge_above<D>(plane(neighbour), apex)});
        }
      }
    }
  }
  block.lowest = lowest;
  block.highest = highest;
}

// Searches from the visible simplices begin .. end on several threads. What they find is listed in the order
// in which one thread would: by key.
template <std::size_t D>
void Grower<D>::search_chunk(const double* apex, double threshold, std::size_t begin, std::size_t end) {
  const std::size_t blocks = (end - begin + kVisibleInBlock - 1) / kVisibleInBlock;
  if (visible_blocks_.size() < blocks) visible_blocks_.resize(blocks);
  for_each_block(end - begin, kVisibleInBlock, [&](std::size_t from, std::size_t to) {
    search_block(apex, threshold, begin, begin + from, begin + to, visible_blocks_[from / kVisibleInBlock]);
  });
  for (std::size_t i = 0; i < blocks; ++i) {
    const VisibleBlock& block = visible_blocks_[i];
    lowest_visible_ = std::min(lowest_visible_, block.lowest);
    highest_hidden_ = std::max(highest_hidden_, block.highest);
    for (const FoundVisible& found : block.found) {
      if (claims_[found.row] != found.key) continue;
      claims_[found.row] = 0;
      state_[found.row] = SimplexState::kVisible;
      visible_[visible_count_] = found.row;
      visible_gauge_[visible_count_] = found.gauge;
      ++visible_count_;
    }
    std::copy(block.horizon.begin(), block.horizon.end(), horizon_.data() + horizon_count_);
    horizon_count_ += block.horizon.size();
  }
}

// Breadth first from `seed`. Neighbours are tested in batches: the fetches of a batch overlap, which is
// where the time of an insertion went before (memory latency).
template <std::size_t D>
void Grower<D>::find_visible(const double* apex_in, std::uint32_t seed, double threshold) {
  alignas(64) double apex[D];
  for (std::size_t k = 0; k < D; ++k) apex[k] = apex_in[k];
  visible_count_ = 1;
  horizon_count_ = 0;
  lowest_visible_ = gauge_above<D>(plane(seed), apex);
  highest_hidden_ = -HUGE_VAL;
  state_[seed] = SimplexState::kVisible;
  visible_[0] = seed;
  visible_gauge_[0] = lowest_visible_;
  for (std::size_t begin = 0; begin < visible_count_;) {
    const std::size_t end = visible_count_;
    if (is_parallel_ && end - begin >= kManyVisible) {
      search_chunk(apex, threshold, begin, end);
      begin = end;
    } else {
      begin = search_batches(apex, threshold, begin);
    }
  }
}

/// Searches from the visible simplices begin .. on until there are no more, or so many that threads may share
/// them; returns where it ended.
template <std::size_t D>
std::size_t Grower<D>::search_batches(const double* apex, double threshold, std::size_t begin) {
  double lowest = lowest_visible_, highest = highest_hidden_;
  std::size_t visible_count = visible_count_, horizon_count = horizon_count_;
  const std::size_t most = is_parallel_ ? kManyVisible : work_.complex.state.capacity();
  for (std::size_t end = 0; begin < visible_count && visible_count - begin < most; begin = end) {
    end = begin + kBatch < visible_count ? begin + kBatch : visible_count;
    fetch_neighbours(begin, end);
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
          horizon_[horizon_count++] = {static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(k), 0,
                                       neighbour};
        }
      }
    }
  }
  visible_count_ = visible_count;
  horizon_count_ = horizon_count;
  lowest_visible_ = lowest;
  highest_hidden_ = highest;
  return begin;
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
