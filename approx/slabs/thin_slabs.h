// All simplices as disjoint slabs that hold a few of them each: found from what each simplex' own plane takes
// of its neighbours, which is known for all of them before the first slab is chosen.
#pragma once

#include <functional>
#include <span>

#include "approx/slabs/dual_facets.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"
#include "core/machine/blocks.h"

namespace ndhull {

/// The determinants of all rows of a complex, with signs that make volumes positive. `also` is called for
/// blocks of all rows, by several threads, where they are computed while the rows are in cache.
using FindDeterminants = std::function<std::span<const double>(const BlockWork& also)>;

/// Stars whose slabs are grown on behind the neighbours: those of half of all neighbours and more, or of two.
/// The second leaves fewer facets, where slabs are large enough for it.
enum class GrownStars { kOfHalf, kFromTwo };

/// `facets` with each live simplex in one facet, whose simplices are connected; no vertices are listed.
///
/// Shapes  facets: of `complex`, with each row's mark, taken are the free ones alone, and room for a member
///         a live row and rank more. coordinates: points x rank, in the frame, of all points that the space
///         may name. gradient_factor: rank x rank. find_determinants: asked for them once.
/// Above   no vertices.
/// Not promised  that facets of one simplex are less than `width` thick: where points are left out far above
///           it, no plane may be found (unfit tells).
/// Cost      rank products and rank random reads of 2 bytes (4 where points are many) a simplex, by all
///           threads; then some random reads for each. Where the hull is not convex, a product of a direction
///           with all points left out for each slab tried.
DualFacets partition_into_thin_slabs(const WidthSpace& space, const double* coordinates,
                                     std::span<const double> gradient_factor, PointsAbove above, double width,
                                     GrownStars grown, const FindDeterminants& find_determinants,
                                     DualFacets facets);

}  // namespace ndhull
