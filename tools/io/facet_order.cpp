#include "tools/io/facet_order.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace ndhull {
namespace {

// A sample of simplices decides about the orientation; the one that spans most has the surest sign.
constexpr std::size_t kOrientationSamples = 256;

double orientation(const Hull& hull, const PointView& points, SimplexId simplex) {
  const auto size = static_cast<Eigen::Index>(hull.dimension);
  const std::span<const PointId> vertices = hull.simplices().vertices(simplex);
  Eigen::MatrixXd rows(size, size);
  for (Eigen::Index row = 0; row + 1 < size; ++row) {
    const PointId vertex = vertices[static_cast<std::size_t>(row) + 1];
    for (Eigen::Index k = 0; k < size; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      rows(row, k) = points.at(vertex.value, axis) - points.at(vertices[0].value, axis);
    }
  }
  rows.row(size - 1) = Eigen::Map<const Eigen::RowVectorXd>(hull.normal(hull.facet_of(simplex)).data(), size);
  rows.rowwise().normalize();
  return rows.determinant();
}

using Edge = std::pair<PointId, PointId>;  // tail, head

/// Follows edges from a tail that no edge leads to, or round from the smallest. Empty when the edges are
/// not one path or one cycle.
std::vector<PointId> chain(std::vector<Edge> edges) {
  std::sort(edges.begin(), edges.end());
  std::vector<PointId> heads;
  heads.reserve(edges.size());
  for (const Edge& edge : edges) heads.push_back(edge.second);
  std::sort(heads.begin(), heads.end());
  const auto same_tail = [](const Edge& a, const Edge& b) { return a.first == b.first; };
  // A fork could lead round for ever.
  if (std::adjacent_find(edges.begin(), edges.end(), same_tail) != edges.end() ||
      std::adjacent_find(heads.begin(), heads.end()) != heads.end()) {
    return {};
  }
  PointId at = edges.front().first;
  for (const Edge& edge : edges) {
    if (!std::binary_search(heads.begin(), heads.end(), edge.first)) at = edge.first;
  }
  std::vector<PointId> path{at};
  for (std::size_t step = 0; step < edges.size(); ++step) {
    const auto edge = std::lower_bound(edges.begin(), edges.end(), Edge{at, PointId{0}});
    if (edge == edges.end() || edge->first != at) return {};
    at = edge->second;
    if (at == path.front()) return step + 1 == edges.size() ? path : std::vector<PointId>{};
    path.push_back(at);
  }
  return path;
}

}  // namespace

FacetOrder::FacetOrder(const Hull& hull, const PointView& points) : hull_(hull) {
  const std::size_t count = hull.simplices().row_count;
  if (hull.rank != hull.dimension || hull.rank < 2) return;
  const std::size_t step = std::max<std::size_t>(1, count / kOrientationSamples);
  double surest = 0.0;
  for (std::size_t row = 0; row < count; row += step) {
    const double value = orientation(hull, points, SimplexId{static_cast<std::uint32_t>(row)});
    if (std::abs(value) > std::abs(surest)) surest = value;
  }
  reversed_ = surest > 0.0;
}

std::vector<PointId> FacetOrder::oriented_row(SimplexId simplex) const {
  const std::span<const PointId> vertices = hull_.simplices().vertices(simplex);
  std::vector<PointId> row(vertices.begin(), vertices.end());
  if (reversed_ && row.size() > 1) std::swap(row[0], row[1]);
  return row;
}

template <class Visit>
void FacetOrder::for_each_ridge(FacetId facet, const Visit& visit) const {
  for (const SimplexId simplex : hull_.simplices_of(facet)) {
    const std::span<const SimplexId> neighbours = hull_.simplices().neighbours(simplex);
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      if (hull_.facet_of(neighbours[k]) != facet) visit(simplex, k);
    }
  }
}

std::vector<PointId> FacetOrder::vertices(FacetId facet) const {
  if (hull_.is_simplicial(facet)) return oriented_row(hull_.simplices_of(facet)[0]);
  const std::span<const PointId> known = hull_.vertices_of(facet);
  std::vector<PointId> unordered(known.begin(), known.end());
  std::vector<Edge> edges;
  if (hull_.rank == 2) {
    for (const SimplexId simplex : hull_.simplices_of(facet)) {
      const std::vector<PointId> row = oriented_row(simplex);
      edges.emplace_back(row[0], row[1]);
    }
  } else if (hull_.rank == 3) {
    // The ridge opposite vertex k of an oriented triangle runs from vertex k+1 to vertex k+2.
    for_each_ridge(facet, [&](SimplexId simplex, std::size_t k) {
      const std::span<const PointId> row = hull_.simplices().vertices(simplex);
      Edge edge{row[(k + 1) % 3], row[(k + 2) % 3]};
      if (reversed_) std::swap(edge.first, edge.second);
      edges.push_back(edge);
    });
  }
  if (edges.empty()) return unordered;
  std::vector<PointId> path = chain(std::move(edges));
  // The complex may have vertices on a side of the facet that the facet itself does without.
  std::erase_if(path,
                [&](PointId vertex) { return !std::binary_search(known.begin(), known.end(), vertex); });
  // A facet merged within a width has vertices between its ends, or inside its sides, too.
  if (path.size() < hull_.rank) return unordered;
  if (hull_.rank == 2) return {path.front(), path.back()};
  return path;
}

std::vector<PointId> FacetOrder::polygon() const {
  if (hull_.rank != 2) return {};
  std::vector<Edge> edges;
  for (std::size_t row = 0; row < hull_.simplices().row_count; ++row) {
    const std::vector<PointId> vertices = oriented_row(SimplexId{static_cast<std::uint32_t>(row)});
    edges.emplace_back(vertices[0], vertices[1]);
  }
  std::vector<PointId> path = chain(std::move(edges));
  std::erase_if(path, [this](PointId vertex) {
    return !std::binary_search(hull_.vertices.begin(), hull_.vertices.end(), vertex);
  });
  return path;
}

std::size_t FacetOrder::ridge_count(FacetId facet) const {
  std::size_t count = 0;
  for_each_ridge(facet, [&count](SimplexId, std::size_t) { ++count; });
  return count;
}

void FacetOrder::for_each_cone(FacetId facet, PointId apex,
                               const std::function<void(std::span<const PointId>)>& visit) const {
  std::vector<PointId> cone;
  for_each_ridge(facet, [&](SimplexId simplex, std::size_t k) {
    // The point inside stands on the same side of the ridge as the vertex it replaces.
    const std::span<const PointId> row = hull_.simplices().vertices(simplex);
    cone.assign(row.begin(), row.end());
    cone[k] = apex;
    if (reversed_) std::swap(cone[0], cone[1]);
    visit(cone);
  });
}

}  // namespace ndhull
