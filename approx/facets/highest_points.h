// How far many points reach along the normals of many facets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "approx/facets/certificate_points.h"
#include "approx/facets/facet_layout.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// What is known of facets, and what is looked for.
struct FacetHeights {
  std::span<const double> normals;    ///< facets x dimension
  std::span<const double> low, high;  ///< per facet: smallest and largest product with its own vertices
  /// Per facet from layout.in_place on: how many of its vertices are about as high as the highest.
  std::span<const std::uint32_t> close;
  std::span<double> highest;  ///< out, per facet: the largest product with any point
};

/// Is a tree of so many points better for so many facets than all of their groups (highest_dots)?
bool are_many_points(std::size_t dimension, std::size_t points, std::size_t facets);

/// Fills in heights.highest where points are many: in bundles of facets with a vertex in common where facets
/// are more than points, else facet by facet.
///
/// Cost    O(n log n) for n points, and on spheres in 5-d to 7-d a tenth to half a microsecond a facet.
///         Memory: 12 bytes a coordinate of the points, 4 a facet, of 4 million at a time.
void find_highest_of_many(const SimplicialComplex& complex, const FacetLayout& layout,
                          const CertificatePoints& points, const FacetHeights& heights);

}  // namespace ndhull
