// The main call: points in, certified facets out.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string_view>
#include <vector>

#include "approx/accuracy.h"
#include "approx/facets/facet_layout.h"
#include "approx/facets/facet_lists.h"
#include "approx/facets/later_areas.h"
#include "approx/facets/later_simplices.h"
#include "approx/geometry/length_unit.h"
#include "core/complex/simplicial_complex.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/huge_array.h"
#include "core/points.h"

namespace ndhull {

/// Limits on the work; 0 means none. A limit that is hit ends growth; what is there is completed,
/// certified and labelled by Hull::status.
struct Limits {
  std::uint64_t max_facets = 0;  ///< simplices of the growth complex
  double max_seconds = 0.0;      ///< wall clock of the whole call: growth ends in time for the rest
  /// [ratio] Time that the caller will spend on each facet after the call, over what growth spent on it: with
  /// max_seconds growth ends early enough for that too. Ignored with a target number of facets.
  double share_afterwards = 0.0;
  std::uint64_t max_memory_bytes = 0;  ///< of all tables of the call, at their largest
  /// [bytes] What the caller makes of each simplex after the call, which these limits are to hold as well.
  std::uint64_t bytes_afterwards = 0;
  /// What the machine has for them: ends growth where max_memory_bytes is 0, and changes nothing before.
  std::uint64_t machine_memory_bytes = 0;

  bool has_any() const { return max_facets > 0 || max_seconds > 0.0 || max_memory_bytes > 0; }
  std::uint64_t most_memory() const { return max_memory_bytes > 0 ? max_memory_bytes : machine_memory_bytes; }
};

/// What is left of a limit on bytes when so many are used: at least an eighth of it, with which a hull of
/// some thousand simplices is had where the input alone takes more. 0, which is no limit, stays 0.
constexpr std::uint64_t limit_left(std::uint64_t limit, std::uint64_t used) {
  return std::max(limit > used ? limit - used : 0, limit / 8);
}

/// The phases of one run, in order; the report, the progress line and the benchmarks use these names.
enum class Phase { kGrowth, kCertify, kMerge, kCount };
std::string_view to_string(Phase phase);

/// What the progress callback is told, a few times a second.
struct Progress {
  Phase phase = Phase::kGrowth;
  std::uint64_t points_left = 0;  ///< points still outside
  std::uint64_t simplices = 0;    ///< rows of the growth complex now
  double furthest_gauge = 0.0;    ///< [ratio] how far outside the last point added was
  double elapsed_seconds = 0.0;
  std::uint64_t memory_bytes = 0;
};

struct HullOptions {
  Accuracy accuracy = {};
  bool triangulate = false;  ///< facets stay simplices: no coplanar merging
  /// Outer offsets are proven. False: they are +infinity, and so are widths; for exact hulls of which only
  /// the planes are wanted.
  bool certifies_planes = true;
  /// The caller will ask for simplices. An exact hull is then grown simplex by simplex rather than found by
  /// whole facets (core/whole_facets/double_description.h); none is taken that was found without its complex
  /// (approx/slabs/star_hull.h), or that has very many simplices.
  bool wants_simplices = false;
  /// False: when a limit or a request to stop ends an exact hull, only its `status` is wanted, and the call
  /// returns at once.
  bool wants_partial = true;
  bool unit_cube = false;  ///< widths are measured after scaling the input to the unit cube
  Limits limits = {};
  std::uint64_t seed = 1;  ///< of the inward shifts; the result depends on it below roundoff only
  /// [ratio] 0 to 1e-6: growth's smallest inward shift, see GrowthOptions::shift; ten times as large, and
  /// again, where data turn out to be about as rough (core/DESIGN.md), unless it is given below the default.
  double shift = 1e-12;
  unsigned threads = 0;  ///< of the whole call, 1024 at most; 0: all cores. The result does not depend on it.
  std::function<void(const Progress&)> progress = {};  ///< called from the calling thread
  std::stop_token stop = {};                           ///< a request ends growth: status kInterrupted
};

/// Is an area or a volume, of what has one, a double to all its digits?
inline bool is_in_range(double measure) {
  return measure >= std::numeric_limits<double>::min() && measure <= std::numeric_limits<double>::max();
}

enum class HullStatus { kComplete, kFacetLimit, kTimeLimit, kMemoryLimit, kInterrupted };
std::string_view to_string(HullStatus status);

/// What an approximate hull was made with; lengths resolved, in the length unit.
struct AccuracyChosen {
  /// What a target number of facets made small; the width, though the volume was asked for, where so few of
  /// the exact planes bound no region.
  FacetObjective objective = FacetObjective::kWidth;
  double outside_width = 0.0;  ///< growth left out what was less outside; 0: nothing
  double slab_width = 0.0;     ///< facets were sought within slabs of this width; 0: not by slabs
  double width_cap = 0.0;      ///< 0: none was needed
  double width_asked = 0.0;    ///< the target width, else W; 0: neither was asked for
  std::uint64_t merges = 0;
  /// Of pairs: those that would have been too wide or left no hull. Of slabs: simplices that stay facets since
  /// they close the region, and coverings given up since they left no hull.
  std::uint64_t refused_merges = 0;
};

/// How far growth was at some time: what an earlier end would have given.
struct GrowthRecord {
  double seconds = 0.0;  ///< from the start of the call
  std::uint64_t simplices = 0;
  std::uint64_t points_left = 0;  ///< points outside
  /// How far outside the furthest point was. The exact hull: a gauge, so all points were in the hull of that
  /// time scaled by 1 + this. With an accuracy: a height above a simplex, in the length unit. Never rises.
  double furthest = 0.0;
};

/// Numbers about the run.
struct HullStatistics {
  std::uint64_t dropped_points = 0;  ///< of a large input: proven inside before the hull was grown
  std::uint64_t created_simplices = 0;
  std::uint64_t created_facets = 0;  ///< not 0: the hull was found by whole facets, and these were made
  std::uint64_t insertions = 0;
  std::uint64_t shifted_points = 0;  ///< points that had to be moved inwards (input is nearly degenerate)
  std::uint64_t rejected_insertions =
      0;  ///< insertions whose horizon did not close and that were not committed
  std::uint64_t repair_rounds = 0;
  std::vector<GrowthRecord> growth_curve;  ///< whenever the hull had half as many simplices more
  std::array<double, static_cast<std::size_t>(Phase::kCount)> seconds{};
  std::vector<std::pair<std::string_view, double>> detail_seconds;  ///< finer clock, for the benchmarks
};

class HullBuilder;

/// The convex hull of a set of points: facets with certified outer and inner planes.
///
/// Planes    distance(x) = normal . x + offset, unit normal, positive outside. What is certified is the
///           plane normal . (x - reference) + centred_offset, where reference is the origin unless the
///           data lie far from it; `offset` is its rounding, which moves no distance by more than roundoff.
/// Flat data When the points span only rank < dimension, the facets are those of the hull inside the
///           affine subspace; normals lie in it, areas are (rank-1)-dimensional, volume rank-dimensional.
///           rank 0 (all points equal): no facets. rank 1: two facets, one vertex each.
/// Widths    outer_offset, inner_offset are in the length unit: input, or unit-cube with that option.
class Hull {
 public:
  std::size_t dimension = 0;    ///< columns of the input
  std::size_t rank = 0;         ///< affine dimension of the input
  std::size_t point_count = 0;  ///< rows of the input
  HullStatus status = HullStatus::kComplete;
  /// Facets were merged for a width. Then a facet may have fewer neighbours than rank, and a vertex, which is
  /// one of the inner hull, fewer facets.
  bool is_approximate = false;

