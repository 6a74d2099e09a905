// From an accuracy that is asked for to clusters of simplices: how far to grow, which facets to make.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "approx/accuracy.h"
#include "approx/certified_growth.h"
#include "approx/facet_layout.h"
#include "approx/hull.h"
#include "approx/slab_cover.h"
#include "approx/width_space.h"
#include "core/point_tree.h"

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

/// One approximate hull on its way.
class Approximation {
 public:
  /// All must outlive this. `factor`: gradient_factor of the frame and the length unit.
  Approximation(const Frame& frame, const Accuracy& accuracy, const ResolvedAccuracy& lengths,
                std::vector<double> factor, CertifiedGrowth& growth, Hull& hull);

  /// Grows the hull and says which simplices become which facet. The complex may keep free rows; cluster_of
  /// has an entry for each row. No clusters: all facets are simplices so far.
  ///
  /// Promised  with a target width no facet is wider, unless a limit ended growth: rounds go on, with smaller
  ///           slabs and more points, until the true widths over all points fit.
  FacetClusters run();

 private:
  void make_space(bool with_left_out);
  Covering cover_width(double width, const CoverEffort& effort);
  Covering cover_count(std::uint64_t count, const CoverEffort& effort, double start_width);
  double widest_of(const Covering& covering);
  void locate_left_out(double outside_width);
  /// No point of the space is above any simplex's plane.
  bool is_convex() const {
    return space_->vertex_count() == space_->table().count() && growth_.work().shifted_points.empty();
  }
  /// So many points share planes that rounding has drawn many simplices' planes.
  bool is_degenerate() const {
    return 4 * growth_.work().shifted_points.size() >= growth_.work().counters.insertions;
  }
  bool keeps_hull(const Covering& covering) const;
  TrueWidths true_widths(const Covering& covering);
  /// Slabs thinner than this hold what rounding lets them: where even they leave no hull, the exact facets
  /// are the answer.
  double thinnest() const { return 1e-15 * lengths_.largest_extent; }
  Offenders add_offenders(const Covering& covering, const TrueWidths& widths, double width);
  std::vector<FurthestPoint> furthest_above(std::span<const std::uint32_t> simplices) const;
  void grow_for_width(double outside_width, double slab);
  FacetClusters run_width();
  FacetClusters run_count();
  FacetClusters run_merging();
  void grow_outside_width();
  bool search_outside(double width);

  const Frame& frame_;
  const Accuracy& accuracy_;
  ResolvedAccuracy lengths_;
  std::vector<double> factor_;
  CertifiedGrowth& growth_;
  Hull& hull_;
  std::vector<PointId> extra_;  // points that reached further than the space knew
  std::optional<WidthSpace> space_;
  std::optional<PointTree>
      left_out_tree_;  // of left_out(), as rows of the space's kind; none: there are none
};

}  // namespace ndhull
