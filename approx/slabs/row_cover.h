// Facets of a given width for simplices that are known by their vertices alone.
//
// Idea. A slab, all that is less than the width below a plane that no point is above, is known by its
// vertices; which simplices it holds is a search among rows (core/complex/simplex_rows.h), and whether they hang
// together is of no account. So nothing has to know neighbours or planes of all simplices: each slab takes
// what it holds and no other has. Slabs that would take few are put off, so that most are full
// (approx/slabs/slab_partition.h does the same over neighbours).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "approx/slabs/width_space.h"
#include "core/complex/simplex_rows.h"
#include "core/id_rows.h"
#include "core/ids.h"

namespace ndhull {

/// Facets that together are all simplices, each one in one of them, in the order in which they took theirs.
struct RowFacets {
  std::vector<double> planes;        ///< facets x rank, dual planes in the frame
  std::vector<double> determinants;  ///< of each the sum over its simplices' vertex rows, > 0
  std::vector<double> area_vectors;  ///< facets x rank: the sum of determinant times plane
  double surface = 0.0;              ///< of all simplices the sum of determinant times |R plane|
  std::vector<std::uint32_t> sizes;  ///< simplices of each
  IdRows vertices;                   ///< of each, numbers of vertices, ascending
  double least_distance = 0.0;       ///< [distance] no simplex' plane is nearer to the centre
  std::size_t count() const { return sizes.size(); }
};

/// What is asked now and then, from the calling thread: give up, with so many simplices in no facet yet, and
/// so many facets?
using CoverQuestion = std::function<bool(std::uint64_t simplices_left, std::uint64_t facets)>;

/// Covers all rows with slabs of `width`.
///
/// Shapes  space: its first rows are the vertices as `rows` numbers them. coordinates: points x rank, in the
///         frame. area_factor: rank x rank, R of RowFacets::surface.
/// Returns nothing when a simplex alone is wider, or `gives_up` says so.
/// Cost    for each slab tried a few products of a direction with the vertices, and searches in the space; a
///         linear system for each simplex, twice. A byte a simplex, besides the rows.
std::optional<RowFacets> cover_rows(const SimplexRows& rows, const WidthSpace& space,
                                    const double* coordinates, std::span<const double> area_factor,
                                    double width, const CoverQuestion& gives_up);

}  // namespace ndhull