  std::vector<double> interior_point;      ///< dimension numbers, input units, strictly inside the hull
  std::vector<double> reference;           ///< dimension numbers: origin of the certified planes
  std::vector<double> subspace_equations;  ///< (dimension - rank) rows of dimension + 1: normal, offset

  std::vector<PointId> vertices;  ///< ascending; no redundant ones

  /// Of the hull of the input, input units. Beyond the range of doubles: infinite, or 0 or subnormal.
  double area = 0.0;
  double volume = 0.0;
  double roundoff = 0.0;          ///< [distance] proven rounding error of a distance, length unit
  double max_outer_offset = 0.0;  ///< [distance] certified, >= 0
  double min_inner_offset = 0.0;  ///< [distance] certified, <= 0
  double max_facet_width = 0.0;   ///< [distance]
  /// [ratio] s: all input is in the hull of the vertices scaled by 1 + s about the interior point.
  double max_outside_gauge = 0.0;
  /// Input points that no proof of the outer planes covers: neither measured against them nor proven
  /// inside. 0, or the certificate failed.
  std::uint64_t points_outside = 0;
  HullStatistics statistics;
  AccuracyChosen chosen;

  /// With unit_cube: the extent of each column; otherwise empty.
  const std::vector<double>& unit_cube_extents() const { return length_unit_.extents(); }

  std::size_t facet_count() const { return layout_.facets; }
  std::size_t simplicial_facet_count() const { return layout_.simplicial; }

