// What coplanar merging does with slivers: flats that add nothing to a neighbour, simplices that flats enclose.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "approx/work_end.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// A facet while merging.
struct FlatCluster {
  std::vector<std::uint32_t> simplices;  ///< none: another has taken it in
  Eigen::VectorXd plane;
  std::vector<PointId> points;  ///< ascending
};

/// The vertex of `neighbour` that `simplex`, which shares a ridge with it, has not.
inline PointId vertex_opposite(const SimplicialComplex& complex, std::uint32_t neighbour,
                               std::uint32_t simplex) {
  const auto back = complex.neighbours(SimplexId{neighbour});
  const auto slot =
      static_cast<std::size_t>(std::find(back.begin(), back.end(), SimplexId{simplex}) - back.begin());
  return complex.vertices(SimplexId{neighbour})[slot];
}

/// Joins facets with neighbours that they add nothing to: each of their vertices is one of the neighbour's or
/// lies in the neighbour's plane.
///
/// Shapes    cluster_of: one a simplex; the facet it is in or was in, FacetId::kNone: of its own.
/// Limits    at the end of work facets stay apart. Returns  false then.
/// Cost      rounds; in each a facet's neighbours are looked at when one of them has grown since the last.
bool absorb_slivers(const SimplicialComplex& complex, const double* points, double tolerance,
                    std::vector<FlatCluster>& clusters, std::vector<std::uint32_t>& cluster_of,
                    const WorkEnd& end);

}  // namespace ndhull
