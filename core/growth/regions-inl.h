// Points far apart, added side by side. Included once per target by growth_kernels.cpp.
//
// Idea. A plane parts the dual vertices of all simplices into two regions. One inserts points whose visible
// and hidden simplices are all on its side; a search that meets a simplex of the other side is given up. So a
// simplex with a neighbour on the other side is never removed, and each side reads of the other no more than
// the planes of such simplices. What is made lies between visible and hidden dual vertices, hence on the same
// side. Any number of insertions need no word between the two threads.
//
// Which points are tried, on which side and in which order is known before, so the result is the same for any
// number of threads. Each parting has a plane in another direction; points near it wait for a later one.

#if defined(NDHULL_REGIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_REGIONS_INL_H_
#undef NDHULL_REGIONS_INL_H_
#else
#define NDHULL_REGIONS_INL_H_
#endif

#include <algorithm>
#include <numeric>

#include "core/growth/grower-inl.h"
#include "core/growth/staged_table.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

/// Insertions that are worth parting for, and that each region may make however few points it has.
constexpr double kFewInserted = 16.0;

/// On which side of the border between regions a dual vertex is.
HWY_INLINE double region_value(const RegionBorder& border, const double* record) {
  return __builtin_fma(border.weights[1], record[border.axes[1]], border.weights[0] * record[border.axes[0]]);
}

template <std::size_t D>
Grower<D>::~Grower() = default;

template <std::size_t D>
HWY_INLINE bool Grower<D>::is_in_region(const double* record) const {
  return region_value(region_->border, record) > region_->border.least;
}

template <std::size_t D>
void Grower<D>::put_outside(std::uint32_t id, const NewPlace& place) {
  const bool by_gauge = work_.options.by_gauge;
  if (region_ == nullptr) {
    if (by_gauge) work_.gauges.put(id, place.row, place.gauge);
    return push_outside(work_, id, place.row, place.height);
  }
  work_.heights.put_apart(id, place.row, place.height);
  if (by_gauge) work_.gauges.put_apart(id, place.row, place.gauge);
  link_outside(work_, id, place.row, place.height);
  region_->written.push_back(id);
  ++region_->points_outside;
}

template <std::size_t D>
void Grower<D>::take_outside(std::uint32_t id) {
  const bool by_gauge = work_.options.by_gauge;
  if (region_ == nullptr) {
    if (by_gauge) work_.gauges.remove(id);
    return work_.heights.remove(id);
  }
  work_.heights.put_apart(id, 0, OutsideHeights::kNotOutside);
  if (by_gauge) work_.gauges.put_apart(id, 0, OutsideHeights::kNotOutside);
  region_->written.push_back(id);
}

/// No lower point may be added: while growth is to come down to a height before it may pause, or below what
/// counts as outside.
template <std::size_t D>
double Grower<D>::least_height_for_regions() {
  const GrowthOptions& options = work_.options;
  const bool is_to_come_down =
      options.pause_rows != 0 && work_.heights.furthest().height > options.pause_height;
  return std::max(least_height(work_), is_to_come_down ? options.pause_height : 0.0);
}

/// Simplices that regions may make, not to have many more than those growth is to pause at.
template <std::size_t D>
std::size_t Grower<D>::rows_before_pause() const {
  if (work_.options.pause_rows <= live_rows()) return SIZE_MAX;
  return work_.options.pause_rows - live_rows();
}

/// Is the hull large beside its insertions, and general?
template <std::size_t D>
bool Grower<D>::may_grow_in_regions() {
  constexpr std::size_t kLeastRows = 8192, kLeastRidges = 40, kLookedAt = 64;
  const std::uint64_t insertions = books_.counters.insertions;
  if (!work_.options.in_regions || insertions < work_.parting.next_at || live_rows() < kLeastRows)
    return false;
  if (!work_.shifted_points.empty()) return false;
  // With distances, an insertion among so many points is mostly placing them, which all threads do together.
  const bool has_distances = !work_.options.gradient_factor.empty();
  if (has_distances && books_.points_outside > live_rows()) return false;
  const std::uint64_t created = books_.counters.created - work_.parting.created_at;
  const std::uint64_t looked_at = insertions - work_.parting.looked_at;
  if (looked_at >= kLookedAt) {
    work_.parting.looked_at = insertions;
    work_.parting.created_at = books_.counters.created;
    work_.parting.ridges = static_cast<double>(created) / static_cast<double>(looked_at);
    work_.parting.pays = created * kLeastRidges <= live_rows() * looked_at;
  }
  return work_.parting.pays && static_cast<double>(rows_before_pause()) > kFewInserted * work_.parting.ridges;
}

