// One insertion, for one dimension and one instruction set: visible set, horizon, cone, matching, partition.
// Included once per target by growth_kernels.cpp.
//
// Idea. A simplex is kept as its dual vertex a (a.y = 1 on it). The apex p sees it iff a.p - 1 > 0. Over the
// horizon ridge between a visible f and a hidden g the new dual vertex is where the dual edge (a_f, a_g) meets
// the plane of p: a = a_f + t (a_g - a_f), t = v_f / (v_f - v_g). That is a convex combination, so the
// residuals at the ridge's vertices never amplify.
//
// Neighbours of new simplices are found by turning around the subridge through the visible simplices that
// contain it: no hashing, no sorting, and what comes out is a closed complex by construction.
//
// All loads may read up to 64 bytes behind a row: HugeArray allows that.

#if defined(NDHULL_GROWER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_GROWER_INL_H_
#undef NDHULL_GROWER_INL_H_
#else
#define NDHULL_GROWER_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "core/growth.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Distance in planes of the hull between a facet and the gauge of y: a.y - 1.
template <std::size_t D>
HWY_INLINE double gauge_above(const double* HWY_RESTRICT plane, const double* HWY_RESTRICT y) {
  double even = -1.0, odd = 0.0;
  for (std::size_t k = 0; k + 1 < D; k += 2) {
    even = __builtin_fma(plane[k], y[k], even);
    odd = __builtin_fma(plane[k + 1], y[k + 1], odd);
  }
  if (D % 2 != 0) even = __builtin_fma(plane[D - 1], y[D - 1], even);
  return even + odd;
}

/// Slot of `value` in a row of D ids that contains it.
template <std::size_t D>
HWY_INLINE std::uint32_t slot_of(const std::uint32_t* row, std::uint32_t value) {
  constexpr std::size_t kLanes = D <= 4 ? 4 : 8;
  const hn::CappedTag<std::uint32_t, kLanes> tag;
  const auto wanted = hn::Set(tag, value);
  for (std::size_t begin = 0; begin < D; begin += hn::Lanes(tag)) {
    const auto equal = hn::Eq(hn::LoadU(tag, row + begin), wanted);
    const std::intptr_t found = hn::FindFirstTrue(tag, equal);
    if (found >= 0) return static_cast<std::uint32_t>(begin) + static_cast<std::uint32_t>(found);
  }
  return D;
}

constexpr std::uint32_t kNewBit = 0x8000'0000u;  // marks, in a visible simplex, the new one over its ridge
constexpr std::uint32_t kNoRow = 0xFFFF'FFFFu;

/// Adds the time since the last lap to a counter, when asked to.
class PhaseClock {
 public:
  explicit PhaseClock(bool on) : on_(on) {
    if (on_) last_ = std::chrono::steady_clock::now();
  }
  void lap(double& seconds) {
    if (!on_) return;
    const auto now = std::chrono::steady_clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  bool on_;
  std::chrono::steady_clock::time_point last_;
};

/// A ridge where the visible set ends.
struct HorizonRidge {
  std::uint32_t visible_index;  // into the visible list
  std::uint32_t slot;           // the ridge is opposite this vertex of the visible simplex
  std::uint32_t hidden;         // simplex on the other side
};

template <std::size_t D>
class Grower {
 public:
  explicit Grower(GrowthWork& work)
      : work_(work),
        planes_(work.complex.planes.data()),
        topology_(work.complex.topology.data()),
        state_(work.complex.state.data()),
        head_(work.complex.outside_head.data()),
        points_(work.points),
        visible_(work.complex.state.capacity()),
        visible_gauge_(work.complex.state.capacity()),
        horizon_(work.complex.state.capacity() * D),
        new_rows_(work.complex.state.capacity()) {}

  GrowthStop run();

 private:
  static constexpr std::size_t kBatch = 8;  // visible simplices whose neighbours are fetched together

  double* plane(std::uint32_t row) { return planes_ + std::size_t{row} * D; }
  std::uint32_t* vertices(std::uint32_t row) { return topology_ + std::size_t{row} * 2 * D; }
  std::uint32_t* neighbours(std::uint32_t row) { return topology_ + std::size_t{row} * 2 * D + D; }
  const double* point(std::uint32_t id) const { return points_ + std::size_t{id} * D; }

  void find_visible(const double* apex, std::uint32_t seed, double threshold);
  void forget_visible();
  void make_cone(std::uint32_t apex, double shift);
  void match_cone();
  void undo_cone();
  void commit();
  void partition(std::uint32_t apex);
  enum class Outcome { kAdded, kRejected, kNoRoom };
  Outcome insert(std::uint32_t apex, std::uint32_t seed);
  double draw_shift(std::uint32_t apex_id, unsigned attempt) const;
  bool room_for_cone();
  std::size_t live_rows() const { return work_.complex.row_count - work_.free_count; }
  bool cone_is_sphere();
  std::uint32_t locate(const double* y, std::uint32_t row, double& gauge);
  void drop_first(std::uint32_t row);

