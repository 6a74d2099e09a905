#include "tools/io/vertex_order.h"

#include <Eigen/Dense>
#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

namespace ndhull {
namespace {

using Ids = std::vector<std::uint32_t>;

Ids as_vector(std::span<const std::uint32_t> ids) { return {ids.begin(), ids.end()}; }

/// Which halfspaces at a vertex its neighbours share.
Ids common_halfspaces(const HalfspaceIntersection& intersection, std::size_t vertex, std::size_t neighbour) {
  const auto own = intersection.halfspaces_of.row(vertex), other = intersection.halfspaces_of.row(neighbour);
  Ids common;
  std::set_intersection(own.begin(), own.end(), other.begin(), other.end(), std::back_inserter(common));
  return common;
}

/// Neighbour i lacks halfspace i alone; nothing where that is not so.
std::optional<Ids> match_neighbours(const HalfspaceIntersection& intersection, std::size_t vertex) {
  const auto own = intersection.halfspaces_of.row(vertex);
  const auto neighbours = intersection.neighbours_of.row(vertex);
  if (own.size() != intersection.rank || neighbours.size() != own.size()) return std::nullopt;
  Ids matched(own.size());
  std::vector<bool> is_known(own.size(), false);
  for (const std::uint32_t neighbour : neighbours) {
    const Ids common = common_halfspaces(intersection, vertex, neighbour);
    if (common.size() + 1 != own.size()) return std::nullopt;
    const auto missing = static_cast<std::size_t>(
        std::mismatch(common.begin(), common.end(), own.begin()).second - own.begin());
    if (is_known[missing]) return std::nullopt;
    is_known[missing] = true;
    matched[missing] = neighbour;
  }
  return matched;
}

/// Of the edges from a vertex to these neighbours, as many as dimensions.
double orientation(const HalfspaceIntersection& intersection, std::size_t vertex,
                   std::span<const std::uint32_t> neighbours) {
  const std::size_t dimension = intersection.dimension;
  const auto at = [&](std::size_t id) {
    return Eigen::Map<const Eigen::VectorXd>(intersection.vertices.data() + id * dimension,
                                             static_cast<Eigen::Index>(dimension));
  };
  Eigen::MatrixXd edges(dimension, dimension);
  for (std::size_t k = 0; k < dimension; ++k)
    edges.col(static_cast<Eigen::Index>(k)) = (at(neighbours[k]) - at(vertex)).normalized();
  return edges.determinant();
}

/// The halfspaces around a vertex in 3-d, and the neighbours between each and the next; nothing where edges
/// make no ring.
std::optional<std::pair<Ids, Ids>> ring_around(const HalfspaceIntersection& intersection,
                                               std::size_t vertex) {
  struct SharedEdge {
    std::uint32_t first, last, neighbour;
  };
  std::vector<SharedEdge> edges;
  for (const std::uint32_t neighbour : intersection.neighbours_of.row(vertex)) {
    const Ids common = common_halfspaces(intersection, vertex, neighbour);
    if (common.size() != 2) return std::nullopt;
    edges.push_back({common[0], common[1], neighbour});
  }
  if (edges.size() < 3 || edges.size() != intersection.halfspaces_of.row(vertex).size()) return std::nullopt;
  Ids halfspaces, between;
  for (std::uint32_t at = edges.front().first; !edges.empty();) {
    const auto next = std::find_if(edges.begin(), edges.end(), [at](const SharedEdge& edge) {
      return edge.first == at || edge.last == at;
    });
    if (next == edges.end()) return std::nullopt;
    halfspaces.push_back(at);
    between.push_back(next->neighbour);
    at = next->first == at ? next->last : next->first;
    edges.erase(next);
  }
  return std::pair{std::move(halfspaces), std::move(between)};
}

}  // namespace

std::vector<std::uint32_t> opposite_neighbours(const HalfspaceIntersection& intersection,
                                               std::size_t vertex) {
  return match_neighbours(intersection, vertex).value_or(as_vector(intersection.neighbours_of.row(vertex)));
}

std::vector<std::uint32_t> oriented_halfspaces(const HalfspaceIntersection& intersection,
                                               std::size_t vertex) {
  Ids own = as_vector(intersection.halfspaces_of.row(vertex));
  if (intersection.rank != intersection.dimension || intersection.rank < 2) return own;
  if (const std::optional<Ids> matched = match_neighbours(intersection, vertex)) {
    if (orientation(intersection, vertex, *matched) < 0.0) std::swap(own[0], own[1]);
    return own;
  }
  if (intersection.rank != 3) return own;
  const auto ring = ring_around(intersection, vertex);
  if (!ring) return own;
  auto [halfspaces, between] = *ring;
  if (orientation(intersection, vertex, std::span(between).first(3)) < 0.0)
    std::reverse(halfspaces.begin() + 1, halfspaces.end());
  return halfspaces;
}

}  // namespace ndhull
