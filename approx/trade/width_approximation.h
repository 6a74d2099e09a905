// A target width: no facet is wider, and as few facets as possible.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "approx/trade/approximation.h"
#include "approx/trade/region_closing.h"

namespace ndhull {

/// One approximate hull for a width.
class WidthApproximation : private Approximation {
 public:
  explicit WidthApproximation(const ApproximationTask& task);

  ApproximateFacets run();

 private:
  FacetClusters find_facets();

  void choose_order();
  bool will_take_in_all() const;
  bool is_width_alone() const;
  bool find_stars();
  bool take_star_hull(double rows);
  void grow();
  void grow_in_stages();

  /// A limit has ended growth, and facets may be wider.
  bool has_settled() const { return limit_ != HullStatus::kComplete; }
  bool may_go_on(double seconds_of_round);
  bool settles_for_wider();
  bool leaves_out_hardly_any() const;
  double less_outside(int round) const;
  void take_in_far(std::span<const LocatedPoint> far, int round);

  bool is_worth_joining_again(std::size_t facets, std::size_t simplices) const;
  bool is_worth_looking_further(std::size_t facets) const;
  bool is_final(const DualFacets& facets) const;
  bool has_memory_for(const std::optional<DualFacets>& slabs, bool are_final);
  std::vector<LocatedPoint> find_slabs(bool may_grow, std::optional<DualFacets>& slabs);
  Covering cover(std::optional<DualFacets> slabs, HullFacets* known);
  void look_for_fewer(Covering& covering);

  double input_bytes_;
  EarlierRun earlier_;
  double target_;           // [distance] no facet is to be wider
  double outside_width_;    // [distance] points that are less than this outside are left out
  double slab_;             // [distance] width of the slabs, at most the target
  PartitionTask task_;      // of the slabs last found
  int rounds_of_many_ = 0;  // in which many simplices were in no slab
  HullStatus limit_ = HullStatus::kComplete;  // that has ended growth, and a wider one is looked for
  bool are_stars_in_vain_ = false;            // as far as is foreseen
  std::optional<StarHull> star_hull_;
};

}  // namespace ndhull
