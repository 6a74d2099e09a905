#include <algorithm>
#include <numeric>

#include "approx/facets/pulled_simplices.h"
#include "approx/facets/regrown_simplices.h"
#include "approx/hull_run.h"

namespace ndhull {

void HullBuilder::rename_points(Hull& hull, std::span<const std::uint32_t> ids, std::size_t point_count) {
  hull.point_count = point_count;
  for (PointId& vertex : hull.vertices) vertex.value = ids[vertex.value];
  if (hull.later_) {
    hull.later_->rename_points(ids);
    for (std::uint32_t& id : hull.lists_->lists.vertices.values) id = ids[id];
    return;
  }
  hull.lists_ = std::make_unique<Hull::Lists>();  // of the points as they are called now
  const std::size_t rank = hull.simplices_.rank;
  for (std::size_t row = 0; row < hull.simplices_.row_count; ++row) {
    std::uint32_t* vertices = hull.simplices_.topology.data() + row * 2 * rank;
    for (std::size_t k = 0; k < rank; ++k) vertices[k] = ids[vertices[k]];
  }
}

void HullBuilder::adopt(DescribedHull found) {
  const std::size_t rank = frame_.rank;
  hull_.status = HullStatus::kComplete;
  hull_.vertices = std::move(found.vertices);
  complex() = SimplicialComplex(rank, found.facets);
  complex().row_count = found.facets;
  std::copy(found.planes.begin(), found.planes.end(), complex().planes.data());
  determinants_ = HugeArray<double>::to_write(found.facets);
  std::copy(found.determinants.begin(), found.determinants.end(), determinants_.data());
  hull_.layout_.facets = found.facets;
  hull_.layout_.area_vectors = std::move(found.area_vectors);
  hull_.is_approximate = found.is_joined();
  growth_->want_all();
  certify_facets(KnownHighest(), &found.facet_vertices);
  hull_.layout_.simplicial = found.simplicial;
  hull_.lists_->lists = {std::move(found.facet_vertices), std::move(found.neighbours)};
  std::call_once(hull_.lists_->made, [] {});
  const auto& values = hull_.lists_->lists.vertices.values;
  hull_.later_ = std::make_unique<PulledSimplices>(
      std::move(found.faces),
      std::vector<std::uint32_t>(values.begin(),
                                 values.begin() + static_cast<std::ptrdiff_t>(rank * found.simplicial)),
      std::move(found.parts_begin));
  for (std::uint32_t facet = 0; facet < found.facets; ++facet)
    hull_.simplex_count_ += hull_.later_->count_of(FacetId{facet});
}

/// A hull that was found without its complex. Facets of one simplex come first.
void HullBuilder::adopt(StarHull found) {
  const Clock::time_point start = Clock::now();
  RowFacets& facets = found.facets;
  const std::size_t rank = frame_.rank, count = facets.count();
  std::vector<double> coordinates;
  std::vector<std::uint32_t> ids, order(count);
  for (const PointId vertex : found.vertices) {
    const double* y = growth_->coordinates() + std::size_t{vertex.value} * rank;
    coordinates.insert(coordinates.end(), y, y + rank);
    ids.push_back(vertex.value);
  }
  std::iota(order.begin(), order.end(), 0u);
  const auto merged = std::stable_partition(order.begin(), order.end(),
                                            [&](std::uint32_t facet) { return facets.sizes[facet] == 1; });
  // The plane that is nearest to the centre is where a distance is the largest part of a height.
  growth_->certify_by_search(growth_->left_out_points(true), found.distance / facets.least_distance,
                             KnownHighest());
  complex() = SimplicialComplex(rank, count);
  complex().row_count = count;
  determinants_ = HugeArray<double>::to_write(count);
  hull_.layout_.area_vectors.resize(count * rank);
  IdRows vertices, points;
  std::vector<std::uint32_t> sizes(count);
  for (std::size_t row = 0; row < count; ++row) {
    const std::size_t facet = order[row];
    std::copy_n(facets.planes.data() + facet * rank, rank, complex().planes.data() + row * rank);
    std::copy_n(facets.area_vectors.data() + facet * rank, rank,
                hull_.layout_.area_vectors.data() + row * rank);
    determinants_[row] = facets.determinants[facet];
    sizes[row] = facets.sizes[facet];
    for (const std::uint32_t vertex : facets.vertices.row(facet)) {
      vertices.values.push_back(vertex);
      points.values.push_back(ids[vertex]);
    }
    vertices.end_row();
  }
  points.begin = vertices.begin;
  hull_.layout_.merged_surface = facets.surface;
  facets = RowFacets();  // before the table is made
  hull_.is_approximate = true;
  hull_.layout_.facets = count;
  hull_.layout_.surface_exponent = found.surface_exponent;
  certify_facets(KnownHighest(), &points);
  hull_.layout_.simplicial = static_cast<std::size_t>(merged - order.begin());
  hull_.vertices = std::move(found.vertices);
  std::sort(hull_.vertices.begin(), hull_.vertices.end());
  hull_.simplex_count_ = found.simplices;
  hull_.later_ = std::make_unique<RegrownSimplices>(rank, std::move(coordinates), std::move(ids),
                                                    std::move(vertices), std::move(sizes), std::move(order));
  seconds(Phase::kMerge) += seconds_since(start);
}

void rename_points(Hull& hull, std::span<const std::uint32_t> ids, std::size_t point_count) {
  HullBuilder::rename_points(hull, ids, point_count);
}

}  // namespace ndhull
