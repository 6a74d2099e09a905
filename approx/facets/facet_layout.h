// Which simplices make up which facet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/ids.h"
#include "core/machine/huge_array.h"

namespace ndhull {

/// Facets of more than one simplex, as merging finds them. Each row of the complex says in which it is, or
/// they list their rows.
struct FacetClusters {
  std::vector<std::uint32_t> cluster_of;  ///< per row of the complex; FacetId::kNone: a facet of its own
  std::uint32_t count = 0;
  /// All live rows of the complex: those that are facets of their own, then those of each cluster.
  std::vector<SimplexId> simplices;
  std::vector<std::uint32_t> begin;  ///< of each cluster in `simplices`, and the end; empty: not listed
  /// Rows x rank, dual planes in the frame: one a cluster, or as `own_plane` says.
  std::vector<double> planes;
  /// Per cluster: the row of `planes` that is its plane; FacetId::kNone: that of the simplex seeds[cluster]
  /// is. Empty: each has the row with its number.
  std::vector<std::uint32_t> own_plane, seeds;
  bool is_cut_short = false;  ///< at the end of work, more would have been merged

  const double* plane_of(const SimplicialComplex& complex, std::uint32_t cluster) const {
    const std::uint32_t own = own_plane.empty() ? cluster : own_plane[cluster];
    return own == FacetId::kNone ? complex.plane(SimplexId{seeds[cluster]}).data()
                                 : planes.data() + std::size_t{own} * complex.rank;
  }
  bool are_listed() const { return !begin.empty(); }
  /// All facets of a complex of so many simplices.
  std::size_t facets_of(std::size_t simplices_in_all) const;
  /// Instead of lists.
  void number_rows(std::size_t row_count);
  /// Clusters of one simplex whose plane is parallel to its own, but for rounding, become facets of their
  /// own. Of clusters that are not listed, one plane each. Where none is left coplanar facets are merged, as
  /// those of an exact hull.
  void release_lone_simplices(const SimplicialComplex& complex);
  /// All planes, count x rank.
  std::vector<double> planes_of(const SimplicialComplex& complex) const;
  /// Those of the simplices too, which may be solved again.
  void keep_planes(const SimplicialComplex& complex) {
    planes = planes_of(complex);
    own_plane.clear();
    seeds.clear();
  }
  /// As compact has moved rows, of which there are now so many.
  void move_rows(std::span<const RowMove> moves, std::size_t row_count);
};

/// How the rows of a complex group into facets. What is simple needs no table:
///   [0, regular)            facet f is simplex f, and so are its neighbours
///   [regular, simplicial)   facet f is one simplex, simplices[f]; some neighbour is a merged facet
///   [simplicial, facets)    merged facets: facet simplicial + m is the rows simplices[merged_begin[m]] up
///                           to, not including, simplices[merged_begin[m + 1]]
/// Either facets of one simplex are the rows with their numbers (in_place = simplicial), or rows stand
/// anywhere and none is known by its number (in_place = regular = 0).
struct FacetLayout {
  std::size_t regular = 0;
  std::size_t in_place = 0;
  std::size_t simplicial = 0;
  std::size_t facets = 0;
  std::vector<std::uint32_t> merged_begin;  ///< facets - simplicial + 1 entries; the first is `simplicial`
  std::vector<SimplexId> simplices;         ///< facet by facet: those of one simplex, then the merged
  /// Of simplex in_place + i. Where facets have planes of their own: none before number_simplices().
  std::vector<FacetId> facet_of_others;
  /// Where no row moves: facets x rank, the planes of the facets. The complex' planes and the determinants
  /// are then the simplices', and sums over these are made where they are wanted (later_areas.h). Else empty.
  HugeArray<double> planes;
  std::vector<double> gradient_factor;  ///< rank x rank, times 2^-surface_exponent; where there are planes
  /// Merged facets x rank, where there are no planes: the sum of determinant times plane over the simplices;
  /// as a covector of the frame it points along the facet's mean normal, and its product with a direction is
  /// a projected area.
  std::vector<double> area_vectors;
  /// The sum of determinant times |gradient of the plane|, in input units, over all merged simplices:
  /// merged_surface * 2^surface_exponent; where there are no planes.
  double merged_surface = 0.0;
  int surface_exponent = 0;

  /// Cost  a write anywhere in memory for each simplex, by all threads; nothing where it was done.
  void number_simplices();
  FacetId facet_of(SimplexId simplex) const {
    return simplex.value < in_place ? FacetId{simplex.value} : facet_of_others[simplex.value - in_place];
  }
  /// Of the complex that lay_out has put in order: the dual plane of a facet.
  const double* plane_of(const SimplicialComplex& complex, FacetId facet) const {
    return (planes.data() != nullptr ? planes : complex.planes).data() +
           std::size_t{facet.value} * complex.rank;
  }
  std::span<const SimplexId> simplices_of(FacetId facet) const {
    if (facet.value < simplicial) return {simplices.data() + facet.value, 1};
    const std::size_t merged = facet.value - simplicial;
    return {simplices.data() + merged_begin[merged], merged_begin[merged + 1] - merged_begin[merged]};
  }
};

/// A gradient factor times 2^-exponent, so that areas of huge data are doubles.
struct ScaledFactor {
  std::vector<double> factor;
  int exponent = 0;
};
ScaledFactor scale_factor(std::span<const double> gradient_factor);

/// The layout without merging.
FacetLayout simplicial_layout(const SimplicialComplex& complex);

/// Where fewer than half of the rows of a compacted complex are in merged facets: puts the others, and the
/// determinants with them, in front; rows of merged facets move only to make room. Else no row moves: hardly
/// a facet is beside none that is merged, and facets have planes of their own. Where rows move, row f of
/// complex.planes becomes the plane of facet f, determinants[f] the sum over its simplices; rows behind the
/// facets' are given back.
///
/// Shapes  determinants: complex.row_count. gradient_factor: rank x rank, |R a| the gradient of the gauge
///         above plane a in input units. clusters: their memory is the facet table's then.
/// Order   as clusters list them where no row moves; else merged facets stand in the order of their first
///         simplex, as the rows were, their simplices ascending. Rows that can stay do.
/// Cost    O(rows rank).
FacetLayout lay_out(SimplicialComplex& complex, std::span<double> determinants, FacetClusters clusters,
                    std::span<const double> gradient_factor);

}  // namespace ndhull
