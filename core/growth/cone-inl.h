// The cone of new simplices over the horizon: planes, neighbours, check, commit or undo. Included once per
// target by growth_kernels.cpp.

#if defined(NDHULL_CONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_CONE_INL_H_
#undef NDHULL_CONE_INL_H_
#else
#define NDHULL_CONE_INL_H_
#endif

#include "core/growth/grower-inl.h"
#include "core/growth/row_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

// One new simplex over each horizon ridge: the visible simplex's vertices with the one opposite the ridge
// replaced by the apex. The visible simplex's neighbour entry is overwritten with the new row (marked), which
// is what the matching reads; `undo_cone` puts it back.
template <std::size_t D>
void Grower<D>::make_ridges(std::uint32_t apex_id, double shift, std::size_t begin, std::size_t end) {
  begin = first_sibling(begin);
  end = first_sibling(end);
  alignas(64) double apex[D];
  for (std::size_t k = 0; k < D; ++k) apex[k] = point(apex_id)[k];
  constexpr std::size_t kAhead = 8;
  const std::size_t free_count = books_.free_count, row_count = books_.row_count;
  for (std::size_t i = begin; i < end; ++i) {
    if (i + kAhead < end) {
      const HorizonRidge& later = horizon_[i + kAhead];
      __builtin_prefetch(plane(later.hidden));
      __builtin_prefetch(plane(visible_[later.visible_index]));
      __builtin_prefetch(vertices(visible_[later.visible_index]), 1);
      if (i + kAhead < free_count) {
        __builtin_prefetch(plane(books_.free_rows[free_count - kAhead - 1 - i]), 1);
        __builtin_prefetch(vertices(books_.free_rows[free_count - kAhead - 1 - i]), 1);
      }
    }
    const HorizonRidge ridge = horizon_[i];
    const std::uint32_t visible = visible_[ridge.visible_index];
    // Rows freed last first, then rows never used.
    const std::uint32_t row = i < free_count ? books_.free_rows[free_count - 1 - i]
                                             : static_cast<std::uint32_t>(row_count + (i - free_count));
    new_rows_[i] = row;

    const double* HWY_RESTRICT above = plane(visible);
    const double* HWY_RESTRICT below = plane(ridge.hidden);
    double* HWY_RESTRICT made = plane(row);
    const double gauge_visible = visible_gauge_[ridge.visible_index];
    const double gauge_hidden = gauge_above<D>(below, apex);
    const double t = (gauge_visible - shift) / (gauge_visible - gauge_hidden);
    for_row<double, D>([&](auto tag, std::size_t k) HWY_ATTR {
      const auto from = hn::LoadU(tag, above + k);
      const auto along = hn::Sub(hn::LoadU(tag, below + k), from);
      hn::StoreU(hn::MulAdd(hn::Set(tag, t), along, from), tag, made + k);
    });

    const std::uint32_t* HWY_RESTRICT old_vertices = vertices(visible);
    std::uint32_t* HWY_RESTRICT made_vertices = vertices(row);
    for_row<std::uint32_t, D>([&](auto tag, std::size_t k) HWY_ATTR {
      hn::StoreU(hn::LoadU(tag, old_vertices + k), tag, made_vertices + k);
    });
    made_vertices[ridge.slot] = apex_id;
    if (region_ == nullptr) state_[row] = SimplexState::kLive;
    neighbours(visible)[ridge.slot] = row | kNewBit;
    if (i >= begin + D) join_siblings(i - D);
  }
  for (std::size_t i = begin + D < end ? end - D : begin; i < end; ++i) join_siblings(i);
}

// New simplices over ridges of the same visible one are neighbours. The other entries are found by turning.
template <std::size_t D>
HWY_INLINE void Grower<D>::join_siblings(std::size_t index) {
  const HorizonRidge ridge = horizon_[index];
  const std::uint32_t* HWY_RESTRICT around = neighbours(visible_[ridge.visible_index]);
  std::uint32_t* HWY_RESTRICT made = neighbours(new_rows_[index]);
  for_row<std::uint32_t, D>([&](auto tag, std::size_t k) HWY_ATTR {
    hn::StoreU(hn::AndNot(hn::Set(tag, kNewBit), hn::LoadU(tag, around + k)), tag, made + k);
  });
  made[ridge.slot] = ridge.hidden;
}

/// The first ridge from `index` on that is the first of its visible simplex.
template <std::size_t D>
std::size_t Grower<D>::first_sibling(std::size_t index) const {
  while (index > 0 && index < horizon_count_ &&
         horizon_[index].visible_index == horizon_[index - 1].visible_index)
    ++index;
  return index;
}