  GrowthWork& work_;
  double* planes_;
  std::uint32_t* topology_;
  SimplexState* state_;
  std::uint32_t* head_;
  const double* points_;

  HugeArray<std::uint32_t> visible_;
  HugeArray<double> visible_gauge_;
  HugeArray<HorizonRidge> horizon_;
  HugeArray<std::uint32_t> new_rows_;
  std::size_t visible_count_ = 0, horizon_count_ = 0, new_count_ = 0;
  double lowest_visible_ = 0.0;   // smallest gauge tested above the threshold
  double highest_hidden_ = 0.0;   // largest gauge tested not above it
  struct Subridge {
    std::uint64_t key;  // XOR of its vertices' random keys
    std::uint32_t count;
  };
  std::vector<Subridge> subridges_;
};

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
          horizon_[horizon_count++] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), neighbour};
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

// One new simplex over each horizon ridge: the visible simplex's vertices with the one opposite the ridge
// replaced by the apex. The visible simplex's neighbour entry is overwritten with the new row (marked), which
// is what the matching reads; `undo_cone` puts it back.
template <std::size_t D>
void Grower<D>::make_cone(std::uint32_t apex_id, double shift) {
  alignas(64) double apex[D];
  for (std::size_t k = 0; k < D; ++k) apex[k] = point(apex_id)[k];
  constexpr std::size_t kAhead = 8;
  std::size_t free_count = work_.free_count;
  std::size_t row_count = work_.complex.row_count;
  for (std::size_t i = 0; i < horizon_count_; ++i) {
    if (i + kAhead < horizon_count_) {
      const HorizonRidge& later = horizon_[i + kAhead];
      __builtin_prefetch(plane(later.hidden));
      __builtin_prefetch(plane(visible_[later.visible_index]));
      __builtin_prefetch(vertices(visible_[later.visible_index]), 1);
      if (free_count > kAhead) {
        __builtin_prefetch(plane(work_.free_rows[free_count - kAhead]), 1);
        __builtin_prefetch(vertices(work_.free_rows[free_count - kAhead]), 1);
      }
    }
    const HorizonRidge ridge = horizon_[i];
    const std::uint32_t visible = visible_[ridge.visible_index];
    const std::uint32_t row =
        free_count > 0 ? work_.free_rows[--free_count] : static_cast<std::uint32_t>(row_count++);
    new_rows_[i] = row;

    const double* HWY_RESTRICT above = plane(visible);
    const double* HWY_RESTRICT below = plane(ridge.hidden);
    double* HWY_RESTRICT made = plane(row);
    const double gauge_visible = visible_gauge_[ridge.visible_index];
    const double gauge_hidden = gauge_above<D>(below, apex);
    const double t = (gauge_visible - shift) / (gauge_visible - gauge_hidden);
    for (std::size_t k = 0; k < D; ++k) made[k] = __builtin_fma(t, below[k] - above[k], above[k]);

    const std::uint32_t* HWY_RESTRICT old_vertices = vertices(visible);
    std::uint32_t* HWY_RESTRICT made_vertices = vertices(row);
    for (std::size_t k = 0; k < D; ++k) made_vertices[k] = old_vertices[k];
    made_vertices[ridge.slot] = apex_id;
    std::uint32_t* HWY_RESTRICT around = made_vertices + D;
    for (std::size_t k = 0; k < D; ++k) around[k] = kNoRow;
    around[ridge.slot] = ridge.hidden;
    state_[row] = SimplexState::kLive;
    neighbours(visible)[ridge.slot] = row | kNewBit;
  }
  new_count_ = horizon_count_;
  work_.free_count = free_count;
  work_.complex.row_count = row_count;
}

// For the new simplex over the ridge opposite slot k of f, the neighbour opposite its vertex v (slot m) lies
// across the subridge S = f minus slots k and m. Turn around S: leave f through m; in each visible simplex
// entered, leave opposite the vertex that the previous one shared besides S; stop at the first ridge that
// has a new simplex over it. Both neighbour entries are set at once.
template <std::size_t D>
void Grower<D>::match_cone() {
  for (std::size_t i = 0; i < new_count_; ++i) {
    const std::uint32_t row = new_rows_[i];
    const HorizonRidge ridge = horizon_[i];
    const std::uint32_t first = visible_[ridge.visible_index];
    std::uint32_t* HWY_RESTRICT around = neighbours(row);
    for (std::uint32_t m = 0; m < D; ++m) {
      if (around[m] != kNoRow) continue;  // the ridge to the horizon, or matched from the other side
      std::uint32_t current = first;
      std::uint32_t entered = ridge.slot;  // slot of the ridge that S + its vertex came from
      std::uint32_t leave = m;
      std::uint32_t next = neighbours(current)[leave];
      while ((next & kNewBit) == 0) {
        // S plus the vertex at `entered` is what current and next share; go on opposite that vertex.
        const std::uint32_t pivot = vertices(current)[entered];
        const std::uint32_t back = slot_of<D>(neighbours(next), current);
        leave = slot_of<D>(vertices(next), pivot);
        entered = back;
        current = next;
        next = neighbours(current)[leave];
      }
      const std::uint32_t partner = next & ~kNewBit;
      around[m] = partner;
      neighbours(partner)[entered] = row;
    }
  }
}

