// The vertices of a facet in the order that Qhull's formats print them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "approx/hull.h"

namespace ndhull {

/// Orders and orients facets by the rows of the growth complex: all of them have the same orientation, so
/// one sign turns every facet the way Qhull prints it. No distance is compared with a threshold.
///
/// Orientation  det(v1 - v0, ..., normal) < 0: from outside, a facet of a 3-d hull runs clockwise. Where the
///              points span fewer dimensions than they have, orientation has no meaning and is left as it is.
/// Lifetime     the hull must outlive this object.
class FacetOrder {
 public:
  FacetOrder(const Hull& hull, const PointView& points);

  /// Vertices of `facet`: oriented when it is simplicial, in cyclic order when the rank is 3, from end to
  /// end when it is 2, otherwise as the hull gives them.
  std::vector<PointId> vertices(FacetId facet) const;

  /// All vertices of a hull of rank 2, once round; empty for another rank.
  std::vector<PointId> polygon() const;

  /// Ridges of `facet`: pairs of neighbouring simplices of which one belongs to it.
  std::size_t ridge_count(FacetId facet) const;

  /// Cones from the inside of `facet` over its ridges: calls `visit` with rank ids each, oriented, in which
  /// `apex` stands for the point inside.
  void for_each_cone(FacetId facet, PointId apex,
                     const std::function<void(std::span<const PointId>)>& visit) const;

 private:
  std::vector<PointId> oriented_row(SimplexId simplex) const;
  template <class Visit>
  void for_each_ridge(FacetId facet, const Visit& visit) const;

  const Hull& hull_;
  bool reversed_ = false;  // rows of the complex are mirror images of what is printed
};

}  // namespace ndhull
