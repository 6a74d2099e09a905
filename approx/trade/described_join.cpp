#include "approx/trade/described_join.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "approx/geometry/boundedness.h"
#include "approx/slabs/merge_rule.h"
#include "approx/trade/cluster_merge.h"

namespace ndhull {
namespace {

std::vector<FacetCorners> corners_of_described(const DescribedHull& hull, const WidthSpace& space) {
  std::vector<FacetCorners> facets(hull.facets);
  for (std::size_t facet = 0; facet < hull.facets; ++facet) {
    for (const std::uint32_t id : hull.facet_vertices.row(facet))
      facets[facet].vertices.push_back(space.row_of(PointId{id}));
    const auto neighbours = hull.neighbours.row(facet);
    facets[facet].neighbours.assign(neighbours.begin(), neighbours.end());
    std::sort(facets[facet].vertices.begin(), facets[facet].vertices.end());
    std::sort(facets[facet].neighbours.begin(), facets[facet].neighbours.end());
    // By area: one that is a sliver beside a large one turns the plane by little.
    const std::span plane(hull.planes.data() + facet * space.rank(), space.rank());
    facets[facet].weight = hull.determinants[facet] / space.distance_of(plane);
  }
  return facets;
}

std::vector<FittedPlane> own_planes(const DescribedHull& hull, const WidthSpace& space) {
  const std::size_t rank = space.rank();
  std::vector<FittedPlane> planes(hull.facets);
  for (std::size_t facet = 0; facet < hull.facets; ++facet) {
    planes[facet].normal.resize(rank);
    space.normal_of({hull.planes.data() + facet * rank, rank}, planes[facet].normal.data());
  }
  return planes;
}

bool bound_a_region(const std::vector<FittedPlane>& planes, std::size_t rank) {
  std::vector<double> normals;
  for (const FittedPlane& plane : planes)
    normals.insert(normals.end(), plane.normal.begin(), plane.normal.end());
  return find_open_direction(normals, rank).bounded;
}

/// The facets that each joined one is of, those of one simplex first.
std::vector<std::vector<std::uint32_t>> parts_in_order(const DescribedHull& hull, JoinedFacets& joined) {
  std::vector<std::vector<std::uint32_t>> parts(joined.planes.size());
  for (std::uint32_t facet = 0; facet < hull.facets; ++facet) parts[joined.facet_of[facet]].push_back(facet);
  std::vector<std::uint32_t> order(parts.size()), place(parts.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_partition(order.begin(), order.end(), [&](std::uint32_t facet) {
    return parts[facet].size() == 1 && parts[facet][0] < hull.simplicial;
  });
  std::vector<std::vector<std::uint32_t>> sorted;
  std::vector<FittedPlane> planes;
  for (const std::uint32_t facet : order) {
    place[facet] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(std::move(parts[facet]));
    planes.push_back(std::move(joined.planes[facet]));
  }
  joined.planes = std::move(planes);
  for (std::uint32_t& facet : joined.facet_of) facet = place[facet];
  return sorted;
}

/// Sorted, each once.
std::vector<std::uint32_t> as_set(std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/// Vertices and neighbours; of a facet of one simplex in the order that they had.
void list_joined(const DescribedHull& hull, const JoinedFacets& joined,
                 const std::vector<std::vector<std::uint32_t>>& parts, DescribedHull& result) {
  for (std::uint32_t facet = 0; facet < parts.size(); ++facet) {
    std::vector<std::uint32_t> vertices, neighbours;
    for (const std::uint32_t part : parts[facet]) {
      const auto ids = hull.facet_vertices.row(part);
      vertices.insert(vertices.end(), ids.begin(), ids.end());
      for (const std::uint32_t other : hull.neighbours.row(part))
        if (joined.facet_of[other] != facet) neighbours.push_back(joined.facet_of[other]);
    }
    const bool is_simplex = facet < result.simplicial;
    result.facet_vertices.append(is_simplex ? vertices : as_set(std::move(vertices)));
    result.neighbours.append(is_simplex ? neighbours : as_set(std::move(neighbours)));
  }
}

/// The hull with these facets instead of its own.
DescribedHull take_joined(DescribedHull hull, const WidthSpace& space, JoinedFacets joined) {
  const std::size_t rank = space.rank();
  const std::vector<std::vector<std::uint32_t>> parts = parts_in_order(hull, joined);
  DescribedHull result;
  result.facets = parts.size();
  result.simplicial = static_cast<std::size_t>(
      std::find_if(parts.begin(), parts.end(),
                   [&](const auto& of) { return of.size() > 1 || of[0] >= hull.simplicial; }) -
      parts.begin());
  list_joined(hull, joined, parts, result);
  result.parts_begin.push_back(0);
  std::vector<std::uint32_t> faces;
  for (std::size_t facet = 0; facet < parts.size(); ++facet) {
    std::vector<double> plane(rank), area(rank, 0.0);
    if (parts[facet].size() == 1)
      std::copy_n(hull.planes.data() + parts[facet][0] * rank, rank, plane.data());
    else
      space.plane_of(joined.planes[facet].normal.data(), joined.planes[facet].height, plane.data());
    double determinant = 0.0;
    for (const std::uint32_t part : parts[facet]) {
      determinant += hull.determinants[part];
      for (std::size_t k = 0; k < rank; ++k) area[k] += hull.area_vectors[part * rank + k];
      faces.push_back(hull.faces.facets[part]);
    }
    result.planes.insert(result.planes.end(), plane.begin(), plane.end());
    result.area_vectors.insert(result.area_vectors.end(), area.begin(), area.end());
    result.determinants.push_back(determinant);
    result.parts_begin.push_back(static_cast<std::uint32_t>(faces.size()));
  }
  result.vertices = std::move(hull.vertices);
  result.faces = std::move(hull.faces);
  result.faces.facets = std::move(faces);
  return result;
}

/// False, and nothing has changed, where what is left would bound no region.
bool join_if_bounded(DescribedHull& hull, const WidthSpace& space, double cap, std::size_t least_facets) {
  const MergeRule any{.max_cosine = -1.0, .width_cap = cap, .least_facets = least_facets};
  JoinedFacets joined = join_facets(corners_of_described(hull, space), own_planes(hull, space), space, any);
  if (joined.planes.size() == hull.facets) return true;
  if (!bound_a_region(joined.planes, space.rank())) return false;
  hull = take_joined(std::move(hull), space, std::move(joined));
  return true;
}

}  // namespace

double surface_of(const DescribedHull& hull, std::span<const double> factor) {
  const std::size_t rank = hull.faces.rank;
  double surface = 0.0;
  for (std::size_t facet = 0; facet < hull.facets; ++facet) {
    double length_sq = 0.0;
    for (std::size_t i = 0; i < rank; ++i) {
      const double entry = std::inner_product(factor.begin() + static_cast<std::ptrdiff_t>(i * rank),
                                              factor.begin() + static_cast<std::ptrdiff_t>((i + 1) * rank),
                                              hull.area_vectors.data() + facet * rank, 0.0);
      length_sq += entry * entry;
    }
    surface += std::sqrt(length_sq);
  }
  return surface;
}

void join_described(DescribedHull& hull, const WidthSpace& space, double width) {
  constexpr double kLess = 0.75, kThin = 1e-3;  // of the width
  for (double cap = width; cap > kThin * width; cap *= kLess)
    if (join_if_bounded(hull, space, cap, space.rank() + 1)) return;
}

bool join_described_to(DescribedHull& hull, const WidthSpace& space, std::size_t facets) {
  return join_if_bounded(hull, space, HUGE_VAL, facets) && hull.facets <= facets;
}

}  // namespace ndhull
