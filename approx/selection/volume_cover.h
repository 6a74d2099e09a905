// A target number of facets for the least volume below their outer planes: `--facets N --objective volume`.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "approx/facets/facet_layout.h"
#include "approx/work_end.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// Facets that planes were chosen for.
struct VolumeCover {
  bool is_bounded =
      true;  ///< false: no `count` planes were found that bound a region, and there are no clusters
  bool is_cut_short = false;  ///< `end` came before the choice was made
  FacetClusters clusters;
};

/// Chooses `count` of the facets' planes and gives every simplex to one of them.
///
/// Method   choose_by_rays (volume_rays.h) among the planes of the facets, of more than 20,000 the largest. A
///          simplex belongs to the plane below which its lowest vertex is highest: that only says how wide
///          facets are, not what their outer planes enclose.
/// Shapes   complex: compacted, the interior point at 0. points: rows x rank, in the frame. determinants: of
///          the simplices, positive. exact: the coplanar simplices; none: all are facets of their own.
///          gradient_factor: as lay_out.
/// Returns  nothing when there are no more than `count` facets; otherwise at most `count` facets.
/// Cost     as choose_by_rays; count x simplices x rank comparisons.
std::optional<VolumeCover> cover_for_volume(const SimplicialComplex& complex, const double* points,
                                            std::span<const double> determinants, const FacetClusters& exact,
                                            std::uint64_t count, std::span<const double> gradient_factor,
                                            const WorkEnd& end = {});

}  // namespace ndhull