  std::span<const double> normal(FacetId facet) const {
    return {normals_.data() + facet.value * dimension, dimension};
  }
  /// Of all facets, one after the other.
  std::span<const double> normals() const { return {normals_.data(), facet_count() * dimension}; }
  double offset(FacetId facet) const;
  double centred_offset(FacetId facet) const { return centred_offsets_[facet.value]; }
  double outer_offset(FacetId facet) const { return outer_[facet.value]; }  ///< >= 0, length unit
  double inner_offset(FacetId facet) const { return inner_[facet.value]; }  ///< <= 0, length unit
  /// Input units, >= 0. Of a merged facet: of the projection of its simplices onto its plane, less what
  /// faces the other way.
  /// Cost  the first call for an approximate hull makes the areas of all facets
  ///       (approx/facets/later_areas.h); several threads may make it.
  double area_of(FacetId facet) const { return areas()[facet.value]; }
  /// Input units of distance along the facet's normal for one length unit: 1 without unit_cube.
  double input_per_length_unit(FacetId facet) const;

  /// Of a simplicial facet the rank ids in the order of its simplex, neighbour k opposite vertex k; of a
  /// merged one sorted ids. Cost  the first call for a facet that is merged, or beside a merged one, lists
  /// all of these (approx/facets/facet_lists.h); several threads may make it.
  std::span<const PointId> vertices_of(FacetId facet) const;
  std::span<const FacetId> neighbours_of(FacetId facet) const;
  std::span<const SimplexId> simplices_of(FacetId facet) const;
  /// Cost  the first call for an approximate hull notes this of all simplices; several threads may make it.
  FacetId facet_of(SimplexId simplex) const;
  std::uint64_t simplex_count() const { return simplex_count_; }
  std::uint64_t simplex_count_of(FacetId facet) const;
  /// The facets' simplices, compacted; without planes: those of the facets are here. Throws, as the two calls
  /// above that name simplices do, Error kTooManySimplices: a hull that was found without them has more than
  /// 2^27, or rounding makes others of its vertices than it was found with. Cost  the first call for such a
  /// hull makes them (approx/facets/later_simplices.h), with the memory and time of growth; several
  /// threads may make it.
  const SimplicialComplex& simplices() const;
  bool is_simplicial(FacetId facet) const { return facet.value < layout_.simplicial; }

  /// Moves all outer planes out and all inner planes in: then they hold for points that differ from those the
  /// hull was computed of by up to `distance`. [distance, input units] >= 0
  void widen(double distance);

 private:
  friend class HullBuilder;
  mutable FacetLayout layout_;  // which facet a simplex is of may be noted when that is first asked for
  HugeArray<double> normals_, centred_offsets_, outer_, inner_, areas_;
  struct Lists {
    std::once_flag made, numbered;
    FacetLists lists;
  };
  const FacetLayout& numbered_layout() const;
  const FacetLists& lists() const;
  const double* areas() const {
    return later_areas_ ? later_areas_->of_facets(layout_, normals_.data()).data() : areas_.data();
  }
  // Made when they are first asked for: planes and widths need none.
  std::unique_ptr<Lists> lists_ = std::make_unique<Lists>();
  SimplicialComplex simplices_;
  std::uint64_t simplex_count_ = 0;
  std::unique_ptr<LaterAreas> later_areas_;  // then areas_ are not there
  std::unique_ptr<LaterSimplices> later_;    // of a hull that was found without simplices
  LengthUnit length_unit_;
};

/// Computes the convex hull of `points`.
///
/// Returns   every facet with certified outer and inner offsets. All points coplanar, equal, or fewer than
///           dimension + 1: the hull inside the affine subspace they span (see Hull).
/// Throws    Error kEmptyInput no rows; kDimensionTooLow dimension 0; kNotFinite NaN or infinity, with row
///           and column; kDimensionTooHigh rank above kMaxRank; kTooManyPoints 2^31 rows or more; kOutOfRange
///           extents too small or too large to state planes for; kUsage a target of facets that bound no
///           region, options that contradict each other or are no numbers (approx/option_check.h).
/// Not promised  the same facets for another seed where data are degenerate below roundoff.
/// Cost      time and memory grow with the facets of the hull: about 150 bytes each in 8-d, and
///           8 rank bytes for each point.
/// Source    core/DESIGN.md; Barber, Dobkin, Huhdanpaa. The Quickhull algorithm for convex hulls. ACM
///           TOMS 22(4), 1996, for the frame of the algorithm.
Hull convex_hull(const PointView& points, const HullOptions& options = {});

}  // namespace ndhull
