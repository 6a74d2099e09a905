#include "approx/outer_volume.h"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "approx/boundedness.h"
#include "approx/plane_polytope.h"
#include "approx/subspace.h"

namespace ndhull {
namespace {

using Eigen::Index;

/// The outer planes about the interior point, in coordinates of the subspace.
PlanesAboutOrigin outer_planes(const Hull& hull, std::span<const FacetId> facets) {
  const Eigen::MatrixXd directions = subspace_directions(hull.dimension, hull.subspace_equations);
  PlanesAboutOrigin planes;
  planes.rank = hull.rank;
  const auto add = [&](FacetId facet) {
    const Eigen::Map<const Eigen::VectorXd> normal(hull.normal(facet).data(),
                                                   static_cast<Index>(hull.dimension));
    const Eigen::VectorXd inside = directions.transpose() * normal;
    double height = hull.outer_offset(facet) * hull.input_per_length_unit(facet) - hull.centred_offset(facet);
    for (std::size_t k = 0; k < hull.dimension; ++k)
      height -= hull.normal(facet)[k] * (hull.interior_point[k] - hull.reference[k]);
    const double length = inside.norm();
    for (const double value : inside) planes.normals.push_back(value / length);
    planes.heights.push_back(height / length);
  };
  for (const FacetId facet : facets) add(facet);
  if (facets.empty()) {
    for (std::uint32_t id = 0; id < hull.facet_count(); ++id) add(FacetId{id});
  }
  return planes;
}

}  // namespace

OuterVolume outer_volume(const Hull& hull, std::span<const FacetId> facets, std::uint64_t max_simplices) {
  if (hull.rank == 0) return {0.0, ""};
  const PlanesAboutOrigin planes = outer_planes(hull, facets);
  for (const double height : planes.heights) {
    if (!(height > 0.0)) return {std::nullopt, "the interior point is not below every outer plane"};
  }
  if (!facets.empty() && !find_open_direction(planes.normals, planes.rank).bounded) {
    return {std::nullopt, "the outer planes do not bound a region"};
  }
  HullOptions options;
  options.limits.max_facets = max_simplices;
  const PlanePolytope polytope = intersect_about_origin(planes, options);
  if (polytope.status != HullStatus::kComplete) {
    return {std::nullopt,
            "the outer polytope has more than about " + std::to_string(max_simplices) + " vertices"};
  }
  if (!polytope.bounded) return {std::nullopt, "the outer planes do not bound a region"};
  return {measure_polytope(planes, polytope).volume, ""};
}

}  // namespace ndhull
