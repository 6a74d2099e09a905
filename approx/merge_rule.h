// Which neighbours are to be merged: not clearly convex (C), or much alike in direction (A).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/plane_fit.h"
#include "approx/width_space.h"
#include "core/simplicial_complex.h"

namespace ndhull {

/// When two neighbours are merged: either reason is enough. The plane of a facet lies midway between its
/// outer and its inner plane; its centrum is the mean of its vertices, projected onto that.
struct MergeRule {
  double centrum_radius = 0.0;   ///< [distance] a centrum is less than this below the other's plane; 0: off
  double max_cosine = 2.0;       ///< the normals' cosine is above this; above 1: off
  double width_cap = 0.0;        ///< [distance] no merged facet is wider
  std::size_t least_facets = 0;  ///< as many stay

  bool wants(const FittedPlane& a, std::span<const double> centrum_a, const FittedPlane& b,
             std::span<const double> centrum_b) const;
};

/// The mean of these vertices (rows of the space), moved along the normal to the plane midway.
std::vector<double> centrum_on_plane(const WidthSpace& space, std::span<const std::uint32_t> vertices,
                                     const FittedPlane& plane);

/// The rule between single simplices and a facet that grows.
class SimplexRule {
 public:
  /// Measures every live simplex: one product of a direction with all points of the space each, and
  /// 8 (2 rank + 1) bytes a row. The rule must outlive this.
  SimplexRule(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule);

  bool wants(SimplexId simplex, const FittedPlane& plane, std::span<const double> centrum) const;
  /// The middle of the simplex, projected onto `plane`.
  std::vector<double> centrum_on(SimplexId simplex, const FittedPlane& plane) const;

 private:
  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const MergeRule& rule_;
  std::vector<double> normals_, centrums_, heights_;  // per row
};

}  // namespace ndhull