// Memory for rows never used, some megabytes ahead. A new huge page takes the system 0.3 ms and up to 8 where
// the machine is virtual: all threads would wait, one page at a time. So they clear different ones.
template <std::size_t D>
void Grower<D>::touch_new_rows() {
  constexpr std::size_t kBytesAhead = std::size_t{1} << 22, kHugePage = std::size_t{1} << 21, kPage = 4096;
  constexpr std::size_t kRowBytes = D * sizeof(double);  // of planes, and of the topology
  constexpr std::size_t kSmallHull = std::size_t{1} << 18;
  const std::size_t reused = std::min(books_.free_count, horizon_count_);
  const std::size_t needed = books_.row_count + horizon_count_ - reused;
  if (!is_shared_ || needed <= touched_rows_ || needed * kRowBytes < kSmallHull || !has_team()) return;
  const std::size_t first = std::max(touched_rows_, books_.row_count);
  const std::size_t last = std::min(needed + kBytesAhead / kRowBytes, rows_with_room());
  // A block is a huge page of either table: both come to new pages at the same time.
  const std::size_t blocks = (kHugePage + (last - first) * kRowBytes - 1) / kHugePage + 1;
  void* const tables[] = {planes_, topology_};
  const auto touch = [&](std::size_t block, std::size_t) {
    char* const unused = static_cast<char*>(tables[block % 2]) + first * kRowBytes;
    const std::size_t before = reinterpret_cast<std::uintptr_t>(unused) % kHugePage;  // in the same page
    const std::size_t begin = block / 2 * kHugePage;
    const std::size_t end = std::min(begin + kHugePage, before + (last - first) * kRowBytes);
    for (std::size_t at = std::max(begin, before); at < end; at += kPage) unused[at - before] = 0;
  };
  team_->for_each_block(2 * blocks, 1, touch);
  touched_rows_ = last;
}

// Heads and marks are read before they are written. A page that is read first is the system's page of zeros,
// and the write that replaces it interrupts all threads, which took a tenth of growth where the machine is
// virtual.
template <std::size_t D>
void Grower<D>::clear_new_rows() {
  constexpr std::size_t kAhead = 1024;  // a page of heads
  const std::size_t needed = books_.row_count + horizon_count_;
  if (needed <= cleared_rows_) return;
  const std::size_t first = std::max(cleared_rows_, books_.row_count);
  const std::size_t last = std::max(first, std::min(needed + kAhead, std::min(row_end(), rows_with_room())));
  std::fill(head_ + first, head_ + last, 0u);
  std::fill(marks_.data() + first, marks_.data() + last, std::uint8_t{0});
  for (std::size_t s = 1; s < shares_.size(); ++s)
    std::fill(shares_[s].marks.data() + first, shares_[s].marks.data() + last, std::uint8_t{0});
  cleared_rows_ = last;
}

template <std::size_t D>
void Grower<D>::make_cone(std::uint32_t apex_id, double shift) {
  touch_new_rows();
  clear_new_rows();
  for_many(horizon_count_,
           [&](std::size_t begin, std::size_t end) { make_ridges(apex_id, shift, begin, end); });
  new_count_ = horizon_count_;
  const std::size_t reused = std::min(books_.free_count, new_count_);
  books_.free_count -= reused;
  books_.row_count += new_count_ - reused;
}

template <std::size_t D>
void Grower<D>::undo_cone() {
  for (std::size_t i = 0; i < new_count_; ++i) {
    neighbours(visible_[horizon_[i].visible_index])[horizon_[i].slot] = horizon_[i].hidden;
    if (region_ == nullptr) state_[new_rows_[i]] = SimplexState::kFree;
    books_.free_rows[books_.free_count++] = new_rows_[i];
  }
}

// Where each ridge is among those of its hidden simplex, then the entries: a hidden simplex may have several
// ridges, and none is looked for in a row that another thread changes.
template <std::size_t D>
void Grower<D>::find_hidden_slots(std::size_t begin, std::size_t end) {
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = begin; i < end; ++i) {
    if (i + kAhead < new_count_) __builtin_prefetch(neighbours(horizon_[i + kAhead].hidden), 1);
    HorizonRidge& ridge = horizon_[i];
    const std::uint32_t slot =
        slot_of<D, RowHalf::kNeighbours>(vertices(ridge.hidden), visible_[ridge.visible_index]);
    ridge.hidden_slot = static_cast<std::uint16_t>(slot);
  }
}

template <std::size_t D>
void Grower<D>::join_hidden(std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const HorizonRidge& ridge = horizon_[i];
    neighbours(ridge.hidden)[ridge.hidden_slot] = new_rows_[i];
  }
}

