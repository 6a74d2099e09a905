// Hulls made by hand: every claim is a field, so that a test can make any of them wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "approx/verify/hull_claims.h"

namespace ndhull {

/// A facet of a hull made by hand; fields as in Hull.
struct HandMadeFacet {
  std::vector<double> normal;
  double offset = 0.0;
  double centred_offset = 0.0;
  double outer_offset = 0.0;
  double inner_offset = 0.0;
  double unit = 1.0;
  double area = 0.0;
  std::vector<PointId> vertices;
  std::vector<FacetId> neighbours;
  std::vector<SimplexId> simplices;
};

/// Points and the claims about them.
class HandMadeHull : public HullClaims {
 public:
  std::vector<double> points;  ///< rows x dimension
  HullNumbers claimed;
  std::vector<double> interior;
  std::vector<double> origin;  ///< reference
  std::vector<PointId> vertex_ids;
  SimplicialComplex complex;
  std::vector<HandMadeFacet> facets;
  std::vector<FacetId> facet_of_simplex;

  PointView view() const {
    return PointView::row_major(points.data(), points.size() / claimed.dimension, claimed.dimension);
  }
  /// Shares the claimed area out among the facets, which are all the same.
  void share_area();
  /// Sets the numbers of the whole hull to what its facets claim.
  void settle_numbers();

  HullNumbers numbers() const override { return claimed; }
  std::span<const double> interior_point() const override { return interior; }
  std::span<const double> reference() const override { return origin; }
  std::span<const PointId> vertices() const override { return vertex_ids; }
  const SimplicialComplex& simplices() const override { return complex; }
  std::size_t facet_count() const override { return facets.size(); }
  std::span<const double> normal(FacetId facet) const override { return facets[facet.value].normal; }
  double offset(FacetId facet) const override { return facets[facet.value].offset; }
  double centred_offset(FacetId facet) const override { return facets[facet.value].centred_offset; }
  double outer_offset(FacetId facet) const override { return facets[facet.value].outer_offset; }
  double inner_offset(FacetId facet) const override { return facets[facet.value].inner_offset; }
  double input_per_length_unit(FacetId facet) const override { return facets[facet.value].unit; }
  double area_of(FacetId facet) const override { return facets[facet.value].area; }
  std::span<const PointId> vertices_of(FacetId facet) const override { return facets[facet.value].vertices; }
  std::span<const FacetId> neighbours_of(FacetId facet) const override {
    return facets[facet.value].neighbours;
  }
  std::span<const SimplexId> simplices_of(FacetId facet) const override {
    return facets[facet.value].simplices;
  }
  FacetId facet_of(SimplexId simplex) const override { return facet_of_simplex[simplex.value]; }

  std::uint32_t* simplex_vertices(std::size_t row) {
    return complex.topology.data() + row * 2 * complex.rank;
  }
  std::uint32_t* simplex_neighbours(std::size_t row) { return simplex_vertices(row) + complex.rank; }
};

/// Corners of [-1, 1]^d with 2 d facets (or, not merged, its simplices: the corners of each facet along all
/// monotone paths), all planes exact. Point 2^d and later ones: `more_points` (rows x d), not on the hull.
HandMadeHull hand_made_cube(std::size_t d, bool merged, const std::vector<double>& more_points = {});
/// +-e_i: points 2 i and 2 i + 1. Each vertex is exactly on its planes.
HandMadeHull hand_made_cross_polytope(std::size_t d);

}  // namespace ndhull
