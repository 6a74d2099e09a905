// A Hull, seen as claims.

#include "approx/verify/verify.h"

namespace ndhull {
namespace {

class ClaimsOfHull : public HullClaims {
 public:
  explicit ClaimsOfHull(const Hull& hull) : hull_(hull) {}
  HullNumbers numbers() const override {
    return {.dimension = hull_.dimension,
            .rank = hull_.rank,
            .point_count = hull_.point_count,
            .is_approximate = hull_.is_approximate,
            .area = hull_.area,
            .volume = hull_.volume,
            .roundoff = hull_.roundoff,
            .max_outer_offset = hull_.max_outer_offset,
            .min_inner_offset = hull_.min_inner_offset,
            .max_facet_width = hull_.max_facet_width};
  }
  std::span<const double> interior_point() const override { return hull_.interior_point; }
  std::span<const double> reference() const override { return hull_.reference; }
  std::span<const PointId> vertices() const override { return hull_.vertices; }
  const SimplicialComplex& simplices() const override { return hull_.simplices(); }
  std::size_t facet_count() const override { return hull_.facet_count(); }
  std::span<const double> normal(FacetId facet) const override { return hull_.normal(facet); }
  double offset(FacetId facet) const override { return hull_.offset(facet); }
  double centred_offset(FacetId facet) const override { return hull_.centred_offset(facet); }
  double outer_offset(FacetId facet) const override { return hull_.outer_offset(facet); }
  double inner_offset(FacetId facet) const override { return hull_.inner_offset(facet); }
  double input_per_length_unit(FacetId facet) const override { return hull_.input_per_length_unit(facet); }
  double area_of(FacetId facet) const override { return hull_.area_of(facet); }
  std::span<const PointId> vertices_of(FacetId facet) const override { return hull_.vertices_of(facet); }
  std::span<const FacetId> neighbours_of(FacetId facet) const override { return hull_.neighbours_of(facet); }
  std::span<const SimplexId> simplices_of(FacetId facet) const override { return hull_.simplices_of(facet); }
  FacetId facet_of(SimplexId simplex) const override { return hull_.facet_of(simplex); }

 private:
  const Hull& hull_;
};

}  // namespace

Verification verify_hull(const PointView& points, const Hull& hull, VerifyMode mode) {
  return verify_claims(points, ClaimsOfHull(hull), mode);
}

}  // namespace ndhull