// Two passes, since a hidden simplex may have several ridges: none is looked for in a row that another thread
// changes.
template <std::size_t D>
void Grower<D>::commit() {
  const auto find = [&](std::size_t begin, std::size_t end) { find_hidden_slots(begin, end); };
  const auto join = [&](std::size_t begin, std::size_t end) { join_hidden(begin, end); };
  if (shares_loops() && new_count_ >= kManyRidges) {
    for_many(new_count_, find);
    for_many(new_count_, join);
    return;
  }
  constexpr std::size_t kInCache = 16;
  for (std::size_t begin = 0; begin < new_count_; begin += kInCache) {
    const std::size_t end = std::min(begin + kInCache, new_count_);
    find(begin, end);
    join(begin, end);
  }
}

// The cone's base must be a sphere: no subridge in more than two new simplices, and all connected. The turn
// around subridges pairs the new simplices of a pinched horizon as well, so doubtful insertions are looked
// at: each pair's subridge must differ from that of all other pairs.
template <std::size_t D>
bool Grower<D>::cone_is_sphere() {
  return subridges_differ() && cone_is_connected();
}

/// Lists the keys of the subridges between the new simplex of ridge `index` and neighbours with larger rows:
/// each pair is listed once. Returns how many there are now; writes up to 8 more.
template <std::size_t D>
HWY_INLINE std::size_t Grower<D>::list_subridges(std::size_t index, std::uint64_t* keys, std::size_t count) {
  const hn::CappedTag<std::uint64_t, 8> tag;
  const hn::Rebind<std::uint32_t, decltype(tag)> ids_tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::uint32_t row = new_rows_[index], apex_slot = horizon_[index].slot;
  const std::uint32_t* ids = vertices(row);
  const std::uint32_t* around = neighbours(row);
  alignas(64) std::uint64_t key_of[(D + 7) / 8 * 8];
  for (std::size_t k = 0; k < D; k += lanes)
    hn::Store(scramble_lanes(tag, hn::PromoteTo(tag, hn::LoadU(ids_tag, ids + k))), tag, key_of + k);
  key_of[apex_slot] = 0;
  std::uint64_t all = 1;
  for (std::size_t k = 0; k < D; ++k) all ^= key_of[k];
  for (std::size_t k = 0; k < D; ++k) {
    keys[count] = all ^ key_of[k];
    // Which side has the larger row cannot be predicted.
    count += static_cast<std::size_t>(k != apex_slot) & static_cast<std::size_t>(around[k] > row);
  }
  return count;
}

template <std::size_t D>
bool Grower<D>::subridges_differ() {
  // Open addressing. Each pair of neighbours has one key: at most half of the entries are used.
  const std::size_t pairs = new_count_ * (D - 1) / 2;
  std::size_t mask = 63;
  while (mask < 2 * pairs) mask = 2 * mask + 1;
  subridge_keys_.assign(mask + 1, 0);
  subridges_late_.resize(2 * pairs + 8);
  std::uint64_t* const table = subridge_keys_.data();
  std::uint64_t* const late = subridges_late_.data();  // whose first entry another has
  std::size_t late_count = 0;
  bool differ = true;
  constexpr std::size_t kRows = 8;  // whose entries are on their way from memory together
  std::uint64_t keys[kRows * D + 8];
  for (std::size_t begin = 0; begin < new_count_; begin += kRows) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < std::min(begin + kRows, new_count_); ++i)
      count = list_subridges(i, keys, count);
    for (std::size_t i = 0; i < count; ++i) __builtin_prefetch(table + (keys[i] & mask), 1);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t key = keys[i];
      std::uint64_t& entry = table[key & mask];
      const bool is_free = entry == 0;
      differ &= entry != key;
      entry = is_free ? key : entry;
      late[late_count] = key;
      late_count += is_free ? 0 : 1;
    }
  }
  for (std::size_t i = 0; i < late_count && differ; ++i) {
    std::size_t at = late[i] & mask;
    for (; table[at] != 0; at = (at + 1) & mask) differ &= table[at] != late[i];
    table[at] = late[i];
  }
  return differ;
}

// A walk from the first new simplex. kLive marks those reached; hidden neighbours have it before.
template <std::size_t D>
bool Grower<D>::cone_is_connected() {
  cone_walk_.resize(new_count_ + D);
  std::uint32_t* const reached = cone_walk_.data();
  for (std::size_t i = 0; i < new_count_; ++i) state_[new_rows_[i]] = SimplexState::kFree;
  std::size_t count = 1;
  reached[0] = new_rows_[0];
  state_[reached[0]] = SimplexState::kLive;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t* around = neighbours(reached[i]);
    for (std::size_t k = 0; k < D; ++k) {
      reached[count] = around[k];
      count += state_[around[k]] == SimplexState::kFree ? 1 : 0;
      state_[around[k]] = SimplexState::kLive;
    }
  }
  for (std::size_t i = 0; i < new_count_; ++i) state_[new_rows_[i]] = SimplexState::kLive;
  return count == new_count_;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
