#include "approx/polytope/plane_polytope.h"

#include "core/error.h"

namespace ndhull {

PlanePolytope intersect_about_origin(const PlanesAboutOrigin& planes, const HullOptions& options) {
  const std::size_t rank = planes.rank, count = planes.heights.size();
  PlanePolytope polytope;
  if (count <= rank) {
    polytope.bounded = false;
    return polytope;
  }
  std::vector<double> dual(planes.normals.size());
  for (std::size_t row = 0; row < count; ++row) {
    for (std::size_t k = 0; k < rank; ++k)
      dual[row * rank + k] = planes.normals[row * rank + k] / planes.heights[row];
  }
  HullOptions planes_only = options;
  planes_only.certifies_planes = false;
  planes_only.wants_simplices = true;
  const Hull hull = convex_hull(PointView::row_major(dual.data(), count, rank), planes_only);
  polytope.status = hull.status;
  if (polytope.status != HullStatus::kComplete && !options.wants_partial) return polytope;
  polytope.bounded = hull.rank == rank;
  if (!polytope.bounded) return polytope;
  polytope.vertices.resize(hull.facet_count() * rank);
  for (IdRows* const rows : {&polytope.planes_of, &polytope.neighbours_of}) {
    rows->begin.reserve(hull.facet_count() + 1);
    rows->values.reserve(hull.facet_count() * rank);
  }
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
    const FacetId facet{id};
    const double offset = hull.offset(facet);
    if (!(offset < 0.0)) {
      // The hull of the dual points does not contain the origin: without all of them it need not.
      PlanePolytope open;
      open.bounded = false;
      open.status = hull.status;
      return open;
    }
    const auto normal = hull.normal(facet);
    for (std::size_t k = 0; k < rank; ++k) polytope.vertices[id * rank + k] = normal[k] / -offset;
    polytope.planes_of.append(hull.vertices_of(facet));
    polytope.neighbours_of.append(hull.neighbours_of(facet));
  }
  polytope.planes.reserve(hull.simplices().row_count * rank);
  polytope.vertex_of.reserve(hull.simplices().row_count);
  for (std::uint32_t row = 0; row < hull.simplices().row_count; ++row) {
    const auto vertices = hull.simplices().vertices(SimplexId{row});
    for (const PointId id : vertices) polytope.planes.push_back(id.value);
    polytope.vertex_of.push_back(hull.facet_of(SimplexId{row}).value);
  }
  for (const PointId id : hull.vertices) polytope.non_redundant.push_back(id.value);
  return polytope;
}

}  // namespace ndhull
