// Which neighbours are to be merged: not clearly convex (C), or much alike in direction (A).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/slabs/plane_fit.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

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

/// A plane that simplices are compared with, in the frame: with a the dual vertex of a simplex and l its
/// distance from the frame's centre, l (facing . a) is the cosine between the normals, and l (a . centrum -
/// 1) is how far the centrum is above the simplex.
struct RulePlane {
  double middle = 0.0;                  ///< [distance] height of the plane midway
  std::vector<double> facing, centrum;  ///< rank
};

/// The rule between single simplices and a facet that grows.
class SimplexRule {
 public:
  /// `is_convex`: no point of the space is above any simplex's plane by more than rounding. 16 bytes a row.
  /// The rule must outlive this.
  SimplexRule(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
              bool is_convex);

  /// The plane of a slab around `seed`, whose middle is the centrum.
  void set_plane(SimplexId seed, const FittedPlane& plane, RulePlane& compared) const;

  /// `mean_dot`: the mean of the products of the plane's normal with the simplex's vertices.
  /// Cost  where the hull is not convex, a product of a direction with all points for each simplex that is
  ///       asked for the first time, by any thread; else none.
  bool wants(SimplexId simplex, double mean_dot, const RulePlane& plane, PlaneFitWork& work) const;

  /// How far the points reach along the simplex's normal is known: asking needs no product any more.
  void learn_height(SimplexId simplex, double height) const;

 private:
  double distance_of(SimplexId simplex) const;
  double rise_of(SimplexId simplex, PlaneFitWork& work) const;

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const MergeRule& rule_;
  bool is_convex_;
  // Per row; NaN: not asked for yet. Threads that ask at once find the same.
  mutable std::vector<double> distances_;  // [distance] of the simplex's plane from the centre
  mutable std::vector<double> rises_;      // [distance] of the plane midway above that
};

}  // namespace ndhull
