// When growth has to end so that what follows it keeps the limits too: certificate, merging, the facet table.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "approx/hull.h"
#include "core/complex/membership.h"
#include "core/growth/growth.h"

namespace ndhull {

/// What becomes of the simplices after growth.
enum class Gathering {
  kSimplices,  ///< they are the facets, or coplanar ones are merged
  kRule,       ///< clusters under a rule (C, A), if there is time and memory
  kWidth,      ///< slabs of a width, likewise
  kCount,      ///< a number of facets, in any case
};

/// Foresees what a hull will need after growth, from what growth needed so far.
///
/// Time    Each simplex costs some share of what making it did; the shares were measured in 5-d to 10-d. What
///         a point costs is measured on a few points whenever the hull has doubled.
/// Memory  Counted, not measured: tables of growth, then of facets, and the points.
class WorkLimits {
 public:
  using Clock = std::chrono::steady_clock;

  /// `start`: of the clock that max_seconds limits. `facets`: the number that is asked for, of kCount.
  WorkLimits(const Limits& limits, Clock::time_point start, Gathering gathering, std::uint64_t facets)
      : limits_(limits), start_(start), gathering_(gathering), facets_(facets) {}

  /// Rows of the complex that max_memory_bytes leaves room for; 0: no limit. `point_bytes`: all that is kept
  /// of the points.
  std::uint64_t most_rows(const GrowthWork& work, std::size_t dimension, std::uint64_t point_bytes) const;
  /// Would the rest end after max_seconds, were growth to end now? `points`: those that are to be proven
  /// inside.
  bool is_time_up(const GrowthWork& work, const HullBall& ball, std::uint64_t points);
  /// Is there time, and is there memory, to gather the simplices into slabs? `left_out`: points that
  /// are no vertices and not well inside.
  bool has_time_to_cover(const GrowthWork& work, std::uint64_t left_out) const;
  bool has_memory_to_cover(const GrowthWork& work, std::size_t dimension, std::uint64_t point_bytes) const;
  /// Is there memory for facets of so many disjoint slabs, which have been found and are looked at further, or
  /// not? For a width slabs are found before this is asked: it is their number that takes memory.
  bool has_memory_for_slabs(const GrowthWork& work, std::size_t dimension, std::uint64_t point_bytes,
                            std::uint64_t slabs, bool looks_further) const;
  /// Is there memory to search `points` for the furthest above each simplex (outside_points.h)?
  bool has_memory_to_search(const GrowthWork& work, std::size_t dimension, std::uint64_t point_bytes,
                            std::uint64_t points) const;
  /// [bytes] that are left beside the complex and the points; UINT64_MAX: no limit.
  std::uint64_t bytes_left(const GrowthWork& work, std::uint64_t point_bytes) const;
  /// Facets that may be chosen in it, of simplices that are grown, when a number is asked for; UINT64_MAX: no
  /// limit.
  std::uint64_t most_facets(const GrowthWork& work, std::uint64_t point_bytes) const;
  /// Has so much of the time passed that nothing should be tried a second time?
  bool is_late() const;
  double seconds_left() const;  ///< of max_seconds, which is above 0
  /// Products of planes and points that fit into this part of the time that is left; HUGE_VAL without a limit.
  /// After a request to stop: that take a second, or some share of the time so far.
  double affordable_products(const GrowthWork& work, double part, bool is_stopped) const;

 private:
  std::uint64_t row_bytes(const GrowthWork& work, std::size_t dimension, bool merges) const;
  std::uint64_t rows_to_choose_from(const GrowthWork& work, std::size_t dimension,
                                    std::uint64_t point_bytes) const;
  static std::uint64_t chosen_facet_bytes(const GrowthWork& work);
  std::uint64_t rows_for(std::uint64_t bytes_a_row, std::uint64_t point_bytes) const;
  double finish_seconds(const GrowthWork& work, const HullBall& ball, std::uint64_t points);
  /// Of some points from the one with id `first` on, taken evenly.
  static double sampled_seconds_per_point(const GrowthWork& work, const HullBall& ball, std::size_t first);
  static double width_share(const GrowthWork& work, std::uint64_t left_out);
  static double seconds_per_created(const GrowthWork& work);

  Limits limits_;
  Clock::time_point start_;
  Gathering gathering_;
  std::uint64_t facets_;
  std::uint64_t sampled_at_ = 0;  // rows when points were sampled last
  double seconds_per_point_ = 0.0;
};

}  // namespace ndhull