template <std::size_t D>
bool Grower<D>::grow_in_regions(double furthest) {
  constexpr std::uint64_t kFewInsertions = 8;
  make_place_for(std::min(books_.row_count + kRegions * most_lent_rows(), row_end()));
  if (in_regions_.empty()) make_regions();
  if (!part_into_regions(furthest)) {
    wait_for_parting();
    return false;
  }
  lend_rows();
  PhaseClock clock(work_.measure_phases);
  const auto grow_part = [&](std::size_t r, std::size_t) { in_regions_[r]->grow_region(); };
  if (has_team()) {
    team_->for_each_block(kRegions, 1, grow_part);
  } else {
    for (std::size_t r = 0; r < kRegions; ++r) grow_part(r, r + 1);
  }
  double seconds = 0.0;
  clock.lap(seconds);
  const std::uint64_t before = books_.counters.insertions;
  join_regions(seconds);
  if (books_.counters.insertions < before + kFewInsertions) {
    wait_for_parting();
  } else {
    work_.parting.alone = PartingRecord::kLeastAlone;
  }
  return true;
}

/// Points are added one by one for a while, which is longer each time: to look for a border costs about as
/// much as to add one.
template <std::size_t D>
void Grower<D>::wait_for_parting() {
  constexpr std::uint64_t kMostAlone = 256;
  PartingRecord& parting = work_.parting;
  parting.next_at = books_.counters.insertions + parting.alone;
  parting.alone = std::min(2 * parting.alone, kMostAlone);
}

template <std::size_t D>
void Grower<D>::make_regions() {
  regions_.resize(kRegions);
  for (GrowthRegion& region : regions_) {
    move_list(region.free_rows, stages_, 0, rows_with_room());
    in_regions_.emplace_back(new Grower(
        work_, 1, &region,
        {region.free_rows, region.free_count, region.row_count, region.points_outside, region.counters}));
  }
}

/// The heads of outside sets that are among the furthest points.
template <std::size_t D>
void Grower<D>::list_apexes(double furthest) {
  constexpr std::size_t kMany = 512, kPartOfPoints = 16;
  high_.clear();
  const double band_floor = (1.0 - work_.parting.band) * furthest, least = least_height_for_regions();
  order().list_above(band_floor, high_);
  for (GrowthRegion& region : regions_) {
    region.band_floor = band_floor;
    region.least_height = least;
  }
  apexes_.clear();
  duals_.clear();
  for (const std::uint32_t id : high_) {
    const std::uint32_t row = work_.heights.row(id);
    if (head_[row] != id + 1 || work_.heights.height(id) <= least) continue;
    const double* record = plane(row);
    const double length_sq = std::inner_product(record, record + D, record, 0.0);
    const double gauge = std::max(0.0, gauge_above<D>(record, point(id)));
    apexes_.push_back({id, order().height(id), std::sqrt(length_sq * gauge), 0.0});
    duals_.insert(duals_.end(), record, record + D);
  }
  const std::size_t wanted = std::max<std::size_t>(kMany, books_.points_outside / kPartOfPoints);
  if (apexes_.size() < wanted / 2) {
    work_.parting.band = std::min(PartingRecord::kWidestBand, work_.parting.band * 1.25);
  } else if (apexes_.size() > 2 * wanted) {
    work_.parting.band *= 0.8;
  }
}

