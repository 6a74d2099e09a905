// Which simplices make up which facet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ids.h"

namespace ndhull {

/// How the rows of a complex group into facets. The rows are ordered so that what is simple needs no table:
///   [0, regular)            facet f is simplex f, and so are its neighbours
///   [regular, simplicial)   facet f is simplex f; some neighbour is a merged facet
///   [simplicial, facets)    merged facets: facet simplicial + m is the simplices merged_begin[m] up to, not
///                           including, merged_begin[m + 1]
struct FacetLayout {
  std::size_t regular = 0;
  std::size_t simplicial = 0;
  std::size_t facets = 0;
  std::vector<std::uint32_t> merged_begin;  ///< facets - simplicial + 1 entries; the first is `simplicial`
  std::vector<FacetId> facet_of_merged;     ///< of simplex simplicial + i

  FacetId facet_of(SimplexId simplex) const {
    return simplex.value < simplicial ? FacetId{simplex.value} : facet_of_merged[simplex.value - simplicial];
  }
};

}  // namespace ndhull
