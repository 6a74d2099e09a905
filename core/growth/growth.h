// Growing the simplicial hull, one point at a time, on dual vertices.
//
// Papers  Barber, Dobkin, Huhdanpaa. The Quickhull algorithm for convex hulls. ACM TOMS 22(4), 1996 (outside
//         sets). Motzkin, Raiffa, Thompson, Thrall. The double description method. 1953 (the dual step: a
//         new vertex is where an edge meets the cutting plane). The inward shift is ours: core/DESIGN.md.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/ids.h"
#include "core/machine/huge_array.h"
#include "core/search/outside_heights.h"

namespace ndhull {

/// Why growth ended. Every value is a valid hull of the points added; only the first is the full one.
enum class GrowthStop { kNoOutsidePoints, kPaused, kFacetLimit, kTimeLimit, kMemoryLimit, kInterrupted };

/// Gauge units: the gauge of y with respect to the simplex with dual plane a is a.y - 1, so 0 on the facet
/// and -1 at the interior point. In these units all roundoff and shifts are relative to the hull's own size.
struct GrowthOptions {
  /// [ratio] A point whose decisions are not all clearer than this is moved inwards by between one and two
  /// of it. 1e-12 is some 4,000 times the rounding error of one decision and still far below data noise;
  /// core/DESIGN.md (Robustness) says why.
  double shift = 1e-12;
  /// [length unit] Points less than this above the simplex they lie over are left out. 0: none are. May be
  /// raised between calls of `grow`; what was left out before stays out.
  double outside_width = 0.0;
  /// rank x rank, row-major: |R a| is the gradient of the gauge above plane a, per length unit, so that a
  /// distance is a gauge / |R a|. Empty: how far outside a point is goes by its gauge, and no width may be
  /// set.
  std::vector<double> gradient_factor;
  std::uint64_t seed = 1;
  /// Growth returns kPaused once when it has this many simplices and no point is more than pause_height above;
  /// 0 rows: never.
  std::uint64_t pause_rows = 0;
  double pause_height = HUGE_VAL;
  /// The same when so many simplices were made, with those that were undone, and half of the points added were
  /// shifted; 0: never.
  std::uint64_t pause_made = 0;
  /// Points far apart may be added side by side where insertions have become small: the furthest of all is
  /// then not always next. Only without limits: an early end should have the furthest points. May be changed
  /// between calls of `grow`.
  bool in_regions = false;
  /// The point whose gauge is largest comes next, however far it is: that makes fewer simplices on the way,
  /// of elongated hulls most. Only where no limit is near and no point is about to be left out. May be
  /// changed between calls of `grow`.
  bool by_gauge = false;
  std::uint64_t max_rows = 0;         ///< 0: no limit on simplices
  std::uint64_t most_table_rows = 0;  ///< rows the tables may have, in use or free; 0: as many as fit
  /// About so many rows the tables will have: then they have them from the beginning, in memory that other
  /// tables had. 0: it is not known.
  std::size_t foreseen_rows = 0;
  /// Asked every few thousand new simplices; anything but kNoOutsidePoints ends growth.
  std::function<GrowthStop(std::uint64_t points_left, double furthest)> poll;
};

struct GrowthCounters {
  std::uint64_t created = 0;     ///< simplices ever made
  std::uint64_t undone = 0;      ///< simplices of rejected insertions
  std::uint64_t insertions = 0;  ///< points added
  std::uint64_t rejected = 0;    ///< insertions tried that did not close and were undone
  std::uint64_t set_aside = 0;   ///< points given up after all tries; certify finds out what they cost
  std::uint64_t in_regions = 0;  ///< of the insertions: made by regions
  double seconds_visible = 0.0, seconds_cone = 0.0, seconds_match = 0.0, seconds_partition = 0.0;

  std::uint64_t made() const { return created + undone; }
  double seconds() const { return seconds_visible + seconds_cone + seconds_match + seconds_partition; }
  /// `share`: of the seconds.
  void add(const GrowthCounters& other, double share);
};

/// Regions in which growth may go on at the same time.
inline constexpr std::size_t kRegions = 2;

/// How parting the hull into regions has gone so far. Growth that goes on begins where it was.
struct PartingRecord {
  static constexpr double kWidestBand = 0.4;
  static constexpr std::uint64_t kLeastAlone = 8;

  std::uint64_t partings = 0;
  std::uint64_t next_at = 0;          ///< insertions
  std::uint64_t alone = kLeastAlone;  ///< insertions before the next try, when one is not worth it
  std::uint64_t created_at = 0;       ///< simplices made before the insertions that are looked at
  std::uint64_t looked_at = 0;        ///< insertions before these
  double ridges = 0.0;                ///< of an insertion
  bool pays = false;                  ///< insertions are small beside the hull
  double band = kWidestBand;          ///< points this part below the furthest, in their order, are tried
  std::array<double, kRegions> clearances{2.0, 2.0};  ///< of the regions, when they were joined

