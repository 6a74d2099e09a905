// A target number of facets: no more, as narrow as possible.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "approx/trade/approximation.h"

namespace ndhull {

/// One approximate hull for a number of facets: the least width of slabs that needs no more is looked for.
class CountApproximation : private Approximation {
 public:
  explicit CountApproximation(const ApproximationTask& task);

  ApproximateFacets run();

 private:
  /// What was found so far, and at what cost.
  struct Search {
    Covering narrowest;         // over all points, of the hull as it is now; no planes: none yet
    double width = 0.0;         // of its widest facet
    double slab = 0.0;          // of its slabs
    double power = 0.0;         // of the width: how the number of facets fell last; 0: not known
    std::uint64_t covered = 0;  // simplices, again for each covering
    bool is_cut_short = false;  // a covering, for want of time
    bool has_any() const { return !narrowest.planes.empty(); }
  };
  /// A covering by slabs of one width.
  struct TriedWidth {
    std::size_t facets;
    Covering covering;  // no planes: these are more facets than are wanted, and not looked at
  };
  /// What slabs for the number may be as thick as.
  struct SlabGuess {
    double coarse = 0.0;  // where growth has just begun; 0: that was not found out
    double slab = 0.0;    // in the hull that is wanted, about
  };

  // How far to grow.
  bool is_outside_width_given() const { return lengths_.outside_width > 0.0; }
  bool may_be_few_exact_facets();
  SlabGuess guess_slab();
  void foresee_coverings(double seconds_at_first);
  bool keep_within_memory();
  void begin_growth(SlabGuess& guess);
  void grow(const SlabGuess& guess);
  bool is_coarse_for(double slab);
  bool is_whole();

  // Slabs of which width. (also count_cover.cpp, held_widths.cpp)
  bool is_worth_joining() const;
  void close_and_join(Covering& covering, double width, bool joins) const;
  TriedWidth try_width(const CoverEffort& effort, double width, std::optional<SlabCover>& overlapping);
  Covering cover_count(const CoverEffort& effort, double start_width, double slack);
  void search_slabs(double width);
  bool take_in_offenders(const Covering& covering, double slab, bool may_grow);
  bool may_grow_held(double share);
  std::optional<Covering> hold_width(double width, double share, bool only_if_far);
  void search_held(double first_width, bool only_if_far);

  // The narrowest, made narrower. (narrower_facets.cpp, count_points.cpp)
  double consider(const Covering& covering, double slab);
  void probe_widths();
  std::uint64_t balance_facets(const Covering& start, double slab, std::uint64_t most_turns);
  std::vector<std::uint32_t> simplices_of_widest(const TrueWidths& widths) const;
  std::vector<PointId> points_far_above(std::span<const std::uint32_t> simplices);
  void take_in_widening();
  void cover_again(double width);
  void look_for_narrower();

  /// Widths up to this are rounding's: a number of facets that is as narrow has found the flat faces.
  double flat() const { return 1e-13 * lengths_.largest_extent; }

  std::uint64_t count_;
  const bool has_tried_exact_;
  double outside_width_ = 0.0;  // [distance] points that are less than this outside are left out
  Search search_;
  std::uint64_t affordable_rows_ = UINT64_MAX;  // simplices that facets may be looked for among
};

}  // namespace ndhull
