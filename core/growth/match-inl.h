// Neighbours of the new simplices, by turning around subridges. Included once per target by
// growth_kernels.cpp.
//
// Idea. For the new simplex over the ridge opposite slot k of a visible f, the neighbour opposite its vertex
// v (slot m) lies across the subridge S = f minus slots k and m. Turn around S: leave f through m; in each
// visible simplex entered, leave opposite the vertex that the previous one shared besides S; stop at the
// first ridge that has a new simplex over it. Half of all turns end after one step or none, and where they
// end cannot be predicted: so many turns make one step each, and those that go on stay in a list. No branch
// depends on the complex.
//
// Each pair is turned to from one side only. Around S the visible simplices stand one after the other, and
// (S, vertex where the turn begins, vertex it goes to) has one orientation in all of them; seen from the
// other end it has the opposite one. With the vertices of S in the order of their ids that is the parity of a
// permutation of f's row.

#if defined(NDHULL_MATCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_MATCH_INL_H_
#undef NDHULL_MATCH_INL_H_
#else
#define NDHULL_MATCH_INL_H_
#endif

#include <cstring>

#include "core/growth/grower-inl.h"
#include "core/growth/row_slots-inl.h"
#include "core/machine/chosen_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

/// The slots through which a turn from the ridge opposite slot k begins on the side that makes it: of the two
/// ends of a turn one is among them.
template <std::size_t D>
HWY_INLINE std::uint32_t slots_to_turn(const std::uint32_t* row, std::uint32_t k) {
  const RowTag<D> tag;
  std::uint32_t rank_is_odd = 0;  // of an id among those of the row
  std::uint32_t inverted = 0;     // an odd number of bits if an odd number of pairs is in the wrong order
  for (std::uint32_t slot = 0; slot < D; ++slot) {
    const auto id = hn::Set(tag, row[slot]);
    const std::uint32_t above =
        slots_where<D, RowHalf::kVertices>(row, [&](auto ids) HWY_ATTR { return hn::Gt(ids, id); });
    rank_is_odd ^= above;
    inverted ^= above & ((1u << slot) - 1);
  }
  const auto last = hn::Set(tag, row[k]);
  const std::uint32_t above =
      slots_where<D, RowHalf::kVertices>(row, [&](auto ids) HWY_ATTR { return hn::Gt(ids, last); });
  const std::uint32_t all = static_cast<std::uint32_t>(__builtin_popcount(inverted)) + (rank_is_odd >> k);
  return (rank_is_odd ^ above ^ (0u - (all & 1u))) & kAllSlots<D> & ~(1u << k);
}

/// Turns on their way: a table a column.
struct Turns {
  static constexpr std::size_t kCapacity = 512;
  static constexpr std::size_t kSpare = 16;  // vectors are stored whole
  std::uint32_t origin[kCapacity + kSpare];  // index of the ridge where it began, times 16, plus slot m
  std::uint32_t from[kCapacity + kSpare];    // visible simplex that is left
  std::uint32_t to[kCapacity + kSpare];      // and the one that is entered
  std::uint32_t pivot[kCapacity + kSpare];   // vertex of the ridge between them that is not in S
  // Those that have ended and are not entered yet.
  std::uint32_t ended[kCapacity];    // their origins
  std::uint32_t partner[kCapacity];  // new simplex that was found
  std::uint32_t back[kCapacity];     // slot of the neighbour in its row
};