  /// For points that were not there before.
  void begin_anew() {
    next_at = 0;
    alone = kLeastAlone;
    band = kWidestBand;
  }
};

/// Everything that growth works on. Plain tables: the phases are free functions.
struct GrowthWork {
  std::size_t rank = 0;
  std::size_t point_count = 0;
  const double* points = nullptr;  ///< point_count x rank, in the frame, the interior point at 0

  SimplicialComplex complex;
  HugeArray<std::uint32_t> free_rows;
  std::size_t free_count = 0;

  std::vector<std::uint32_t> next_outside;    ///< per point: next of the same outside set + 1, 0 at the end
  OutsideHeights heights;                     ///< above the simplices in whose outside sets points are
  OutsideHeights gauges;                      ///< the same as gauges, while growth goes by them: else empty
  std::uint64_t points_outside = 0;           ///< in outside sets
  std::vector<std::uint32_t> waiting;         ///< ascending; neither in an outside set nor known to be inside
  double waiting_height = 0.0;                ///< no waiting point is further above the hull; may be +inf
  std::vector<std::uint32_t> shifted_points;  ///< those added moved inwards

  GrowthOptions options;
  GrowthCounters counters;
  PartingRecord parting;
  bool measure_phases = false;  ///< clock every insertion's phases (costs a few percent)

  /// What growth that has paused or come to its end goes on with: its threads, lists and marks, and what it
  /// has learned of the machine. May be dropped at any time, to have the memory: the next call of `grow` makes
  /// its own.
  std::shared_ptr<void> grower;

  GrowthWork() = default;
  GrowthWork(const GrowthWork&) = delete;  // its grower knows where it is
  GrowthWork& operator=(const GrowthWork&) = delete;

  /// The complex has no more vertices than those of the first simplex and the points added.
  std::size_t most_vertices() const { return counters.insertions + complex.rank + 1; }
};

/// Which points growth begins with. Points placed early are moved again and again.
struct FirstPoints {
  std::size_t most = SIZE_MAX;  ///< about so many, the highest over the first simplex
  std::size_t stride = 1;       ///< of the points only every stride-th
};

/// Makes the first simplex from rank + 1 affinely independent points around 0. Puts the points of `first`
/// into an outside set or drops them as inside; the others wait for the caller to place them in a hull that
/// has grown.
void start_growth(GrowthWork& work, std::span<const PointId> simplex, FirstPoints first);

/// A hull of some points, as growth has left it: row of the tables by row, in use or free.
struct GrownHull {
  SimplicialComplex complex;
  HugeArray<std::uint32_t> free_rows;
  std::size_t free_count = 0;
  GrowthCounters counters;
};

/// Empties the outside sets and takes the hull out of the work, which is done.
GrownHull take_grown(GrowthWork& work);

/// In place of `start_growth`: goes on from a hull of some of the points. Those that are no vertices of it
/// wait, wherever they are, for the caller to place them. No point of the hull was shifted.
void start_growth(GrowthWork& work, GrownHull grown);

/// Rows that tables of growth can have at most.
std::size_t most_rows(std::size_t rank);

/// Moves the tables of the complex and the free rows to where there is room for `rows`, at most `most_rows`.
void make_room_for(GrowthWork& work, std::size_t rows);

/// Adds outside points, the furthest of all first (but see in_regions and by_gauge), until none are left or
/// a limit is hit. May be called again after `push_outside`. Points in outside sets that are no higher than
/// the least height are left out then: no set has any.
GrowthStop grow(GrowthWork& work);

/// How far a point with this gauge is above simplex `row`: its distance in length units, or the gauge itself
/// when there is no gradient factor.
double height_above(const GrowthWork& work, std::uint32_t row, double gauge);

/// Height from which on a point counts as outside.
double least_height(const GrowthWork& work);

/// Empties all outside sets. Cost O(rows), nothing when they are empty.
void forget_outside(GrowthWork& work);

/// Puts `point`, which is in no outside set, into that of simplex `row`, which it is above by `height`. The
/// furthest point of a set comes first, the rest in no order.
void push_outside(GrowthWork& work, std::uint32_t point, std::uint32_t row, double height);

/// Of that the part that concerns the set alone.
void link_outside(GrowthWork& work, std::uint32_t point, std::uint32_t row, double height);

/// Takes `point` out of the outside set that it is in. Cost O(points in the set).
void take_from_outside(GrowthWork& work, std::uint32_t point);

/// find_corners of all rows, knowing how many vertices there may be.
std::vector<bool> find_corners(const GrowthWork& work);

}  // namespace ndhull
