// Growth with a proof for every point: steps 2 and 3 of the driver.
#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "approx/facets/facet_table.h"
#include "approx/growth/begun_hull.h"
#include "approx/growth/work_limits.h"
#include "approx/hull.h"
#include "approx/work_end.h"
#include "core/complex/membership.h"
#include "core/frame.h"
#include "core/growth/growth.h"
#include "core/points.h"

namespace ndhull {

/// One hull while it grows.
///
/// Use      grow_exactly(); or grow_to(...) as often as wanted, then locate_left_out().
/// Numbers  status, counts and seconds go into the Hull that is given.
class CertifiedGrowth {
 public:
  using Clock = std::chrono::steady_clock;

  /// gradient_factor: as GrowthOptions; empty for the exact hull. `hull` must outlive this.
  CertifiedGrowth(const PointView& points, const Frame& frame, std::vector<double> gradient_factor,
                  const HullOptions& options, Clock::time_point start, Hull& hull);

  /// Before growth: it does not begin with a simplex. `begun` is of this frame, and of some of the points.
  void go_on_from(BegunHull begun);

  /// Until no point is outside: every one is proven inside, or goes back and growth goes on, at most a few
  /// rounds. Returns true when the hull was found otherwise instead.
  bool grow_exactly();

  /// Before growth: `find` is asked now and then, with the simplices made so far, while most points that are
  /// added lie on planes of others. Does it have the exact hull? Then growth ends as if it were limited.
  void ask_otherwise(std::function<bool(std::uint64_t)> find) { find_otherwise_ = std::move(find); }
  bool is_found_otherwise() const { return is_found_otherwise_; }

  /// Until no point is more than `outside_width` above the simplex it lies over, or there are `enough_rows`
  /// simplices (0: no end there) and no point is more than `enough_height` above, or a limit is hit.
  /// Returns true in the first case.
  bool grow_to(double outside_width, std::uint64_t enough_rows, double enough_height);

  /// Before growth: where points are many and hardly any is inside, some are grown from, spread evenly. The
  /// others are left out wherever they are, until they are put back.
  void grow_from_some();

  /// Proves for all points that are no vertices where they are; what is not well inside becomes left_out().
  /// Gauges may be this much too large. [ratio]
  void locate_left_out(double useful_slack);
  /// Points that may be on or above the hull, ascending: those that were not proven inside early on.
  std::vector<PointId> unproven_points() const;
  /// Those of left_out(), with the vertices or without, ascending. Valid after locate_left_out.
  std::vector<PointId> left_out_points(bool with_vertices) const;
  /// `points` are all that may be on or above the hull, vertices with them, and have been searched for the
  /// furthest above each simplex: what is proven of where they are is not needed. `gauge` is the largest of
  /// them above any; `known`: how far they reach along the simplices' normals, a row each.
  void certify_by_search(std::span<const PointId> points, double gauge, KnownHighest known);
  /// Those of left_out() that are outside by more than W and rounding go back; false when there are none.
  bool repair() { return repair(left_out_); }
  /// Puts these points, which are above these simplices, back into outside sets: growth adds them however
  /// little they are above. (When the simplex that one is above goes, it is as high as it is.)
  void put_back(std::span<const LocatedPoint> points);

  /// After locate_left_out: what growth would go on with when it has paused is left out, until it is put
  /// back.
  void leave_out_others() { forget_outside(work_); }

