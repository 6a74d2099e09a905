// From an accuracy that is asked for to clusters of simplices: how far to grow, which facets to make.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "approx/accuracy.h"
#include "approx/facets/exact_facets.h"
#include "approx/facets/facet_layout.h"
#include "approx/growth/certified_growth.h"
#include "approx/hull.h"
#include "approx/slabs/dual_facets.h"
#include "approx/slabs/slab_cover.h"
#include "approx/slabs/slab_partition.h"
#include "approx/slabs/star_hull.h"
#include "approx/slabs/width_space.h"
#include "approx/trade/region_closing.h"
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

/// What an earlier run with the same points has shown.
struct EarlierRun {
  bool has_run_out = false;      ///< of memory: it may end as before
  bool has_tried_exact = false;  ///< as far as that was worth it: it is not what is wanted
  /// An attempt at the exact hull: its limit on simplices is one on work, and facets found whole may have more.
  bool limits_work = false;
  std::uint64_t facets = 0;  ///< 0, or how many whole facets of it are joined to
};

/// One approximate hull on its way.
class Approximation {
 public:
  /// All must outlive this. `factor`: gradient_factor of the frame and the length unit. `input_bytes`: of the
  /// input that growth's points were kept of.
  Approximation(const Frame& frame, const Accuracy& accuracy, const ResolvedAccuracy& lengths,
                std::vector<double> factor, CertifiedGrowth& growth, Hull& hull, double input_bytes,
                EarlierRun earlier);

  /// Grows the hull and says which simplices become which facet. The complex may keep free rows; cluster_of
  /// has an entry for each row. No clusters: all facets are simplices so far.
  ///
  /// Promised  with a target width no facet is wider, unless a limit ended growth: rounds go on, with smaller
  ///           slabs and more points, until the true widths over all points fit.
  FacetClusters run();
  /// Is it asked for in a way that a hull without its complex answers, which has no early end?
  bool may_do_without_complex() const;
  /// Is the exact hull to be tried instead, since so many points share planes that it may have no more facets
  /// than are asked for? Then run() has ended early.
  bool wants_exact_first() const { return wants_exact_first_; }
  /// What run() found instead of clusters, if it did.
  std::optional<StarHull>& star_hull() { return star_hull_; }
  /// find_outwards of all rows, if run() asked for them; else no memory.
  HugeArray<double> take_determinants() { return std::move(determinants_); }