constexpr std::size_t kBeforeSlots = 4;  // lanes before the first slot
constexpr std::uint32_t kSlots[kBeforeSlots + 16] = {0, 0, 0, 0, 0,  1,  2,  3,  4,  5,
                                                     6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// Lists the turns of ridge `index` that take a step; origins count from ridge `base`. Returns how many turns
/// there are now.
template <std::size_t D>
HWY_INLINE std::size_t Grower<D>::begin_turns(std::size_t base, std::size_t index, Turns& turns,
                                              std::size_t count) {
  const RowTag<D> tag;
  const std::size_t lanes = hn::Lanes(tag);
  const HorizonRidge ridge = horizon_[index];
  const std::uint32_t visible = visible_[ridge.visible_index];
  const std::uint32_t* ids = vertices(visible);
  const std::uint32_t* around = neighbours(visible);
  const auto new_bit = hn::Set(tag, kNewBit);
  const std::uint32_t is_old = slots_where<D, RowHalf::kNeighbours>(
      ids, [&](auto next) HWY_ATTR { return hn::Eq(hn::And(next, new_bit), hn::Zero(RowTag<D>())); });
  const std::uint32_t going_on = slots_to_turn<D>(ids, ridge.slot) & is_old;
  const auto pivot = hn::Set(tag, ids[ridge.slot]), from = hn::Set(tag, visible);
  const auto origin = hn::Set(tag, static_cast<std::uint32_t>((index - base) * 16));
  const std::size_t before = lanes_before<D, RowHalf::kNeighbours>();
  for (std::size_t begin = 0; begin < D; begin += lanes) {
    const std::size_t start = D > lanes && begin + lanes > D ? D - lanes : begin;  // nothing behind the row
    const std::uint32_t bits = going_on >> begin << (begin + before) >> start & ((1u << lanes) - 1);
    const ChosenLanes chosen(tag, bits);
    const auto here = hn::Or(origin, hn::LoadU(tag, kSlots + kBeforeSlots + start - before));
    hn::StoreU(chosen.to_front(here), tag, turns.origin + count);
    hn::StoreU(chosen.to_front(hn::LoadU(tag, around + start - before)), tag, turns.to + count);
    hn::StoreU(from, tag, turns.from + count);
    hn::StoreU(pivot, tag, turns.pivot + count);
    count += static_cast<std::size_t>(__builtin_popcount(bits));
  }
  return count;
}

/// One step of each turn, then what has ended is entered on both sides: by then the rows, which lie anywhere,
/// have come. Returns how many go on.
template <std::size_t D>
HWY_INLINE std::size_t Grower<D>::step_turns(const std::uint32_t* HWY_RESTRICT rows, Turns& turns,
                                             std::size_t count) {
  std::uint32_t* const topology = topology_;
  std::size_t going_on = 0, ended = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t origin = turns.origin[i], at = turns.to[i];
    const std::uint32_t* ids = topology + std::size_t{at} * 2 * D;
    const std::uint32_t leave = slot_of<D, RowHalf::kVertices>(ids, turns.pivot[i]);
    const std::uint32_t back = slot_of<D, RowHalf::kNeighbours>(ids, turns.from[i]);
    const std::uint32_t next = ids[D + leave], partner = next & ~kNewBit;
    const std::size_t ends = next >> 31;
    turns.ended[ended] = origin;
    turns.partner[ended] = partner;
    turns.back[ended] = back;
    ended += ends;
    turns.origin[going_on] = origin;
    turns.from[going_on] = at;
    turns.to[going_on] = next;
    turns.pivot[going_on] = ids[back];
    going_on += 1 - ends;
    fetch_row<D>(topology, partner);
  }
  for (std::size_t i = 0; i < ended; ++i) {
    const std::uint32_t origin = turns.ended[i], row = rows[origin / 16], partner = turns.partner[i];
    topology[std::size_t{row} * 2 * D + D + origin % 16] = partner;
    topology[std::size_t{partner} * 2 * D + D + turns.back[i]] = row;
  }
  return going_on;
}

template <std::size_t D>
void Grower<D>::match_ridges(std::size_t begin, std::size_t end) {
  constexpr std::size_t kAhead = 8;
  Turns turns;
  std::size_t count = 0;
  for (std::size_t next = begin; next < end || count > 0;) {
    const std::size_t going_on = count;
    while (next < end && count + D <= Turns::kCapacity) {
      if (next + kAhead < end) fetch_row<D>(topology_, visible_[horizon_[next + kAhead].visible_index]);
      count = begin_turns(begin, next++, turns, count);
    }
    for (std::size_t i = going_on; i < count; ++i) fetch_row<D>(topology_, turns.to[i]);
    count = step_turns(new_rows_.data() + begin, turns, count);
  }
}

template <std::size_t D>
void Grower<D>::match_cone() {
  for_many(horizon_count_, [&](std::size_t begin, std::size_t end) { match_ridges(begin, end); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