  /// Growth will not soon go on: its lists and marks are given back.
  void drop_grower() { work_.grower.reset(); }
  GrowthWork& work() { return work_; }
  const double* coordinates() const { return coordinates_.data(); }
  const PointView& input() const { return points_; }
  const Frame& frame() const { return frame_; }
  /// May the simplices be gathered into facets? Not when time is up, memory is short or a stop was requested:
  /// then they are the facets, which takes neither.
  bool may_cover();
  /// As far as time and stops go.
  bool has_time_to_cover();
  /// As far as memory goes; the status says when there is none.
  bool has_memory_to_cover();
  /// Is there memory for facets of so many disjoint slabs, which are looked at further, or not? Likewise.
  bool has_memory_for_slabs(std::size_t slabs, bool looks_further);
  /// Has a limit on time or simplices ended growth, and is there time to gather what there is all the same? The
  /// limit; the status is then that of growth that has paused. kComplete: no.
  HullStatus go_on_within_limit();
  /// Is there memory to search so many points for the furthest above each simplex (outside_points.h)? The
  /// status says when there is not.
  bool may_search(std::size_t points);
  /// [bytes] that are left beside the complex and the points; UINT64_MAX: no limit.
  std::uint64_t bytes_left() const { return limits_.bytes_left(work_, point_bytes()); }
  /// Facets that there is memory to choose, when a number is asked for; UINT64_MAX: no limit.
  std::uint64_t most_facets() const { return limits_.most_facets(work_, point_bytes()); }
  /// Simplices that there is memory for; 0: no limit.
  std::uint64_t most_rows() const { return limits_.most_rows(work_, frame_.dimension, point_bytes()); }
  const HullOptions& options() const { return options_; }
  /// Should what is there be the result, if it can be one? Then the status says so.
  bool is_late();
  /// [seconds] Until the time limit; infinite without one.
  double seconds_left() const {
    return options_.limits.max_seconds > 0.0 ? limits_.seconds_left() : HUGE_VAL;
  }
  /// For coplanar merging and coverings that may be given up, by what the facet table needs of the time; after
  /// a request to stop in a moment.
  WorkEnd end_of_merging() const;
  /// Of a step after growth that was cut short.
  void note_end(bool is_cut_short);
  bool is_limited() const { return hull_.status != HullStatus::kComplete || is_found_otherwise_; }
  /// Are the points about as rough as the shift? Most insertions were undone, and growth has ended, or points
  /// are left outside by far more than it: a larger shift will do. Never of one that is not the default or
  /// more, nor of one so large that planes would no longer be told apart.
  bool is_too_rough() const { return is_too_rough_; }
  /// Height of the furthest point that is still in an outside set; 0 without one.
  double furthest_height();
  /// Points that are no vertices and not well inside, each with the simplex it is above.
  const std::vector<LocatedPoint>& left_out() const { return left_out_; }
  /// Takes the points that are left out among those that the planes of so many facets are certified with, or,
  /// where they are too many, covers them by their gauge: then widths are larger than they need be.
  void choose_certificate_points(std::size_t facets);
  /// One flag a point: vertex of a simplex, or left out.
  std::vector<bool>& certificate_wanted() { return certificate_wanted_; }
  /// All input points.
  void want_all() { certificate_wanted_.assign(points_.rows, true); }
  /// How far the wanted points reach along the normals of the complex' rows; empty: not known.
  KnownHighest take_known_highest() { return std::move(known_highest_); }
  /// Points that are neither wanted, nor proven inside, nor among those left out that their gauge covers.
  std::uint64_t points_without_proof() const;
  /// Every point lies in the hull of the wanted ones scaled by 1 + this about the frame's centre.
  CoveredPoints covered_points() const { return {covered_gauge_, ball_.reach}; }
  /// Progress, from the calling thread: `more_bytes` beside the complex and the points.
  void tell(Phase phase, std::uint64_t points_left, double furthest, std::uint64_t simplices,
            std::uint64_t more_bytes) const;
  /// A finer clock, for the report.
  void detail(std::string_view name, Clock::time_point since);
  void release_coordinates() { coordinates_ = HugeArray<double>(); }

 private:
  void start();
  void report_counters();
  GrowthStop poll(std::uint64_t points_left, double furthest);
  bool undoes_most() const;
  bool may_be_rougher() const;
  void record_progress(std::uint64_t points_left, double furthest, std::uint64_t simplices);
  std::uint64_t point_bytes() const;
  bool noted_memory(bool has_memory);
  void tell(Phase phase, std::uint64_t points_left, double furthest) const {
    tell(phase, points_left, furthest, work_.complex.row_count - work_.free_count, 0);
  }
  GrowthStop grow_asking();
  void grow_before_placing();
  bool holds_some_waiting();
  void place_waiting();
  void forget_waiting();
  bool push_if_outside(const LocatedPoint& point);
  std::vector<PointId> points_off_the_complex();
  bool repair(const std::vector<LocatedPoint>& located);
  void list_left_out(const std::vector<LocatedPoint>& located);
  /// Products that looking at all simplices may cost, for points that walks have not located.
  double affordable_search() const;
  double& seconds(Phase phase) { return hull_.statistics.seconds[static_cast<std::size_t>(phase)]; }

  const PointView& points_;
  const Frame& frame_;
  const HullOptions& options_;
  Clock::time_point start_;
  Hull& hull_;
  HugeArray<double> coordinates_;  // points x rank, in the frame
  GrowthWork work_;
  HullBall ball_;
  WorkLimits limits_;
  std::optional<GrownHull> grown_;  // until it has started
  bool has_started_ = false, grows_from_some_ = false, is_too_rough_ = false;
  std::function<bool(std::uint64_t)> find_otherwise_;  // none: nothing is asked
  bool is_found_otherwise_ = false;
  std::uint64_t asked_at_ = 0;  // simplices made
  std::vector<bool> certificate_wanted_;
  KnownHighest known_highest_;
  std::vector<bool> proven_;  // inside by more than kWellInside; empty: nothing was proven early
  std::uint64_t proven_count_ = 0;
  std::vector<LocatedPoint> left_out_;
  double covered_gauge_ = 0.0;
};

}  // namespace ndhull