/// A plane of this direction between the points that may be added, in the middle of every stride-th of them.
template <std::size_t D>
RegionBorder Grower<D>::choose_border(std::uint64_t direction, std::size_t stride) {
  RegionBorder border;
  border.axes[0] = direction % D;
  border.axes[1] = (border.axes[0] + 1 + (direction >> 8) % (D - 1)) % D;
  border.weights[1] = (direction >> 16) % 3 == 0 ? 0.0 : (direction >> 24) % 2 == 0 ? 1.0 : -1.0;
  values_.clear();
  for (std::size_t i = 0; i < apexes_.size(); i += stride) {
    apexes_[i].value = region_value(border, duals_.data() + i * D);
    values_.push_back(apexes_[i].value);
  }
  const auto middle = values_.begin() + static_cast<std::ptrdiff_t>(values_.size() / 2);
  std::nth_element(values_.begin(), middle, values_.end());
  border.least = *middle;
  return border;
}

/// Chooses a plane between the furthest points and lists those of each side; false: they are too few.
template <std::size_t D>
bool Grower<D>::part_into_regions(double furthest) {
  constexpr std::size_t kFew = 32, kTrials = 4, kSample = 128;
  list_apexes(furthest);
  if (apexes_.size() < kFew) {
    work_.parting.band = PartingRecord::kWidestBand;
    return false;
  }
  const std::size_t stride = 1 + apexes_.size() / kSample;
  const auto side_of = [&](const RegionApex& apex, double least) -> GrowthRegion* {
    GrowthRegion& region = regions_[apex.value > least ? 0 : 1];
    const double clearance = clearance_of(region);
    return std::abs(apex.value - least) > clearance * apex.reach ? &region : nullptr;
  };
  std::uint64_t best = 0;
  std::size_t most = 0;
  for (std::size_t trial = 0; trial < kTrials; ++trial) {
    const std::uint64_t direction = scramble(work_.options.seed ^ scramble(++work_.parting.partings));
    const double least = choose_border(direction, stride).least;
    std::size_t counts[kRegions] = {0, 0};
    for (std::size_t i = 0; i < apexes_.size(); i += stride)
      if (const GrowthRegion* region = side_of(apexes_[i], least)) ++counts[region - regions_.data()];
    const std::size_t count = std::min(counts[0], counts[1]);
    if (count <= most) continue;
    most = count;
    best = direction;
  }
  if (most * stride < kFew / 2) return false;
  const RegionBorder border = choose_border(best, 1);
  regions_[0].border = border;
  regions_[1].border = border.reversed();
  for (GrowthRegion& region : regions_) region.apexes.clear();
  for (RegionApex& apex : apexes_)
    if (GrowthRegion* region = side_of(apex, border.least))
      region->apexes.push_back({apex.point, apex.height, apex.reach, apex.value - border.least});
  most = std::min(regions_[0].apexes.size(), regions_[1].apexes.size());
  if (most < kFew / 2) return false;
  for (GrowthRegion& region : regions_) {
    sort_by_height(region.apexes);
    region.apexes.resize(most);
    region.clearance = clearance_of(region);
  }
  return true;
}

/// Parts the free rows, and as many that were never used as may be needed.
template <std::size_t D>
void Grower<D>::lend_rows() {
  constexpr double kPartAdded = 0.5;
  const double listed = static_cast<double>(regions_[0].apexes.size());
  const auto wanted =
      static_cast<std::size_t>(work_.parting.ridges * std::max(kFewInserted, kPartAdded * listed));
  const std::size_t most = std::min({wanted, most_lent_rows(), rows_before_pause() / kRegions});
  const std::size_t half = books_.free_count / kRegions;
  const std::size_t unused = std::min(most - std::min(most, half), (row_end() - books_.row_count) / kRegions);
  const std::uint32_t* from = books_.free_rows.data();
  std::size_t row = books_.row_count;
  for (GrowthRegion& region : regions_) {
    const bool is_last = &region == &regions_.back();
    region.most_created = most;
    region.free_count = is_last ? books_.free_count - half * (kRegions - 1) : half;
    std::copy_n(from, region.free_count, region.free_rows.data());
    from += region.free_count;
    region.row_count = row;
    region.row_end = row += unused;
    region.points_outside = 0;
    region.counters = {};
    region.written.clear();
    region.halted.clear();
  }
  for (std::size_t i = 0; i < books_.free_count; ++i) state_[books_.free_rows[i]] = SimplexState::kLive;
}