 private:
  void make_space(bool with_left_out);
  static bool has_few_small(std::size_t facets, std::size_t simplices);
  bool is_worth_joining(std::size_t facets, std::size_t simplices) const;
  bool is_worth_joining_again(std::size_t facets, std::size_t simplices) const;
  bool is_worth_looking_further(std::size_t facets) const;
  void join_neighbours(Covering& covering, double width) const;
  std::span<const double> find_determinants(const BlockWork& also);
  std::optional<DualFacets> find_disjoint_slabs(double width, FacetLimit* limit_of_count = nullptr);
  bool is_final(const DualFacets& facets) const;
  bool is_thorough() const { return accuracy_.effort == Effort::kThorough; }
  Covering cover_width(double width, std::optional<DualFacets> slabs, HullFacets* known);
  bool may_go_on(double seconds_of_round);
  bool settles_for_wider(double& outside_width, double& target);
  bool is_limited_width() const { return limit_of_width_ != HullStatus::kComplete; }
  bool leaves_out_hardly_any(double outside_width) const;
  double less_outside(double outside_width, int round) const;
  void take_in_outside(double outside_width);
  void take_in_alone(std::span<const PointId> left_out);
  double take_in_far(std::span<const LocatedPoint> far, double outside_width, int round);
  /// What the search for a number of facets remembers.
  struct CountSearch {
    Covering narrowest;         // over all points, of the hull as it is now; no planes: none yet
    double width = 0.0;         // of its widest facet
    double slab = 0.0;          // of its slabs
    double power = 0.0;         // of the width: how the number of facets fell last; 0: not known
    std::uint64_t covered = 0;  // simplices, again for each covering
    bool is_cut_short = false;  // a covering, for want of time
    bool has_any() const { return !narrowest.planes.empty(); }
  };
  /// A covering by slabs of one width.
  struct CountTrial {
    std::size_t facets;
    Covering covering;  // no planes: these are more facets than are wanted, and not looked at
  };
  CountTrial try_width(std::uint64_t count, const CoverEffort& effort, double width,
                       std::optional<SlabCover>& overlapping, CountSearch& search);
  Covering cover_count(std::uint64_t count, const CoverEffort& effort, double start_width, double slack,
                       CountSearch& search);
  std::size_t live_count() const { return growth_.work().complex.row_count - growth_.work().free_count; }
  bool is_whole();
  bool is_coarse_for(double slab, double outside_width);
  /// What slabs for a number of facets may be as thick as.
  struct SlabGuess {
    double coarse = 0.0;  // where growth has just begun; 0: that was not found out
    double slab = 0.0;    // in the hull that is wanted, about
  };
  SlabGuess guess_slab(std::uint64_t count, CountSearch& search);
  bool may_grow_held(const CountSearch& search, double share);
  std::optional<Covering> hold_width(double width, double outside_width, double share, bool only_if_far,
                                     CountSearch& search);
  void search_held(std::uint64_t count, double first_width, double outside_width, bool only_if_far,
                   CountSearch& search);
  void foresee_coverings(double seconds_at_first, const CountSearch& search);
  double consider(const Covering& covering, double slab, CountSearch& search);
  void close_and_join(Covering& covering, double width, bool joins) const;
  void probe_widths(std::uint64_t count, CountSearch& search);
  std::uint64_t balance_facets(std::uint64_t count, const Covering& start, double slab,
                               std::uint64_t most_turns, CountSearch& search);
  std::vector<std::uint32_t> simplices_of_widest(const Covering& covering, const TrueWidths& widths) const;
  std::vector<PointId> points_far_above(std::span<const std::uint32_t> simplices, double width);
  void take_in_widening(std::uint64_t count, double outside_width, CountSearch& search);
  void cover_again(std::uint64_t count, double width, double outside_width, CountSearch& search);
  bool look_further(double width, Covering& covering);
  void look_for_fewer(double width, Covering& covering);
  void look_for_narrower(std::uint64_t count, CountSearch& search);
  void grow_for_count(std::uint64_t count, double outside_width, const SlabGuess& guess);
  void locate_left_out(double outside_width);
  /// No point of the space is above any simplex's plane.
  bool is_convex() const {
    return space_->vertex_count() == space_->table().count() && growth_.work().shifted_points.empty();
  }
  bool may_be_few_exact_facets();
  bool is_degenerate() const { return shares_planes(growth_.work(), growth_.coordinates()); }
  bool keeps_hull(const Covering& covering) const;
  FacetClusters facets_of(const Covering& covering) const;
  TrueWidths true_widths(const Covering& covering);
  const PointTree& left_out_tree();
  /// Slabs thinner than this hold what rounding lets them: where even they leave no hull, the exact facets
  /// are the answer.
  double thinnest() const { return 1e-15 * lengths_.largest_extent; }
  /// Widths up to this are rounding's: a number of facets that is as narrow has found the flat faces.
  double flat() const { return 1e-13 * lengths_.largest_extent; }
  Offenders add_offenders(const Covering& covering, const TrueWidths& widths, double width);
  std::vector<FurthestPoint> furthest_above(std::span<const std::uint32_t> simplices);
  std::vector<LocatedPoint> located(std::span<const PointId> left_out) const;
  std::vector<LocatedPoint> few_far_above(double width) const;
  void grow_for_width(double outside_width, double slab);
  void grow_in_stages(double outside_width, double slab);
  void choose_order(double outside_width);
  bool will_take_in_all(double outside_width) const;
  bool is_width_without_limits() const;
  bool find_stars(double outside_width, double slab);
  bool take_star_hull(double slab, double rows);
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
  double input_bytes_;
  EarlierRun earlier_;
  bool wants_exact_first_ = false;
  HullStatus limit_of_width_ = HullStatus::kComplete;  // that has ended growth, and a wider one is looked for
  bool has_too_many_vertices_ = false;                 // for stars, as far as is foreseen
  std::optional<StarHull> star_hull_;
  HugeArray<double> determinants_;  // per row, of the hull as it is now; no memory: not known
  std::vector<PointId> extra_;      // points that reached further than the space knew
  std::optional<WidthSpace> space_;
  /// Have the fits seen all points, so that planes that were measured are as wide as they say?
  bool has_seen_all_ = true;
  bool has_left_out_ = false;                   // which the space is meant to know
  std::optional<PointTree> left_out_tree_;      // of left_out(), as rows of the space's kind, once asked for
  std::uint64_t affordable_rows_ = UINT64_MAX;  // simplices that a number of facets may be looked for among
};

}  // namespace ndhull
