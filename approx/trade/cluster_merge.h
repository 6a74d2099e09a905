// Post-merging: neighbouring facets become one while their ridge is not clearly convex (C) or their normals
// agree (A), the merge that gives the narrowest facet first.
//
// Paper  Barber, Dobkin, Huhdanpaa. The Quickhull algorithm for convex hulls. ACM TOMS 22(4), 1996 (centrum
//        test). Planes there are inherited; here they are fitted to what the facet has become.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/slabs/merge_rule.h"
#include "approx/slabs/slab_cover.h"
#include "approx/slabs/width_space.h"
#include "approx/trade/facet_corners.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// What merging did.
struct MergeCounts {
  std::uint64_t merges = 0, refused = 0;  ///< refused: wanted by the rule, forbidden by the cap
};

/// What became of facets that were joined.
struct JoinedFacets {
  std::vector<std::uint32_t> facet_of;  ///< per facet before: which it is in now
  std::vector<FittedPlane> planes;      ///< per facet now, all measured
  MergeCounts counts;
};

/// merge_clusters of facets that are no sets of simplices. Measures all planes. Facets come in the order of the
/// first of those that each is made of.
JoinedFacets join_facets(std::vector<FacetCorners> facets, std::vector<FittedPlane> planes,
                         const WidthSpace& space, const MergeRule& rule);

/// Merges facets, starting from those of `covering`, until no pair of neighbours is left that the rule wants
/// merged and the cap allows.
///
/// Planes  outer: the supporting plane over all points of the space. The centrum is the mean of the facet's
///         vertices, projected onto it.
/// Order   smallest resulting width first. The width of a union is never below that of its parts, so a width
///         computed before a neighbour grew is a lower bound, and is looked at again only when its turn
///         comes.
/// Cost    a product of a direction with all points and one fit for each pair looked at; some 3 rank a merge.
MergeCounts merge_clusters(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
                           Covering& covering);

}  // namespace ndhull
