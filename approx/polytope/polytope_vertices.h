// From facets of the dual hull to vertices in input coordinates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "approx/polytope/halfspace_region.h"
#include "approx/polytope/halfspace_set.h"
#include "approx/polytope/plane_polytope.h"
#include "approx/work_end.h"
#include "core/id_rows.h"

namespace ndhull {

/// Vertices as HalfspaceIntersection hands them out; ids are halfspaces.
struct PolytopeVertices {
  std::vector<double> coordinates;  // rows x dimension
  IdRows halfspaces, neighbours;
  std::vector<std::uint32_t> non_redundant;
  double max_residual = 0.0;  // [distance]
};

/// Places the vertices of `polytope`, which is stated about `centre` in coordinates of the region's subspace.
///
/// Merging   Data far from the origin have planes whose own rounding moves them by more than coplanar merging
///           of the dual allows for; a vertex from which all planes of a neighbour are within that rounding,
///           and what it moves the vertex by, takes the neighbour in. Best determined vertices first.
/// Refining  where a vertex is off one of its planes by more than their rounding, least squares on distances
///           summed in twice the precision.
/// Limits    at the end of work vertices stay apart, and as they are.
/// Cost      O(planes of the vertices x dimension) where nothing has to be refined.
PolytopeVertices place_vertices(const HalfspaceSet& halfspaces, const HalfspaceRegion& region,
                                std::span<const double> centre, const PlanesAboutOrigin& planes,
                                const PlanePolytope& polytope, const WorkEnd& end = {});

}  // namespace ndhull
