// The facets of the result: planes in input units with certified outer and inner offsets, and areas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "approx/facets/certificate_points.h"
#include "approx/facets/coplanar_merge.h"
#include "approx/facets/later_areas.h"
#include "approx/geometry/length_unit.h"
#include "core/complex/simplicial_complex.h"
#include "core/frame.h"
#include "core/id_rows.h"
#include "core/machine/huge_array.h"

namespace ndhull {

/// How far all points to be certified reach along normals that are those of the facets, or hardly differ.
struct KnownHighest {
  std::vector<double> normals;  ///< one row a facet, of `dimension` numbers
  std::vector<double> highest;  ///< largest product with x - reference; empty: nothing is known
};

/// One row a facet.
struct FacetTable {
  HugeArray<double> normals;  ///< facets x dimension, unit, outward
  HugeArray<double> offsets;  ///< [distance, input units] at the reference
  HugeArray<double> outer;    ///< [distance, length unit] >= 0: all certificate points are below
  HugeArray<double> inner;  ///< [distance, length unit] <= 0: all vertices of the facet's simplices are above
  HugeArray<double> areas;  ///< [area, input units]; none where they are made later
  std::unique_ptr<LaterAreas> later_areas;
  double max_outer = 0.0, min_inner = 0.0, max_width = 0.0, roundoff = 0.0, volume = 0.0;
  double area = 0.0;     ///< sum of the facets' areas where these are there, see area_of_facets
  double surface = 0.0;  ///< sum of the simplices' areas, which merged facets see in projection only

  /// Sum of the facets' areas. Cost  those that would be made later are made.
  double area_of_facets(const FacetLayout& layout) const;
};

/// What is known of the input points that are no certificate points, about the frame's centre.
struct CoveredPoints {
  /// They lie in the hull of those that are, scaled by 1 + this; 0: well inside.
  double gauge = 0.0;
  double reach = 0.0;  ///< no point is longer than this in the frame
};

/// Makes planes, certificates and areas of all facets; areas later where facets have planes of their own.
/// Unless it `certifies`, outer offsets are +infinity. `known`: of each facet, or empty; then the points are
/// searched.
///
/// `merged_vertices`: of the merged facets, where the complex has no simplices; otherwise none.
///
/// Shapes    complex.planes and determinants: row f belongs to facet f; or, where layout.planes are the
///           facets', to simplex f. Planes and determinants are consumed: planes are turned into the normals
///           in place where the shapes allow.
/// Proof     outer: largest computed n.(x - reference) + offset over the certificate points, plus a bound on
///           the rounding of the subtraction, the dot product and the sum (gamma_{d+3} of the sizes
///           involved). A point of the hull scaled by 1 + s is at most (1 + s) outer + s height above a
///           plane. What is known for a normal that differs is raised by the sum of |differences| x largest.
/// Cost      at most facets x points x dimension fused multiply-adds (core/search/highest_dots.h,
///           core/search/furthest_points.h); where the products are known, dimension for each facet.
FacetTable make_facet_table(SimplicialComplex& complex, FacetLayout& layout, const Frame& frame,
                            const CertificatePoints& points, HugeArray<double> determinants,
                            const LengthUnit& unit, const CoveredPoints& covered, const KnownHighest& known,
                            bool certifies, const IdRows* merged_vertices = nullptr);

}  // namespace ndhull
