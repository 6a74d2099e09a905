// All that a witness may see of a hull: what it claims, nothing of how it was made.
#pragma once

#include <cstddef>
#include <span>

#include "approx/hull.h"
#include "core/plane_value.h"

namespace ndhull {

/// The numbers a hull claims as a whole; see Hull.
struct HullNumbers {
  std::size_t dimension = 0;
  std::size_t rank = 0;
  std::size_t point_count = 0;
  bool is_approximate = false;    ///< facets are clusters of simplices within a width, not flats
  double area = 0.0;              ///< input units
  double volume = 0.0;            ///< input units
  double roundoff = 0.0;          ///< [distance] length unit
  double max_outer_offset = 0.0;  ///< [distance] length unit
  double min_inner_offset = 0.0;  ///< [distance] length unit
  double max_facet_width = 0.0;   ///< [distance] length unit
};

/// A hull as claims. An interface, so that tests can hand the witness hulls that are wrong in one place.
/// All functions may be called from several threads; spans stay valid.
class HullClaims {
 public:
  virtual ~HullClaims() = default;
  virtual HullNumbers numbers() const = 0;
  virtual std::span<const double> interior_point() const = 0;
  virtual std::span<const double> reference() const = 0;
  virtual std::span<const PointId> vertices() const = 0;
  virtual const SimplicialComplex& simplices() const = 0;

  virtual std::size_t facet_count() const = 0;
  virtual std::span<const double> normal(FacetId facet) const = 0;
  virtual double offset(FacetId facet) const = 0;
  virtual double centred_offset(FacetId facet) const = 0;
  virtual double outer_offset(FacetId facet) const = 0;
  virtual double inner_offset(FacetId facet) const = 0;
  virtual double input_per_length_unit(FacetId facet) const = 0;
  virtual double area_of(FacetId facet) const = 0;
  virtual std::span<const PointId> vertices_of(FacetId facet) const = 0;
  virtual std::span<const FacetId> neighbours_of(FacetId facet) const = 0;
  virtual std::span<const SimplexId> simplices_of(FacetId facet) const = 0;
  virtual FacetId facet_of(SimplexId simplex) const = 0;

  /// The parallel plane at `claimed` (length unit) above the facet's certified plane.
  CentredPlane plane_at(FacetId facet, double claimed) const {
    return {normal(facet), reference(), centred_offset(facet), claimed, input_per_length_unit(facet)};
  }
};

}  // namespace ndhull
