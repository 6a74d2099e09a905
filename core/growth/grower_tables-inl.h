// The tables of a grower: how many rows they may have, and what moves when they are full. Included once per
// target by growth_kernels.cpp.
//
// Nothing that a search has found is lost when tables move between a search and its cone. Regions hold the
// addresses of the tables, so there tables move before regions grow, when there is no room for all rows that
// these may be lent.

#if defined(NDHULL_GROWER_TABLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_GROWER_TABLES_INL_H_
#undef NDHULL_GROWER_TABLES_INL_H_
#else
#define NDHULL_GROWER_TABLES_INL_H_
#endif

#include "core/growth/grower-inl.h"
#include "core/growth/staged_table.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

template <std::size_t D>
std::size_t Grower<D>::row_end() const {
  if (region_ != nullptr) return region_->row_end;
  const std::size_t most = work_.options.most_table_rows;
  return most != 0 ? std::min(most, most_rows_) : most_rows_;
}

/// Rows in use or free when the cone will be there.
template <std::size_t D>
std::size_t Grower<D>::rows_for_cone() const {
  return books_.row_count + (horizon_count_ > books_.free_count ? horizon_count_ - books_.free_count : 0);
}

template <std::size_t D>
bool Grower<D>::room_for_cone() {
  return rows_for_cone() <= row_end();
}

/// Before it goes on: are points and tables where they were, and as many threads to be had?
template <std::size_t D>
bool Grower<D>::may_go_on() const {
  const SimplicialComplex& complex = work_.complex;
  return points_ == work_.points && threads_ == team_threads(kMostThreads) &&
         planes_ == complex.planes.data() && topology_ == complex.topology.data() &&
         state_ == complex.state.data() && head_ == complex.outside_head.data();
}

/// Moves all tables if there is no room in them for so many rows. What a search has found is kept.
template <std::size_t D>
void Grower<D>::make_place_for(std::size_t rows) {
  if (rows <= rows_with_room()) return;
  in_regions_.clear();  // their tables are made again
  make_room_for(work_, rows);
  take_places(books_.row_count);
}

/// Tables as large as those of the complex; its first `kept` rows were there before.
template <std::size_t D>
void Grower<D>::take_places(std::size_t kept) {
  SimplicialComplex& complex = work_.complex;
  const std::size_t rows = rows_with_room();
  planes_ = complex.planes.data();
  topology_ = complex.topology.data();
  state_ = complex.state.data();
  head_ = complex.outside_head.data();
  move_list(visible_, stages_, visible_count_, rows);
  move_list(visible_gauge_, stages_, visible_count_, rows);
  move_list(horizon_, stages_, horizon_count_, rows, D);
  move_list(new_rows_, stages_, 0, rows);
  move_and_clear(marks_, stages_, kept, rows);
  for (std::size_t s = 0; s < shares_.size(); ++s) make_share(s, kept);
  touched_rows_ = cleared_rows_ = kept;
}

/// From the first large insertion on searches are shared.
template <std::size_t D>
void Grower<D>::share_searches() {
  if (is_shared_ && shares_.empty() && horizon_count_ >= kManyRidges && has_team()) make_shares();
}

/// Shares of a wave: one for each thread, with the marks of all searches so far.
template <std::size_t D>
void Grower<D>::make_shares() {
  shares_.resize(team_->threads());
  for (std::size_t s = 0; s < shares_.size(); ++s) make_share(s, 0);
}

/// Its tables, as large as those of the complex; marks of the first `kept` rows stay.
template <std::size_t D>
void Grower<D>::make_share(std::size_t s, std::size_t kept) {
  const std::size_t rows = rows_with_room();
  SearchShare& share = shares_[s];
  if (s > 0) move_and_clear(share.marks, stages_, kept, rows);
  move_list(share.visible, stages_, 0, rows);
  move_list(share.gauge, stages_, 0, rows);
  move_list(share.horizon, stages_, 0, rows, D);
  if (s < 2) return;
  move_list(share.kept_visible, stages_, 0, rows);
  move_list(share.kept_gauge, stages_, 0, rows);
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
