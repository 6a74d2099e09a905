// What the facet table has to know of facets that are lists of simplices: products with their own vertices,
// and sums over their simplices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "approx/certificate_points.h"
#include "approx/facet_layout.h"
#include "core/id_rows.h"
#include "core/simplicial_complex.h"

namespace ndhull {

/// Products of each normal, from facet layout.in_place on, with the vertices of the facet's simplices, or
/// with those given: the smallest, the largest, and how many are about the largest.
struct ListedDots {
  std::span<double> low, high;     // per facet
  std::span<std::uint32_t> close;  // per facet from layout.in_place on
};

/// So many facets are looked at by one thread at a time.
inline constexpr std::size_t kListedAtATime = 64;
/// Finds what else is wanted of the facets [begin, end).
using VisitFacets = std::function<void(std::size_t begin, std::size_t end)>;

/// `vertices`: of the facets from layout.in_place on; null: those of their simplices. `normals`: facets x
/// dimension. `also`: called for blocks of facets, by the thread that looks at them.
/// Cost  a random read of 4 rank bytes for each simplex, and a product for each vertex of a facet.
void find_own_dots(const SimplicialComplex& complex, const FacetLayout& layout, const IdRows* vertices,
                   const CertificatePoints& points, const double* normals, const ListedDots& dots,
                   const VisitFacets& also);

/// Sums over the simplices of facets.
struct SimplexSums {
  std::span<double> determinants;  // per facet
  /// Per merged facet x rank: of determinants times planes.
  std::span<double> area_vectors;
  double surface = 0.0;  // of determinants times |gradient of the plane|, over all
};

/// Of facets [begin, begin + sums.determinants.size()), the planes and determinants being those of the
/// simplices (FacetLayout::planes). `area_vectors` has rows for those that are merged.
/// Cost  a random read of 8 rank + 8 bytes for each simplex.
void sum_simplices(const SimplicialComplex& complex, std::span<const double> determinants,
                   const FacetLayout& layout, std::size_t begin, SimplexSums& sums);

}  // namespace ndhull
