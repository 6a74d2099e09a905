// Products of the normals of facets that are lists of simplices with their own vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "approx/facets/certificate_points.h"
#include "approx/facets/facet_layout.h"
#include "core/complex/simplicial_complex.h"
#include "core/id_rows.h"

namespace ndhull {

/// Products of each normal, from facet layout.in_place on, with the vertices of the facet's simplices, or
/// with those given: the smallest, the largest, and how many are about the largest.
struct ListedDots {
  std::span<double> low, high;     // per facet
  std::span<std::uint32_t> close;  // per facet from layout.in_place on
};

/// `vertices`: of the facets from layout.in_place on; null: those of their simplices. `normals`: facets x
/// dimension. All bits are the same for any number of threads.
/// Cost  for each simplex a random read of 4 rank bytes. With one thread the rows are read as they stand
///       where a bit for each facet and point stays in cache, and simplices numbered. A product for each
///       vertex of a facet.
void find_own_dots(const SimplicialComplex& complex, FacetLayout& layout, const IdRows* vertices,
                   const CertificatePoints& points, const double* normals, const ListedDots& dots);

}  // namespace ndhull
