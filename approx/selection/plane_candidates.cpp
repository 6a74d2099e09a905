#include "approx/selection/plane_candidates.h"

#include <algorithm>

#include "approx/geometry/boundedness.h"
#include "approx/polytope/outer_volume.h"

namespace ndhull {

std::vector<FacetId> plane_candidates(const Hull& hull, std::size_t count) {
  std::vector<FacetId> facets(hull.facet_count());
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) facets[row] = FacetId{row};
  std::sort(facets.begin(), facets.end(), [&hull](FacetId a, FacetId b) {
    const double area_a = hull.area_of(a), area_b = hull.area_of(b);
    return area_a != area_b ? area_a > area_b : a < b;
  });
  const std::size_t most = most_candidates(count);
  if (facets.size() <= most) return facets;
  const std::vector<FacetId> few(facets.begin(), facets.begin() + static_cast<std::ptrdiff_t>(most));
  const PlanesAboutOrigin planes = outer_planes_about_interior(hull, few);
  return find_open_direction(planes.normals, planes.rank).bounded ? few : facets;
}

}  // namespace ndhull
