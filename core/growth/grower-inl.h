// One insertion, for one dimension and one instruction set: visible set, horizon, cone, matching, partition.
// Included once per target by growth_kernels.cpp.
//
// Idea. A simplex is kept as its dual vertex a (a.y = 1 on it). The apex p sees it iff a.p - 1 > 0. Over the
// horizon ridge between a visible f and a hidden g the new dual vertex is where the dual edge (a_f, a_g)
// meets the plane of p: a = a_f + t (a_g - a_f), t = v_f / (v_f - v_g). That is a convex combination, so the
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
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/growth/growth.h"
#include "core/growth/growth_region.h"
#include "core/growth/phase_clock.h"
#include "core/growth/sharing_choice.h"
#include "core/growth/staged_table.h"
#include "core/machine/blocks.h"
#include "core/machine/team.h"
#include "core/scramble.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Gauge of y above the simplex with this plane: a.y - 1, in two chains of fused multiply-adds: of even and of odd coordinates.
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

template <class Tag, class Vec = hn::Vec<Tag>>
HWY_INLINE Vec scramble_lanes(Tag tag, Vec x) {  // scramble, of each lane
  x = hn::Add(x, hn::Set(tag, kScrambleStep));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<30>(x)), hn::Set(tag, 0xBF58'476D'1CE4'E5B9u));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<27>(x)), hn::Set(tag, 0x94D0'49BB'1331'11EBu));
  return hn::Xor(x, hn::ShiftRight<31>(x));
}

constexpr std::uint32_t kNewBit = 0x8000'0000u;  // marks, in a visible simplex, the new one over its ridge
constexpr std::uint32_t kNoRow = 0xFFFF'FFFFu;

/// A ridge where the visible set ends.
struct HorizonRidge {
  std::uint32_t visible_index;  // into the visible list
  std::uint16_t slot;           // the ridge is opposite this vertex of the visible simplex
  std::uint16_t hidden_slot;    // and of the hidden one; known once the cone is committed
  std::uint32_t hidden;         // simplex on the other side
};

/// Where a search appends what it finds.
struct SearchResult {
  std::uint32_t* visible;
  double* gauge;  // of the visible ones
  HorizonRidge* horizon;
  std::size_t visible_count, horizon_count;
  double lowest, highest;  // smallest gauge tested above the threshold, largest not above it
  bool is_cut;             // it met a simplex that is not of the region
};

/// One of the parts of a wave that several threads search from.
struct SearchShare {
  HugeArray<std::uint8_t> marks;  // the first share has those of the search by one thread
  HugeArray<std::uint32_t> visible;
  HugeArray<double> gauge;
  HugeArray<HorizonRidge> horizon;
  SearchResult result;
  std::size_t kept = 0;                   // of the visible ones: not found by a lower share
  HugeArray<std::uint32_t> kept_visible;  // these, where their place is not known at once
  HugeArray<double> kept_gauge;
};

template <std::size_t D>
struct FirstMet;

/// Where an outside point goes; row kNoRow: it is inside.
struct NewPlace {
  std::uint32_t row;
  double height, gauge;
};

struct Turns;

template <std::size_t D>
class Grower {
 public:
  explicit Grower(GrowthWork& work)
      : Grower(
            work, team_threads(kMostThreads), nullptr,
            {work.free_rows, work.free_count, work.complex.row_count, work.points_outside, work.counters}) {}
  ~Grower();

  GrowthStop run();
  bool may_go_on() const;

 private:
  /// What one grower alone changes. Regions that grow at the same time have each their own.
  struct Books {
    HugeArray<std::uint32_t>& free_rows;
    std::size_t &free_count, &row_count;
    std::uint64_t& points_outside;
    GrowthCounters& counters;
  };

  Grower(GrowthWork& work, std::size_t threads, GrowthRegion* region, Books books)
      : work_(work),
        region_(region),
        books_(books),
        points_(work.points),
        most_rows_(most_rows(D)),
        stages_{most_rows_, work.options.foreseen_rows},
        threads_(threads) {
    take_places(0);
  }

