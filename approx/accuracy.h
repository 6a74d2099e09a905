// Which facets may be traded for which error.
#pragma once

#include <cstdint>

#include "approx/geometry/length_unit.h"
#include "core/frame.h"

namespace ndhull {

/// A length in the length unit, or in percent of the largest extent of the input in it.
struct Length {
  double value = 0.0;  ///< 0: not asked for
  bool is_percent = false;
  bool is_set() const { return value > 0.0; }
};

/// What a target number of facets makes small.
enum class FacetObjective {
  kWidth,   ///< the widest facet
  kVolume,  ///< the volume below the outer planes, which are then chosen of those of the exact hull
};

/// How long a target is looked for.
enum class Effort {
  kQuick,     ///< about as long as the exact hull takes
  kThorough,  ///< up to half as many facets for a width, or narrower ones, in up to some 35 times the time
};

/// Which facets may be traded for which error. Nothing set: the exact hull.
struct Accuracy {
  Length width;  ///< target: no facet is wider than this (certified); as few facets as possible
  /// Target: at most this many facets, as narrow as possible; 0: no target. Above the points' rank: fewer
  /// planes bound no region.
  std::uint64_t facets = 0;
  FacetObjective objective = FacetObjective::kWidth;  ///< what a target `facets` makes small
  /// For the width of `width` and `facets`; nothing more is looked for where a hull is found without its
  /// complex (approx/slabs/star_hull.h).
  Effort effort = Effort::kQuick;
  Length outside_width;     ///< growth leaves out points that are less than this outside (W)
  Length centrum_radius;    ///< merge while a centrum is less than this below its neighbour's plane (C)
  double max_cosine = 2.0;  ///< merge while normals of neighbours agree more than this (A); above 1: off
  Length width_cap;         ///< merging makes no facet wider than this; not set: see default_width_cap
  bool is_for_volume() const { return facets > 0 && objective == FacetObjective::kVolume; }
  bool is_exact() const {
    return !width.is_set() && facets == 0 && !outside_width.is_set() && !merges_neighbours();
  }
  bool merges_neighbours() const { return centrum_radius.is_set() || max_cosine <= 1.0; }
};

/// The cap on the width of merged facets when none is given, lengths resolved: the larger of W + 0.9 C
/// and 6.5 C; with max_cosine alone W + a tenth of the largest extent.
double default_width_cap(double outside_width, double centrum_radius, double largest_extent);

/// Lengths in the length unit; 0 where nothing was asked for.
struct ResolvedAccuracy {
  double width = 0.0, outside_width = 0.0, centrum_radius = 0.0, width_cap = 0.0;
  double largest_extent = 0.0;

  double width_asked() const { return width > 0.0 ? width : outside_width; }
};
ResolvedAccuracy resolve(const Accuracy& accuracy, const Frame& frame, const LengthUnit& unit);

/// Throws Error kUsage for a target of so few facets that they bound no region.
void check_facet_target(const Accuracy& accuracy, std::size_t rank);

/// The same without widths that growth, which may shift points by `shift` [ratio], cannot tell from 0: the
/// exact hull, whose facets are as narrow as rounding lets them, is what they ask for.
Accuracy above_rounding(Accuracy accuracy, const ResolvedAccuracy& lengths, double shift);

/// Throws Error kOutOfRange where simplices are gathered into facets and depths, which are kept in single
/// precision, would not be finite.
void check_depths(const Accuracy& accuracy, const ResolvedAccuracy& lengths);

/// Throws Error kOutOfRange where squares and products of lengths would not be doubles.
void check_squares(double largest_extent);

}  // namespace ndhull