/// Rows, counters and heights of all regions. `seconds`: how long they took.
template <std::size_t D>
void Grower<D>::join_regions(double seconds) {
  double clocked = 0.0;
  for (const GrowthRegion& region : regions_) clocked += region.counters.seconds();
  const double share = clocked > 0.0 ? seconds / clocked : 0.0;
  std::size_t row = books_.row_count;
  books_.free_count = 0;
  const auto give_back = [&](std::uint32_t free_row) {
    state_[free_row] = SimplexState::kFree;
    books_.free_rows[books_.free_count++] = free_row;
  };
  for (GrowthRegion& region : regions_) {
    for (; row < region.row_count; ++row) state_[row] = SimplexState::kLive;
    if (&region != &regions_.back()) {  // what it has not used lies before rows that the next one has used
      for (row = region.row_end; row > region.row_count; --row)
        give_back(static_cast<std::uint32_t>(row - 1));
      row = region.row_end;
    }
    books_.counters.add(region.counters, share);
    books_.points_outside += region.points_outside;
    for (const std::uint32_t id : region.written) work_.heights.settle(id);
    if (work_.options.by_gauge)
      for (const std::uint32_t id : region.written) work_.gauges.settle(id);
    clearance_of(region) = region.clearance;
  }
  books_.row_count = row;
  for (const GrowthRegion& region : regions_)
    for (std::size_t i = 0; i < region.free_count; ++i) give_back(region.free_rows[i]);
  for (const GrowthRegion& region : regions_) {
    for (const HaltedPoint& halted : region.halted) {
      double gauge = 0.0;
      const std::uint32_t found = locate<false>(point(halted.point), halted.row, gauge);
      if (gauge <= 2.0 * work_.options.shift) continue;
      const double height = height_above(work_, found, gauge);
      if (height > least_height(work_)) put_outside(halted.point, {found, height, gauge});
    }
  }
}

/// Adds the points listed, the furthest first, as far as they are clear of the border.
template <std::size_t D>
void Grower<D>::grow_region() {
  // In the long run one of so many attempts fails.
  constexpr double kBackAfterFailure = 0.1, kOnAfterSuccess = 0.01;
  for (const RegionApex& apex : region_->apexes) {
    if (region_->counters.created >= region_->most_created) return;
    if (std::abs(apex.value) < region_->clearance * apex.reach) continue;
    if (work_.heights.height(apex.point) == OutsideHeights::kNotOutside) continue;
    const std::uint32_t row = work_.heights.row(apex.point), head = head_[row] - 1;
    if (order().height(head) <= region_->band_floor) continue;
    if (work_.heights.height(head) <= region_->least_height) continue;
    if (insert_in_region(head, row)) {
      region_->clearance = std::max(0.0, region_->clearance - kOnAfterSuccess);
    } else {
      region_->clearance += kBackAfterFailure;
    }
  }
}

/// As `insert`. False when it is not for the region to decide: near the border, or when a gauge is near 0.
template <std::size_t D>
bool Grower<D>::insert_in_region(std::uint32_t apex_id, std::uint32_t seed) {
  const double low = work_.options.shift;
  PhaseClock clock(work_.measure_phases);
  find_visible<true>(point(apex_id), seed, low);
  clock.lap(books_.counters.seconds_visible);
  if (is_cut_ || lowest_visible_ <= 2.0 * low || highest_hidden_ >= -low || !room_for_cone()) return false;
  make_cone(apex_id, 0.0);
  clock.lap(books_.counters.seconds_cone);
  if (!cone_is_in_region()) {
    undo_cone();
    return false;
  }
  match_cone();
  commit();
  books_.counters.created += new_count_;
  ++books_.counters.insertions;
  ++books_.counters.in_regions;
  clock.lap(books_.counters.seconds_match);
  partition(apex_id);
  clock.lap(books_.counters.seconds_partition);
  return true;
}

/// Rounding may have moved what is made over the border, where planes are much longer than their neighbours'.
template <std::size_t D>
bool Grower<D>::cone_is_in_region() const {
  bool is_in = true;
  for (std::size_t i = 0; i < new_count_; ++i) is_in &= is_in_region(planes_ + std::size_t{new_rows_[i]} * D);
  return is_in;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