  // From how many elements on a loop is shared. Which loops are shared, and in what blocks, changes no
  // result.
  static constexpr std::size_t kManyVisible = 128, kManyRidges = 384, kRidgesInBlock = 96;
  // More would spend their time on marking what the others found.
  static constexpr std::size_t kMostThreads = 8;

  double* plane(std::uint32_t row) { return planes_ + std::size_t{row} * D; }
  std::uint32_t* vertices(std::uint32_t row) { return topology_ + std::size_t{row} * 2 * D; }
  std::uint32_t* neighbours(std::uint32_t row) { return topology_ + std::size_t{row} * 2 * D + D; }
  const double* point(std::uint32_t id) const { return points_ + std::size_t{id} * D; }

  template <bool kInRegion>
  void find_visible(const double* apex, std::uint32_t seed, double threshold);
  void next_marks();
  std::uint8_t visible_mark() const { return static_cast<std::uint8_t>(hidden_mark_ + 1); }
  std::uint8_t duplicate_mark() const { return static_cast<std::uint8_t>(hidden_mark_ + 2); }
  std::uint8_t* share_marks(std::size_t s) { return s == 0 ? marks_.data() : shares_[s].marks.data(); }
  void make_shares();
  void make_share(std::size_t s, std::size_t kept);
  void mark_found_alone(std::uint8_t* marks);
  void merge_share(std::size_t s);
  void search_wave(const double* apex, double threshold, std::size_t begin, std::size_t end);
  template <bool kInRegion>
  std::size_t search(const double* apex, double threshold, std::uint8_t* marks, std::size_t begin,
                     std::size_t end, SearchResult& result);
  void list_first_met(std::uint8_t* marks, std::size_t begin, std::size_t end, FirstMet<D>& met);
  template <bool kInRegion>
  void test_first_met(const double* apex, double threshold, std::uint8_t* marks, const FirstMet<D>& met,
                      SearchResult& result);
  void collect_horizon(const std::uint8_t* marks, std::size_t begin, std::size_t end, SearchResult& result);
  void make_cone(std::uint32_t apex, double shift);
  void make_ridges(std::uint32_t apex, double shift, std::size_t begin, std::size_t end);
  void touch_new_rows();
  void clear_new_rows();
  void join_siblings(std::size_t index);
  std::size_t first_sibling(std::size_t index) const;
  void match_cone();
  void match_ridges(std::size_t begin, std::size_t end);
  std::size_t begin_turns(std::size_t base, std::size_t index, Turns& turns, std::size_t count);
  std::size_t step_turns(const std::uint32_t* rows, Turns& turns, std::size_t count);
  void undo_cone();
  void commit();
  void find_hidden_slots(std::size_t begin, std::size_t end);
  void join_hidden(std::size_t begin, std::size_t end);
  void partition(std::uint32_t apex);
  void free_visible(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& with_points);
  void place_moved();
  /// Runs work(begin, end) on all of [0, count), shared when they are many.
  template <class Work>
  void for_many(std::size_t count, const Work& work) {
    if (shares_loops() && count >= kManyRidges) {
      const std::size_t shares = 4 * team_->threads();
      team_->for_each_block(count, std::max(kRidgesInBlock, (count + shares - 1) / shares), work);
    } else {
      work(std::size_t{0}, count);
    }
  }
  bool has_team();
  bool shares_loops() const { return is_shared_ && team_; }
  void share_searches();
  enum class Outcome { kAdded, kRejected, kNoRoom, kPastLimit };
  Outcome insert(std::uint32_t apex, std::uint32_t seed);
  Outcome insert_timed(std::uint32_t apex, std::uint32_t seed);
  double draw_shift(std::uint32_t apex_id, unsigned attempt) const;
  bool room_for_cone();
  std::size_t rows_for_cone() const;
  std::size_t rows_with_room() const { return work_.complex.state.capacity(); }
  void make_place_for(std::size_t rows);
  void take_places(std::size_t kept);
  std::size_t row_end() const;
  std::size_t live_rows() const { return books_.row_count - books_.free_count; }
  bool cone_is_sphere();
  std::size_t list_subridges(std::size_t index, std::uint64_t* keys, std::size_t count);
  bool subridges_differ();
  bool cone_is_connected();
  template <bool kInRegion>
  std::uint32_t locate(const double* y, std::uint32_t row, double& gauge);
  /// By which the next point is chosen.
  OutsideHeights& order() { return work_.options.by_gauge ? work_.gauges : work_.heights; }
  void put_outside(std::uint32_t id, const NewPlace& place);
  void take_outside(std::uint32_t id);

