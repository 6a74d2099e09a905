// Facets as sets of simplices with planes, before they are put in order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "approx/facets/facet_layout.h"
#include "approx/slabs/plane_fit.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"
#include "core/frame.h"

namespace ndhull {

/// Were its height and low measured? Not those of a simplex that stayed alone, with its own normal.
inline bool is_measured(const FittedPlane& plane) { return plane.height > 0.0; }

/// Which simplices make up which facet, with the planes.
struct Covering {
  std::vector<std::uint32_t> facet_of;  ///< per row of the complex; kNone in free rows
  /// One a facet; height 0: a simplex that stayed alone, with its own normal, and was not measured.
  std::vector<FittedPlane> planes;
  double widest = 0.0;  ///< [distance] over the points of the WidthSpace, of the measured ones
};

/// The simplices of each facet, ascending. Cost  O(rows).
class FacetMembers {
 public:
  explicit FacetMembers(const Covering& covering);
  std::span<const std::uint32_t> of(std::size_t facet) const {
    return {rows_.data() + begin_[facet], begin_[facet + 1] - begin_[facet]};
  }

 private:
  std::vector<std::uint32_t> begin_, rows_;
};

/// The vertices of one facet after the other, each once.
class FacetVertices {
 public:
  /// As rows of the space, in the order in which the simplices `members` name them; valid until the next call.
  /// One space for all calls.
  std::span<const std::uint32_t> list(const SimplicialComplex& complex, const WidthSpace& space,
                                      std::span<const std::uint32_t> members);

 private:
  std::vector<std::uint32_t> rows_;
  std::vector<std::uint32_t> pass_of_row_;  // of the space: the last pass that met it
  std::uint32_t pass_ = 0;
};

/// Drops the facets without simplices. Returns which each is now, kNone of those. Cost  O(rows).
std::vector<std::uint32_t> drop_empty_facets(Covering& covering);

/// Of a simplex that stays alone, as Covering::planes has it.
FittedPlane own_plane(const SimplicialComplex& complex, const WidthSpace& space, std::uint32_t row);

/// Every simplex a facet of its own, with its own plane.
Covering cover_by_simplices(const SimplicialComplex& complex, const WidthSpace& space);

/// Gives facets of one simplex its own plane where no wider facet comes of it. `is_convex`: no point is above
/// any simplex. Cost  a product with all points of the space for each such facet, unless the hull is convex.
void free_lone_simplices(const SimplicialComplex& complex, const WidthSpace& space, bool is_convex,
                         Covering& covering);

/// The facets that are no mere simplex with its own plane, with their planes in the frame.
FacetClusters clusters_of(const Covering& covering, const WidthSpace& space);

/// The fewest facets that a hull can have: one for each facet of the frame's first simplex, whose normals
/// bound a region, none empty. Every simplex goes where it lies highest.
///
/// Shapes  coordinates: points x rank, in the frame.
Covering cover_by_first_simplex(const SimplicialComplex& complex, const WidthSpace& space, const Frame& frame,
                                const double* coordinates);

}  // namespace ndhull