template <std::size_t D>
void Grower<D>::undo_cone() {
  for (std::size_t i = 0; i < new_count_; ++i) {
    neighbours(visible_[horizon_[i].visible_index])[horizon_[i].slot] = horizon_[i].hidden;
    state_[new_rows_[i]] = SimplexState::kFree;
    work_.free_rows[work_.free_count++] = new_rows_[i];
  }
  forget_visible();
}

template <std::size_t D>
void Grower<D>::commit() {
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < new_count_; ++i) {
    if (i + kAhead < new_count_) __builtin_prefetch(neighbours(horizon_[i + kAhead].hidden), 1);
    const HorizonRidge& ridge = horizon_[i];
    std::uint32_t* around = neighbours(ridge.hidden);
    around[slot_of<D>(around, visible_[ridge.visible_index])] = new_rows_[i];
    state_[ridge.hidden] = SimplexState::kLive;
  }
}

// Hill climbing on the dual graph: a linear program whose vertices are the simplices.
template <std::size_t D>
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
    row = best_row;
  }
  gauge = best;
  return row;
}

// The rest of the set is in no order: find its furthest point and put it first.
template <std::size_t D>
void Grower<D>::drop_first(std::uint32_t row) {
  std::uint32_t rest = work_.next_outside[head_[row] - 1];
  head_[row] = 0;
  --work_.points_outside;
  while (rest != 0) {
    const std::uint32_t id = rest - 1;
    rest = work_.next_outside[id];
    --work_.points_outside;
    push_outside(work_, id, row, work_.gauge[id]);
  }
}

template <std::size_t D>
void Grower<D>::partition(std::uint32_t apex) {
  std::uint32_t start = new_rows_[0];
  for (std::size_t i = 0; i < visible_count_; ++i) {
    const std::uint32_t row = visible_[i];
    std::uint32_t next = head_[row];
    head_[row] = 0;
    state_[row] = SimplexState::kFree;
    while (next != 0) {
      const std::uint32_t id = next - 1;
      next = work_.next_outside[id];
      --work_.points_outside;
      if (id == apex) continue;
      double gauge = 0.0;
      const std::uint32_t found = locate(point(id), start, gauge);
      start = found;
      if (gauge > 2.0 * work_.options.shift) push_outside(work_, id, found, gauge);
    }
    work_.free_rows[work_.free_count++] = row;
  }
}


HWY_INLINE std::uint64_t scramble(std::uint64_t x) {  // splitmix64 (Steele, Lea, Flood, 2014)
  x += 0x9E37'79B9'7F4A'7C15u;
  x = (x ^ (x >> 30)) * 0xBF58'476D'1CE4'E5B9u;
  x = (x ^ (x >> 27)) * 0x94D0'49BB'1331'11EBu;
  return x ^ (x >> 31);
}

// Between one and two of the shift, at random so that no two points are moved alike: points that lie on one
// plane would stay on one plane.
template <std::size_t D>
double Grower<D>::draw_shift(std::uint32_t apex_id, unsigned attempt) const {
  const std::uint64_t random = scramble(work_.options.seed ^ scramble((std::uint64_t{apex_id} << 8) + attempt));
  return work_.options.shift * (1.0 + static_cast<double>(random >> 11) * 0x1p-53);
}

