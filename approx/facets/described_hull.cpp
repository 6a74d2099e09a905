#include "approx/facets/described_hull.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "approx/facets/flat_plane.h"
#include "core/linear/dense_solve.h"

namespace ndhull {
namespace {

bool has_bit(std::span<const std::uint64_t> bits, std::size_t i) {
  return (bits[i / 64] >> (i % 64) & 1) != 0;
}

template <class Visit>
void for_each_bit(std::span<const std::uint64_t> bits, const Visit& visit) {
  for (std::size_t w = 0; w < bits.size(); ++w)
    for (std::uint64_t left = bits[w]; left != 0; left &= left - 1)
      visit(static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(std::countr_zero(left)));
}

}  // namespace

HullDescription::HullDescription(const double* coordinates, std::size_t count, const Frame& frame,
                                 std::uint64_t most_words)
    : points_(coordinates),
      count_(count),
      rank_(frame.rank),
      growth_(coordinates, count, frame.rank, frame.simplex, most_words) {}

bool HullDescription::advance(std::uint64_t work) {
  if (is_hopeless_) return false;
  constexpr std::uint64_t kLessWork = 8;
  if (!is_promising_) work /= kLessWork;
  if (!is_settled_ && !grow(work)) return false;
  return measure(work);
}

std::uint64_t HullDescription::simplex_count() const { return count_simplices(hull_.faces); }

/// Facets first. Returns true when they are all there.
bool HullDescription::grow(std::uint64_t work) {
  const DoubleDescription::Outcome outcome = growth_.run(work);
  if (outcome == DoubleDescription::Outcome::kGoing) {
    // What gets hardly anywhere will go on for long; where most facets are simplices little is won.
    constexpr double kLeastShare = 1.0 / 32.0;
    is_promising_ =
        growth_.share_added() >= kLeastShare && 2 * growth_.simplicial_count() <= growth_.facet_count();
    return false;
  }
  if (outcome == DoubleDescription::Outcome::kDone) {
    incidence_ = growth_.take();
    is_settled_ = settle() && find_vertices();
    if (is_settled_) name_by_vertices();
  }
  is_hopeless_ = !is_settled_;
  return is_settled_;
}

std::vector<PointId> HullDescription::points_of(std::size_t facet) const {
  std::vector<PointId> ids;
  for_each_bit(incidence_.bits(facet), [&](std::uint32_t id) { ids.push_back(PointId{id}); });
  return ids;
}

/// Fits the planes and looks at every decision again.
bool HullDescription::settle() {
  for (std::size_t facet = 0; facet < incidence_.count(); ++facet) {
    if (incidence_.neighbours[facet].size() < rank_) return false;
    double* plane = incidence_.planes.data() + facet * rank_;
    fit_flat_plane(points_, rank_, points_of(facet), plane);
    for (std::size_t id = 0; id < count_; ++id) {
      double gauge = -1.0;
      for (std::size_t k = 0; k < rank_; ++k) gauge += plane[k] * points_[id * rank_ + k];
      const bool is_in = has_bit(incidence_.bits(facet), id);
      if (is_in ? std::abs(gauge) > DoubleDescription::kInPlane : gauge > -0.5 * DoubleDescription::kClear)
        return false;
    }
  }
  return incidence_.count() > rank_;
}

/// A point is a vertex when all points that are in each of its facets are equal to it: in no other facet.
bool HullDescription::find_vertices() {
  std::vector<std::vector<std::uint32_t>> facets_of(count_);
  for (std::uint32_t facet = 0; facet < incidence_.count(); ++facet)
    for_each_bit(incidence_.bits(facet), [&](std::uint32_t id) { facets_of[id].push_back(facet); });
  std::vector<std::uint64_t> common(incidence_.words);
  for (std::uint32_t id = 0; id < count_; ++id) {
    if (facets_of[id].size() < rank_) continue;
    std::fill(common.begin(), common.end(), ~std::uint64_t{0});
    for (const std::uint32_t facet : facets_of[id])
      for (std::size_t w = 0; w < common.size(); ++w) common[w] &= incidence_.bits(facet)[w];
    bool is_vertex = true;
    for_each_bit(common, [&](std::uint32_t other) {
      is_vertex = is_vertex && other >= id && facets_of[other].size() == facets_of[id].size();
    });
    if (is_vertex) hull_.vertices.push_back(PointId{id});
  }
  return hull_.vertices.size() > rank_;
}

/// The facets in terms of the vertices alone; those that are simplices first.
void HullDescription::name_by_vertices() {
  const std::size_t count = incidence_.count();
  by_vertex_.rank = rank_;
  by_vertex_.words = (hull_.vertices.size() + 63) / 64;
  std::vector<std::uint64_t> bits(count * by_vertex_.words);
  const auto bits_of = [&](std::uint32_t facet) {
    return std::span(bits).subspan(facet * by_vertex_.words, by_vertex_.words);
  };
  std::vector<std::uint32_t> order(count), place(count);
  std::iota(order.begin(), order.end(), 0u);
  for (const std::uint32_t facet : order)
    for (std::size_t i = 0; i < hull_.vertices.size(); ++i)
      bits_of(facet)[i / 64] |= std::uint64_t{has_bit(incidence_.bits(facet), hull_.vertices[i].value)}
                                << (i % 64);
  const auto merged = std::stable_partition(order.begin(), order.end(), [&](std::uint32_t facet) {
    std::size_t size = 0;
    for (const std::uint64_t word : bits_of(facet)) size += static_cast<std::size_t>(std::popcount(word));
    return size == rank_;
  });
  hull_.facets = count;
  hull_.simplicial = static_cast<std::size_t>(merged - order.begin());
  for (std::uint32_t i = 0; i < count; ++i) place[order[i]] = i;
  for (const std::uint32_t facet : order) {
    hull_.planes.insert(hull_.planes.end(), incidence_.plane(facet).begin(), incidence_.plane(facet).end());
    by_vertex_.points.insert(by_vertex_.points.end(), bits_of(facet).begin(), bits_of(facet).end());
    std::vector<std::uint32_t>& neighbours = by_vertex_.neighbours.emplace_back();
    for (const std::uint32_t other : incidence_.neighbours[facet]) neighbours.push_back(place[other]);
    std::sort(neighbours.begin(), neighbours.end());
  }
  by_vertex_.planes = hull_.planes;
  for (const PointId id : hull_.vertices)
    vertex_coordinates_.insert(vertex_coordinates_.end(), points_ + id.value * rank_,
                               points_ + (id.value + 1) * rank_);
  incidence_ = FacetIncidence();
}

/// The facets' volumes.
bool HullDescription::measure(std::uint64_t work) {
  hull_.faces = pull_faces(by_vertex_, vertex_coordinates_.data(), work);
  const std::size_t measured = hull_.faces.facets.size();
  if (measured < hull_.facets) {
    // The faces of some hulls are far more than their facets. The first facets take longest.
    constexpr std::size_t kLeastPart = 8;
    is_promising_ = measured > hull_.simplicial &&
                    kLeastPart * (measured - hull_.simplicial) >= hull_.facets - hull_.simplicial;
    return false;
  }
  is_hopeless_ = !closes() || !list_facets();
  return !is_hopeless_;
}

/// The areas times the normals of a closed surface sum to 0. Keeps the volumes of the facets' cones.
bool HullDescription::closes() {
  std::vector<double> sum(rank_, 0.0);
  double surface = 0.0;
  for (std::size_t facet = 0; facet < hull_.facets; ++facet) {
    const std::span<const double> plane = by_vertex_.plane(facet);
    double length_sq = 0.0;
    for (const double entry : plane) length_sq += entry * entry;
    const double cone = hull_.faces.faces[hull_.faces.facets[facet]].measure / std::sqrt(length_sq);
    hull_.determinants.push_back(cone);
    for (std::size_t k = 0; k < rank_; ++k) {
      hull_.area_vectors.push_back(cone * plane[k]);
      sum[k] += cone * plane[k];
    }
    surface += cone * std::sqrt(length_sq);
  }
  constexpr double kOpen = 1e-9;
  return std::all_of(sum.begin(), sum.end(),
                     [&](double entry) { return std::abs(entry) <= kOpen * surface; });
}

/// Lists in terms of points. False: a simplicial facet has other neighbours than one opposite each vertex.
bool HullDescription::list_facets() {
  std::vector<std::uint32_t> vertices;
  for (const PointId id : hull_.vertices) vertices.push_back(id.value);
  rename_vertices(hull_.faces, vertices);
  for (std::size_t facet = 0; facet < hull_.facets; ++facet) {
    vertices.clear();
    for_each_bit(by_vertex_.bits(facet), [&](std::uint32_t vertex) { vertices.push_back(vertex); });
    std::vector<std::uint32_t> neighbours = by_vertex_.neighbours[facet];
    if (facet < hull_.simplicial) {
      orient(vertices);
      if (!put_opposite(vertices, neighbours)) return false;
    }
    for (std::uint32_t& vertex : vertices) vertex = hull_.vertices[vertex].value;
    hull_.facet_vertices.append(vertices);
    hull_.neighbours.append(neighbours);
  }
  return true;
}

/// Swaps two vertices of a simplex where its determinant is negative.
void HullDescription::orient(std::vector<std::uint32_t>& vertices) const {
  const auto rank = static_cast<Eigen::Index>(rank_);
  Eigen::MatrixXd rows(rank, rank);
  for (std::size_t i = 0; i < rank_; ++i)
    for (std::size_t k = 0; k < rank_; ++k)
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          vertex_coordinates_[vertices[i] * rank_ + k];
  if (SquareFactors(rows).determinant() < 0.0) std::swap(vertices[0], vertices[1]);
}

/// Neighbour k becomes the one without vertex k.
bool HullDescription::put_opposite(const std::vector<std::uint32_t>& vertices,
                                   std::vector<std::uint32_t>& neighbours) const {
  if (neighbours.size() != rank_) return false;
  for (std::size_t k = 0; k < rank_; ++k) {
    const auto opposite =
        std::find_if(neighbours.begin() + static_cast<std::ptrdiff_t>(k), neighbours.end(),
                     [&](std::uint32_t other) { return !has_bit(by_vertex_.bits(other), vertices[k]); });
    if (opposite == neighbours.end()) return false;
    std::iter_swap(neighbours.begin() + static_cast<std::ptrdiff_t>(k), opposite);
  }
  return true;
}

}  // namespace ndhull