  void list_gauges();
  bool is_to_pause(double furthest) const;
  bool has_made_enough() const;
  double least_height_for_regions();
  std::size_t rows_before_pause() const;
  bool may_grow_in_regions();
  bool grow_in_regions(double furthest);
  void make_regions();
  double& clearance_of(const GrowthRegion& region) {
    return work_.parting.clearances[static_cast<std::size_t>(&region - regions_.data())];
  }
  void list_apexes(double furthest);
  void wait_for_parting();
  RegionBorder choose_border(std::uint64_t direction, std::size_t stride);
  bool part_into_regions(double furthest);
  std::size_t most_lent_rows() const { return live_rows() / 8; }  // to each region
  void lend_rows();
  void join_regions(double seconds);
  void grow_region();
  bool insert_in_region(std::uint32_t apex_id, std::uint32_t row);
  bool is_in_region(const double* record) const;
  bool cone_is_in_region() const;

  GrowthWork& work_;
  GrowthRegion* const region_;  // null: all of space
  const Books books_;
  double* planes_ = nullptr;
  std::uint32_t* topology_ = nullptr;
  SimplexState* state_ = nullptr;
  std::uint32_t* head_ = nullptr;
  const double* points_;

  HugeArray<std::uint32_t> visible_;
  HugeArray<double> visible_gauge_;
  HugeArray<HorizonRidge> horizon_;
  HugeArray<std::uint32_t> new_rows_;
  const std::size_t most_rows_;
  const TableStages stages_;
  std::size_t threads_;
  std::unique_ptr<Team> team_;  // from the first loop on that other threads can help with
  std::vector<SearchShare> shares_;
  SharingChoice sharing_;
  bool is_shared_ = true;                                // the loops of this insertion, where they are long
  std::size_t touched_rows_ = 0;                         // rows that have memory, as far as is known
  std::size_t cleared_rows_ = 0;                         // rows whose heads and marks are 0
  std::size_t shared_visible_ = 0, shared_horizon_ = 0;  // found when all shares last had the same marks
  // Per row: hidden_mark_ when this search has met it and it is hidden, one more when it is visible, less
  // when it was not met.
  HugeArray<std::uint8_t> marks_;
  std::uint8_t hidden_mark_ = 1;
  std::vector<std::vector<std::uint32_t>> emptied_;  // freed simplices that had points outside, a list a part
  std::vector<std::uint32_t> moved_;                 // points whose simplices are gone
  std::vector<NewPlace> new_places_;
  std::size_t visible_count_ = 0, horizon_count_ = 0, new_count_ = 0;
  bool is_cut_ = false;                       // the last search ended at the region's border
  double lowest_visible_ = 0.0;               // smallest gauge tested above the threshold
  double highest_hidden_ = 0.0;               // largest gauge tested not above it
  std::vector<std::uint64_t> subridge_keys_;  // XOR of random keys of the vertices; 0: free
  std::vector<std::uint64_t> subridges_late_;
  std::vector<std::uint32_t> cone_walk_;

  std::vector<GrowthRegion> regions_;  // none before it pays
  std::vector<std::unique_ptr<Grower>> in_regions_;
  std::vector<std::uint32_t> high_;
  std::vector<RegionApex> apexes_;      // points that may be added by regions
  std::vector<double> duals_, values_;  // of their simplices
};

// Between one and two of the shift. Mostly rising from point to point: a point on the plane of simplices made
// before is then moved below most of them, and they stay (on cubes that halves what is made). Partly random:
// were the shift an affine function of the coordinates, points on one plane would stay on one plane.
template <std::size_t D>
double Grower<D>::draw_shift(std::uint32_t apex_id, unsigned attempt) const {
  const std::uint64_t random =
      scramble(work_.options.seed ^ scramble((std::uint64_t{apex_id} << 8) + attempt));
  const double chance = static_cast<double>(random >> 11) * 0x1p-53;
  const double inserted = static_cast<double>(books_.counters.insertions);
  constexpr double kRising = 0.85;     // of the interval; the rest is left to chance
  constexpr double kHalfRisen = 64.0;  // insertions
  return work_.options.shift *
         (1.0 + kRising * inserted / (inserted + kHalfRisen) + (1.0 - kRising) * chance);
}

