// From an accuracy that is asked for to clusters of simplices: how far to grow, which facets to make.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "approx/accuracy.h"
#include "approx/facets/facet_layout.h"
#include "approx/growth/certified_growth.h"
#include "approx/hull.h"
#include "approx/slabs/star_hull.h"
#include "core/frame.h"
#include "core/machine/huge_array.h"

namespace ndhull {

/// What an earlier run with the same points has shown.
struct EarlierRun {
  bool has_run_out = false;      ///< of memory: it may end as before
  bool has_tried_exact = false;  ///< as far as that was worth it: it is not what is wanted
  /// An attempt at the exact hull: its limit on simplices is one on work, and facets found whole may have
  /// more.
  bool limits_work = false;
  std::uint64_t facets = 0;  ///< 0, or how many whole facets of it are joined to
};

/// What an approximate hull is made of.
struct ApproximationTask {
  const Frame& frame;
  const Accuracy& accuracy;
  const ResolvedAccuracy& lengths;
  const std::vector<double>& factor;  ///< gradient_factor of the frame and the length unit
  CertifiedGrowth& growth;            ///< that has not begun, or goes on from a hull of some points
  Hull& hull;                         ///< whose status and choices are set
  double input_bytes;                 ///< of the input that growth's points were kept of
  EarlierRun earlier;
};

/// Which simplices become which facet, or what was found instead.
struct ApproximateFacets {
  FacetClusters clusters;  ///< cluster_of has an entry for each row; none: facets are simplices so far
  HugeArray<double> determinants;     ///< find_outwards of all rows, if they were asked for; else no memory
  std::optional<StarHull> star_hull;  ///< a hull without its complex, in place of clusters
  /// So many points share planes that the exact hull may have no more facets than are asked for: it is to be
  /// tried first, and there are no clusters.
  bool wants_exact_first = false;
  /// A width was asked for that a hull without its complex could have, which has no early end.
  bool may_do_without_complex = false;
};

/// Grows the hull and finds its facets. The complex may keep free rows.
///
/// Promised  with a target width no facet is wider, unless a limit ended growth: rounds go on, with smaller
///           slabs and more points, until the true widths over all points fit.
ApproximateFacets approximate_facets(const ApproximationTask& task);

}  // namespace ndhull
