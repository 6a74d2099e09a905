// All simplices as disjoint slabs: simplices around a seed whose vertices all lie less than a width below one
// plane that no point is above.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "approx/slabs/dual_facets.h"
#include "approx/slabs/thin_slabs.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// Growth was shorter than the exact hull's where it left out so many points, in parts of the vertices.
inline constexpr double kSomeLeftOut = 1.0 / 6.0;

/// How many simplices slabs hold: the mean over simplices, which few large slabs can rule, and what all
/// simplices are divided by to get the number of slabs.
struct SlabSizes {
  double mean = 1.0, typical = 1.0;
};

/// What a partition is for, and what is known of its slabs.
struct PartitionTask {
  std::size_t most_facets = SIZE_MAX;   ///< more are of no use
  std::optional<SlabSizes> sizes = {};  ///< of the last partition, of nearly the same hull; none: sampled
  double expected_facets = 0.0;         ///< out: about how many there would be
  bool has_too_many() const { return expected_facets > static_cast<double>(most_facets); }
};

/// Each live simplex is in one facet, whose simplices are connected. Nothing where growth left points out and
/// so few slabs hold all that a choice among overlapping ones (approx/slabs/slab_cover.h) is better, nor where
/// a sample of slabs tells that there would be too many. Planes are the seeds' own; where growth left many
/// points out, or slabs are large, turned to what the slab holds. Vertices are listed unless slabs hold so few
/// simplices that they were found from stars (approx/slabs/thin_slabs.h), which joining would hardly make
/// fewer.
///
/// Shapes  coordinates: points x rank, in the frame. gradient_factor: rank x rank. find_determinants: asked
///         for once, unless nothing is returned. None: no stars are looked for; so where a point was shifted.
/// Not promised  that facets of one simplex are less than `width` thick: where points are left out far above
///           it, no plane may be found (unfit tells).
/// Cost      each simplex is met in one slab, with its neighbours; those that are tried as seeds and left for
///           later have their neighbours looked at for each time; in up to three passes where planes are
///           turned, with a fit for each. Where points were left out, a product of a direction with them, or
///           with all points, for each slab tried.
std::optional<DualFacets> partition_into_slabs(const SimplicialComplex& complex, const WidthSpace& space,
                                               const double* coordinates,
                                               std::span<const double> gradient_factor, PointsAbove above,
                                               double width, const FindDeterminants& find_determinants,
                                               PartitionTask& task);

}  // namespace ndhull
