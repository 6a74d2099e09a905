// Which points of the merged hull are vertices.
#include <Eigen/Core>
#include <algorithm>

#include "approx/facets/coplanar_merge.h"

namespace ndhull {
namespace {

using Vector = Eigen::VectorXd;
using ConstRow = Eigen::Map<const Vector>;

/// Calls visit(point, facet) for merged facets' points that are not known to be vertices, once for each facet.
template <class Visit>
void for_points_of_merged(const SimplicialComplex& complex, const FacetLayout& layout,
                          const std::vector<bool>& is_vertex, const Visit& visit) {
  std::vector<std::uint32_t> last_facet(is_vertex.size(), FacetId::kNone);
  for (auto facet = static_cast<std::uint32_t>(layout.simplicial); facet < layout.facets; ++facet) {
    for (const SimplexId simplex : layout.simplices_of(FacetId{facet})) {
      for (const PointId id : complex.vertices(simplex)) {
        if (is_vertex[id.value] || last_facet[id.value] == facet) continue;
        last_facet[id.value] = facet;
        visit(id.value, facet);
      }
    }
  }
}

/// A merged facet hardly larger than the tolerance can be left with fewer than rank vertices. It keeps as
/// many of its points as it needs, those in most facets first (`facets_at`: how many, for points in merged
/// facets only; `found`: per merged facet, how many of its points became vertices here). One vertex too many
/// is harmless, one too few is not.
void keep_enough_of_merged(const SimplicialComplex& complex, const FacetLayout& layout,
                           const std::vector<std::uint32_t>& facets_at,
                           const std::vector<std::uint32_t>& found, std::vector<bool>& is_vertex) {
  std::vector<PointId> points;
  std::vector<std::uint32_t> last_facet(is_vertex.size(), FacetId::kNone);
  for (std::uint32_t merged = 0; merged + layout.simplicial < layout.facets; ++merged) {
    if (found[merged] >= complex.rank) continue;
    points.clear();
    const FacetId facet{static_cast<std::uint32_t>(layout.simplicial) + merged};
    for (const SimplexId simplex : layout.simplices_of(facet)) {
      for (const PointId id : complex.vertices(simplex)) {
        if (last_facet[id.value] == merged) continue;
        last_facet[id.value] = merged;
        points.push_back(id);
      }
    }
    auto kept = static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [&](PointId id) { return is_vertex[id.value]; }));
    if (kept >= complex.rank) continue;
    std::sort(points.begin(), points.end());
    std::stable_sort(points.begin(), points.end(),
                     [&](PointId a, PointId b) { return facets_at[a.value] > facets_at[b.value]; });
    for (const PointId id : points) {
      if (is_vertex[id.value] || kept >= complex.rank) continue;
      is_vertex[id.value] = true;
      ++kept;
    }
  }
}

/// Do the normals of these facets span all dimensions? Gram-Schmidt, done as soon as they do.
bool normals_span(const SimplicialComplex& complex, const FacetLayout& layout,
                  std::span<const std::uint32_t> incident) {
  // Normals closer than this to the span of others are taken to lie in it: merged planes agree with the true
  // ones to about the merging tolerance over the facet's size.
  constexpr double kIndependent = 1e-9;
  const auto size = static_cast<Eigen::Index>(complex.rank);
  Eigen::MatrixXd found(size, size);
  Eigen::Index count = 0;
  for (const std::uint32_t facet : incident) {
    Vector normal = ConstRow(layout.plane_of(complex, FacetId{facet}), size).normalized();
    for (int pass = 0; pass < 2; ++pass) {
      normal -= found.leftCols(count) * (found.leftCols(count).transpose() * normal);
    }
    const double rest = normal.norm();
    if (rest <= kIndependent) continue;
    found.col(count++) = normal / rest;
    if (count == size) return true;
  }
  return false;
}

}  // namespace

void keep_enough_vertices(const SimplicialComplex& complex, const FacetLayout& layout,
                          std::vector<bool>& is_vertex) {
  for (std::uint32_t facet = 0; facet < layout.simplicial; ++facet)
    for (const SimplexId simplex : layout.simplices_of(FacetId{facet}))
      for (const PointId id : complex.vertices(simplex)) is_vertex[id.value] = true;
  // Of the others only facets with corners that are no vertices are looked at.
  std::vector<std::uint32_t> facets_at(is_vertex.size(), 0);
  std::vector<std::uint32_t> found(layout.facets - layout.simplicial,
                                   static_cast<std::uint32_t>(complex.rank));
  for_points_of_merged(complex, layout, is_vertex, [&](std::uint32_t point, std::uint32_t facet) {
    ++facets_at[point];
    found[facet - layout.simplicial] = 0;
  });
  keep_enough_of_merged(complex, layout, facets_at, found, is_vertex);
}

std::vector<bool> find_vertices(const SimplicialComplex& complex, const FacetLayout& layout,
                                std::size_t point_count) {
  // All vertices of a facet that was not merged are vertices: it is clearly convex. Points in merged facets
  // only are looked at.
  std::vector<bool> is_vertex = find_corners(complex, 0, layout.in_place, point_count);
  for (std::size_t facet = layout.in_place; facet < layout.simplicial; ++facet)
    for (const PointId id : complex.vertices(layout.simplices[facet])) is_vertex[id.value] = true;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> incidences;
  for_points_of_merged(complex, layout, is_vertex, [&](std::uint32_t point, std::uint32_t facet) {
    incidences.emplace_back(point, facet);
  });
  std::sort(incidences.begin(), incidences.end());
  std::vector<std::uint32_t> around, facets_at(point_count, 0), found(layout.facets - layout.simplicial, 0);
  for (std::size_t begin = 0, end = 0; begin < incidences.size(); begin = end) {
    around.clear();
    for (end = begin; end < incidences.size() && incidences[end].first == incidences[begin].first; ++end) {
      around.push_back(incidences[end].second);
    }
    facets_at[incidences[begin].first] = static_cast<std::uint32_t>(around.size());
    if (!normals_span(complex, layout, around)) continue;
    is_vertex[incidences[begin].first] = true;
    for (const std::uint32_t facet : around) ++found[facet - layout.simplicial];
  }
  keep_enough_of_merged(complex, layout, facets_at, found, is_vertex);
  return is_vertex;
}

}  // namespace ndhull
