// What all searches for fewer facets share: the hull as it grows, the space of fits, widths over all points.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "approx/facets/exact_facets.h"
#include "approx/facets/facet_layout.h"
#include "approx/growth/certified_growth.h"
#include "approx/slabs/dual_facets.h"
#include "approx/slabs/slab_cover.h"
#include "approx/slabs/slab_partition.h"
#include "approx/slabs/width_space.h"
#include "approx/trade/approximate_facets.h"
#include "core/machine/blocks.h"
#include "core/machine/huge_array.h"
#include "core/search/point_tree.h"

namespace ndhull {

/// Widths of facets over all points.
struct TrueWidths {
  std::vector<double> widths;           ///< [distance]
  std::vector<FurthestPoint> furthest;  ///< of growth's left_out(); no row: a vertex reaches as far

  double widest() const { return *std::max_element(widths.begin(), widths.end()); }
};

/// What makes facets wider than they may be.
struct Offenders {
  std::vector<LocatedPoint> above_simplices;  ///< ascending; above simplices that are facets alone
  double widest_slab = 0.0;  ///< [distance] of the facets of several simplices that are too wide
};

/// Growth aims at points this part of the facet width outside: what is left of the width then is free for
/// merging. On spheres a quarter needs 1.15 times the facets that none would, a half 1.6 times.
inline constexpr double kShareForGrowth = 0.25;

/// Rounds of smaller slabs and more growth before the best so far is taken.
inline constexpr int kWidthRounds = 24;

/// Points left out, up to which all are seen by the fits; of more, the furthest over each simplex. What they
/// do not see makes slabs too wide.
inline constexpr std::size_t kFewLeftOut = 1 << 17;
/// Up to so many facets neighbours are tried again for what fits into one slab.
inline constexpr std::size_t kFewFacets = 256;

/// One approximate hull on its way, for the classes that decide what it is to be.
class Approximation {
 protected:
  /// All that the task refers to must outlive this.
  explicit Approximation(const ApproximationTask& task);
  ~Approximation() = default;

  void make_space(bool with_left_out);
  FacetClusters facets_of(const Covering& covering) const;
  bool keeps_hull(const Covering& covering) const;
  static bool has_few_small(std::size_t facets, std::size_t simplices);
  void join_neighbours(Covering& covering, double width) const;
  std::optional<DualFacets> find_disjoint_slabs(double width);
  std::optional<DualFacets> find_single_slabs(double width, PartitionTask& task);
  void join_small_slabs(double width, DualFacets& facets) const;
  bool look_further(double width, Covering& covering);

  TrueWidths true_widths(const Covering& covering);
  std::vector<FurthestPoint> furthest_above(std::span<const std::uint32_t> simplices);
  std::vector<LocatedPoint> far_above(std::span<const std::uint32_t> simplices);
  Offenders add_offenders(const Covering& covering, const TrueWidths& widths, double width);

  void locate_and_go_on(double outside_width);
  void locate_left_out(double outside_width);
  void take_in_outside(double outside_width);
  void take_in_alone(std::span<const PointId> left_out);

  bool is_thorough() const { return accuracy_.effort == Effort::kThorough; }
  PointsAbove points_above() const;
  bool is_degenerate() const { return shares_planes(growth_.work(), growth_.coordinates()); }
  /// No point of the space is above any simplex's plane.
  bool is_convex() const { return points_above().are_none(); }
  std::size_t live_count() const { return growth_.work().complex.row_count - growth_.work().free_count; }
  /// Slabs thinner than this hold what rounding lets them: where even they leave no hull, the exact facets
  /// are the answer.
  double thinnest() const { return 1e-15 * lengths_.largest_extent; }

  const Frame& frame_;
  const Accuracy& accuracy_;
  const ResolvedAccuracy& lengths_;
  const std::vector<double>& factor_;
  CertifiedGrowth& growth_;
  Hull& hull_;
  HugeArray<double> determinants_;  // per row, of the hull as it is now; no memory: not known
  std::vector<PointId> extra_;      // points that reached further than the space knew
  std::optional<WidthSpace> space_;
  bool finds_determinants_ = true;  // will be wanted of the hull as it is then
  bool has_left_out_ = false;       // which the space is meant to know
  /// Have the fits seen all points, so that planes that were measured are as wide as they say?
  bool has_seen_all_ = true;

 private:
  std::span<const double> find_determinants(const BlockWork& also);
  const PointTree& left_out_tree();
  std::vector<LocatedPoint> located(std::span<const PointId> left_out) const;

  std::optional<PointTree> left_out_tree_;  // of left_out(), as rows of the space's kind, once asked for
};

}  // namespace ndhull
