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

/// Sums over the simplices of one facet, as rows of rank + 2: of determinants, of determinants times
/// |gradient of the plane|, and of determinants times planes.
inline constexpr std::size_t kDeterminantSum = 0, kSurfaceSum = 1, kAreaVectorSum = 2, kMoreSums = 2;

/// So many facets at most are looked at by one thread at a time.
inline constexpr std::size_t kListedAtATime = 64;

/// Sums for those who want them. The planes and determinants are those of the simplices
/// (FacetLayout::planes).
struct SimplexSums {
  std::span<const double> determinants;  ///< of all simplices; empty: none is wanted
  /// Takes the sums of the facets [begin, end), by the thread that looks at them. Of those of one simplex
  /// only the determinant counts.
  std::function<void(std::size_t begin, std::size_t end, std::span<const double> sums)> take;
};

/// `vertices`: of the facets from layout.in_place on; null: those of their simplices. `normals`: facets x
/// dimension. All bits are the same for any number of threads.
/// Cost  for each simplex a random read of 4 rank bytes and one of 8 rank + 8 for its sums. With one thread
///       the rows are read as they stand where sums of few facets are wanted; these stay in cache, 8 bytes
///       for each number and each 64 of the points. A product for each vertex of a facet.
void find_own_dots(const SimplicialComplex& complex, const FacetLayout& layout, const IdRows* vertices,
                   const CertificatePoints& points, const double* normals, const ListedDots& dots,
                   const SimplexSums& sums);

}  // namespace ndhull