template <std::size_t D>
typename Grower<D>::Outcome Grower<D>::insert(std::uint32_t apex_id, std::uint32_t seed) {
  constexpr unsigned kAttempts = 8;
  const double low = work_.options.shift;
  PhaseClock clock(work_.measure_phases);
  for (unsigned attempt = 0; attempt < kAttempts; ++attempt) {
    double shift = draw_shift(apex_id, attempt);
    find_visible<false>(point(apex_id), seed, shift);
    clock.lap(books_.counters.seconds_visible);
    if (!room_for_cone()) return Outcome::kNoRoom;
    if (work_.options.max_rows != 0 &&
        live_rows() + horizon_count_ - visible_count_ > work_.options.max_rows) {
      return Outcome::kPastLimit;
    }
    // No gauge near 0: the visible set is the same without a shift, and certain.
    const bool certain = lowest_visible_ > 2.0 * low && highest_hidden_ < -low;
    if (certain) shift = 0.0;
    make_place_for(rows_for_cone());
    share_searches();
    make_cone(apex_id, shift);
    clock.lap(books_.counters.seconds_cone);
    match_cone();
    const bool sound = certain || (horizon_count_ > 0 && cone_is_sphere());
    clock.lap(books_.counters.seconds_match);
    if (!sound) {
      ++books_.counters.rejected;
      books_.counters.undone += new_count_;
      undo_cone();
      continue;
    }
    commit();
    books_.counters.created += new_count_;
    ++books_.counters.insertions;
    if (shift > 0.0) work_.shifted_points.push_back(apex_id);
    clock.lap(books_.counters.seconds_match);
    partition(apex_id);
    clock.lap(books_.counters.seconds_partition);
    return Outcome::kAdded;
  }
  return Outcome::kRejected;
}

template <std::size_t D>
bool Grower<D>::is_to_pause(double furthest) const {
  const GrowthOptions& options = work_.options;
  return options.pause_rows != 0 && live_rows() >= options.pause_rows && furthest <= options.pause_height;
}

template <std::size_t D>
bool Grower<D>::has_made_enough() const {
  const std::uint64_t enough = work_.options.pause_made;
  return enough != 0 && books_.counters.made() >= enough &&
         2 * work_.shifted_points.size() >= books_.counters.insertions;
}

template <std::size_t D>
GrowthStop Grower<D>::run() {
  std::uint64_t polled_at = 0;
  if (work_.options.by_gauge) list_gauges();
  for (;;) {
    const OutsideHeights::Furthest furthest = work_.heights.furthest();
    if (furthest.height <= least_height(work_)) return GrowthStop::kNoOutsidePoints;
    if (is_to_pause(furthest.height)) {
      work_.options.pause_rows = 0;
      return GrowthStop::kPaused;
    }
    if (has_made_enough()) {
      work_.options.pause_made = 0;
      return GrowthStop::kPaused;
    }
    if (work_.options.poll && books_.counters.made() >= polled_at) {
      const GrowthStop stop = work_.options.poll(books_.points_outside, furthest.height);
      if (stop != GrowthStop::kNoOutsidePoints) return stop;
      polled_at = books_.counters.made() + 4096;
    }
    const OutsideHeights::Furthest next = work_.options.by_gauge ? work_.gauges.furthest() : furthest;
    if (may_grow_in_regions() && grow_in_regions(next.height)) continue;
    const std::uint32_t apex_id = head_[next.row] - 1;
    switch (insert_timed(apex_id, next.row)) {
      case Outcome::kAdded: break;
      case Outcome::kNoRoom: return GrowthStop::kMemoryLimit;
      case Outcome::kPastLimit: return GrowthStop::kFacetLimit;
      case Outcome::kRejected:  // certify will measure what it costs
        ++books_.counters.set_aside;
        take_from_outside(work_, apex_id);
        if (work_.options.by_gauge) work_.gauges.remove(apex_id);
        break;
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
