#include "tools/io/attached_points.h"

#include <algorithm>

#include "approx/planes/contains.h"

namespace ndhull {

std::vector<AttachedPoint> attach_points(const Hull& hull, const PointView& points,
                                         const AttachOptions& options, unsigned threads) {
  std::vector<AttachedPoint> attached;
  if ((!options.coplanar && !options.interior) || hull.facet_count() == 0) return attached;
  const std::size_t dimension = hull.dimension;
  std::vector<PointId> rest;
  std::vector<double> rows, planes;
  for (std::uint32_t id = 0; id < points.rows; ++id) {
    if (std::binary_search(hull.vertices.begin(), hull.vertices.end(), PointId{id})) continue;
    rest.push_back(PointId{id});
    for (std::size_t k = 0; k < dimension; ++k) rows.push_back(points.at(id, k) - hull.reference[k]);
  }
  if (rest.empty()) return attached;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const auto normal = hull.normal(FacetId{row});
    planes.insert(planes.end(), normal.begin(), normal.end());
    planes.push_back(hull.centred_offset(FacetId{row}));
  }
  const auto found =
      distances_to_planes(PointView::row_major(rows.data(), rest.size(), dimension), planes, threads);
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const FacetId facet{found[k].plane};
    const double inner = hull.inner_offset(facet) * hull.input_per_length_unit(facet);
    const bool is_coplanar = found[k].distance >= std::min(inner, -options.depth);
    if (is_coplanar ? options.coplanar : options.interior) attached.push_back({rest[k], facet});
  }
  return attached;
}

}  // namespace ndhull
