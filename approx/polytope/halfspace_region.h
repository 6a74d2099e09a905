// Where halfspaces have points in common at all: the largest ball, the subspace when there is none, the proof
// when there is nothing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "approx/polytope/halfspace_set.h"
#include "approx/polytope/region_equations.h"
#include "core/error.h"

namespace ndhull {

/// What halfspaces have in common, seen as a set of some rank with a point strictly inside.
struct HalfspaceRegion {
  bool empty = false;
  /// Empty: weights >= 0 with sum weight a = 0 (to rounding) and sum weight b > 0, scaled so that
  /// sum weight |a| = 1.
  std::vector<WeightedHalfspace> proof;

  std::vector<double> point;  ///< strictly inside all `planes`, in the subspace up to rounding
  /// [distance] Of the largest ball in the subspace about a point of it; infinite when there is no largest
  /// one, 0 when an interior point was given.
  double radius = 0.0;
  Eigen::MatrixXd directions;             ///< orthonormal, dimension x rank: the subspace
  std::vector<std::uint32_t> planes;      ///< halfspaces that may bound the region inside its subspace
  std::vector<std::uint32_t> equalities;  ///< halfspaces whose plane contains the region, ascending
};

/// Finds the region by linear programs: a largest ball (Chebyshev centre); where its radius is rounding, the
/// planes that hold it tight are equations, and the search goes on in the subspace they leave.
///
/// Rounding  a radius within some units in the last place of the planes that decide it counts as 0.
/// Throws    Error kBadHalfspace when `interior_point` is not strictly inside: names the halfspace it is
///           furthest outside of, and the distance; when the region is so long and thin that rounding hides
///           its end and every point of it.
/// Cost      3 linear programs with rank + 1 rows a stage, of which the later ones start at the optimum of
///           the first; one stage when there is an interior.
/// Source    Boyd, Vandenberghe. Convex Optimization, sec. 8.5.1 (Chebyshev centre).
HalfspaceRegion find_region(const HalfspaceSet& halfspaces,
                            const std::optional<std::vector<double>>& interior_point);

/// What is thrown of a region whose length is lost in rounding.
Error too_long_a_region();

/// A point well inside, or a direction without end.
struct RegionCentre {
  std::vector<double> point;      ///< mean of vertices that lie far apart; empty when there is a direction
  std::vector<double> direction;  ///< unit length: no plane bounds the region along it
};

/// Moves the point of a region that is not empty to where all its planes are at a distance that fits their
/// extent, whatever its shape: a ball in a long thin region may sit at one end.
///
/// Method  the vertices furthest along each of rank directions, both ways, chosen one after the other off the
///         span of those so far, by linear programs. One that has no end is a direction.
/// Cost    2 rank linear programs with rank rows.
RegionCentre centre_region(const HalfspaceSet& halfspaces, const HalfspaceRegion& region);

}  // namespace ndhull