// The cone's base must be a sphere: each subridge in exactly two new simplices, and all connected. The turn
// around subridges cannot tell a pinched horizon from a sound one, so doubtful insertions are looked at.
template <std::size_t D>
bool Grower<D>::cone_is_sphere() {
  // Each key has to come exactly twice: open addressing, 2^k entries, half of them free.
  std::size_t mask = 63;
  while (mask < 4 * new_count_ * D) mask = 2 * mask + 1;  // at most new_count D / 2 different keys
  subridges_.assign(mask + 1, {0, 0});
  std::size_t open = 0;
  for (std::size_t i = 0; i < new_count_; ++i) {
    const std::uint32_t* ids = vertices(new_rows_[i]);
    const std::uint32_t apex_slot = horizon_[i].slot;
    std::uint64_t key_of[D], all = 1;
    for (std::uint32_t k = 0; k < D; ++k) all ^= key_of[k] = k == apex_slot ? 0 : scramble(ids[k]);
    for (std::uint32_t k = 0; k < D; ++k) {
      if (k == apex_slot) continue;
      const std::uint64_t key = all ^ key_of[k];
      std::size_t at = key & mask;
      while (subridges_[at].count != 0 && subridges_[at].key != key) at = (at + 1) & mask;
      subridges_[at].key = key;
      const std::uint32_t count = ++subridges_[at].count;
      if (count > 2) return false;
      open += count == 1 ? 1 : 0;
      open -= count == 2 ? 1 : 0;
    }
  }
  if (open != 0) return false;
  // Connected: walk from the first new simplex. kVisible marks those reached; new ones are kLive before.
  std::vector<std::uint32_t> reached{new_rows_[0]};
  for (std::size_t i = 0; i < new_count_; ++i) state_[new_rows_[i]] = SimplexState::kFree;
  state_[reached[0]] = SimplexState::kLive;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::uint32_t* around = neighbours(reached[i]);
    for (std::size_t k = 0; k < D; ++k) {
      if (state_[around[k]] == SimplexState::kFree) {
        state_[around[k]] = SimplexState::kLive;
        reached.push_back(around[k]);
      }
    }
  }
  const bool connected = reached.size() == new_count_;
  for (std::size_t i = 0; i < new_count_; ++i) state_[new_rows_[i]] = SimplexState::kLive;
  return connected;
}

template <std::size_t D>
typename Grower<D>::Outcome Grower<D>::insert(std::uint32_t apex_id, std::uint32_t seed) {
  // Decisions clearer than this need no second look: some ten times the error of one gauge in the frame.
  constexpr double kCertain = 4e-15;
  constexpr unsigned kAttempts = 8;
  const double low = work_.options.shift;
  PhaseClock clock(work_.measure_phases);
  for (unsigned attempt = 0; attempt < kAttempts; ++attempt) {
    double shift = draw_shift(apex_id, attempt);
    find_visible(point(apex_id), seed, shift);
    clock.lap(work_.counters.seconds_visible);
    if (!room_for_cone()) return Outcome::kNoRoom;
    double clearance = std::min(lowest_visible_ - shift, shift - highest_hidden_);
    if (lowest_visible_ > 2.0 * low && highest_hidden_ < -low) {
      // No gauge within the shift of 0: the visible set is the same without a shift, and certain.
      shift = 0.0;
      clearance = low;
    }
    make_cone(apex_id, shift);
    clock.lap(work_.counters.seconds_cone);
    match_cone();
    const bool sound = clearance > kCertain || (horizon_count_ > 0 && cone_is_sphere());
    clock.lap(work_.counters.seconds_match);
    if (!sound) {
      ++work_.counters.rejected;
      undo_cone();
      continue;
    }
    commit();
    work_.counters.created += new_count_;
    ++work_.counters.insertions;
    work_.counters.shifted += shift > 0.0 ? 1 : 0;
    clock.lap(work_.counters.seconds_match);
    partition(apex_id);
    clock.lap(work_.counters.seconds_partition);
    return Outcome::kAdded;
  }
  return Outcome::kRejected;
}

template <std::size_t D>
bool Grower<D>::room_for_cone() {
  const std::size_t needed = horizon_count_ > work_.free_count ? horizon_count_ - work_.free_count : 0;
  if (work_.complex.row_count + needed <= work_.complex.state.capacity()) return true;
  forget_visible();
  return false;
}

template <std::size_t D>
GrowthStop Grower<D>::run() {
  std::uint64_t polled_at = 0;
  while (!work_.pending.empty()) {
    const OutsideSet furthest = work_.pending.front();
    const std::uint32_t row = furthest.row;
    if (state_[row] != SimplexState::kLive || head_[row] == 0 || work_.gauge[head_[row] - 1] != furthest.gauge) {
      std::pop_heap(work_.pending.begin(), work_.pending.end());
      work_.pending.pop_back();
      continue;
    }
    const std::uint32_t apex_id = head_[row] - 1;
    if (work_.options.poll && work_.counters.created >= polled_at) {
      const GrowthStop stop = work_.options.poll(work_.points_outside, work_.gauge[apex_id]);
      if (stop != GrowthStop::kNoOutsidePoints) return stop;
      polled_at = work_.counters.created + 4096;
    }
    if (work_.options.max_rows != 0 && live_rows() >= work_.options.max_rows) return GrowthStop::kFacetLimit;
    switch (insert(apex_id, row)) {
      case Outcome::kAdded: break;
      case Outcome::kNoRoom: return GrowthStop::kMemoryLimit;
      case Outcome::kRejected:  // certify will measure what it costs
        ++work_.counters.set_aside;
        drop_first(row);
        break;
    }
  }
  return GrowthStop::kNoOutsidePoints;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
