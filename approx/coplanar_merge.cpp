#include "approx/coplanar_merge.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace ndhull {
namespace {

using Vector = Eigen::VectorXd;
using ConstRow = Eigen::Map<const Vector>;

class Merger {
 public:
  Merger(const SimplicialComplex& complex, const double* points, std::span<const double> determinants,
         double tolerance)
      : complex_(complex), points_(points), determinants_(determinants), tolerance_(tolerance) {}

  FacetClusters run() {
    find_flat_ridges();
    grow_facets();
    absorb_slivers();
    return number_facets();
  }

 private:
  static constexpr std::uint32_t kNone = FacetId::kNone;

  /// A facet while merging; `joined` is another facet that has taken it in, or itself.
  struct Cluster {
    std::uint32_t joined;
    std::vector<std::uint32_t> simplices;
    Vector plane;
  };

  ConstRow plane(std::uint32_t simplex) const { return {complex_.plane(SimplexId{simplex}).data(), rank()}; }
  ConstRow point(PointId id) const { return {points_ + std::size_t{id.value} * complex_.rank, rank()}; }
  Eigen::Index rank() const { return static_cast<Eigen::Index>(complex_.rank); }

  PointId opposite_vertex(std::uint32_t neighbour, std::uint32_t simplex) const {
    const auto back = complex_.neighbours(SimplexId{neighbour});
    const auto slot = static_cast<std::size_t>(std::find(back.begin(), back.end(), SimplexId{simplex}) - back.begin());
    return complex_.vertices(SimplexId{neighbour})[slot];
  }

  void find_flat_ridges() {
    has_flat_ridge_.assign(complex_.row_count, false);
    for (std::uint32_t simplex = 0; simplex < complex_.row_count; ++simplex) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
        const double gauge = plane(simplex).dot(point(opposite_vertex(neighbour.value, simplex))) - 1.0;
        if (gauge <= -tolerance_) continue;
        has_flat_ridge_[simplex] = true;
        has_flat_ridge_[neighbour.value] = true;
      }
    }
  }

  void grow_facets() {
    cluster_of_.assign(complex_.row_count, kNone);
    std::vector<std::pair<double, std::uint32_t>> seeds;
    for (std::uint32_t simplex = 0; simplex < complex_.row_count; ++simplex) {
      // |det| / height is the area up to a constant factor.
      if (has_flat_ridge_[simplex]) seeds.emplace_back(-determinants_[simplex] * plane(simplex).norm(), simplex);
    }
    std::sort(seeds.begin(), seeds.end());
    for (const auto& [negative_area, seed] : seeds) {
      if (cluster_of_[seed] == kNone) grow_from(seed);
    }
  }

  void grow_from(std::uint32_t seed) {
    const auto id = static_cast<std::uint32_t>(clusters_.size());
    Cluster cluster{id, {seed}, plane(seed)};
    cluster_of_[seed] = id;
    for (std::size_t i = 0; i < cluster.simplices.size(); ++i) {
      const std::uint32_t simplex = cluster.simplices[i];
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
        if (!has_flat_ridge_[neighbour.value] || cluster_of_[neighbour.value] != kNone) continue;
        const double gauge = cluster.plane.dot(point(opposite_vertex(neighbour.value, simplex))) - 1.0;
        if (std::abs(gauge) > tolerance_) continue;
        cluster_of_[neighbour.value] = id;
        cluster.simplices.push_back(neighbour.value);
      }
    }
    if (cluster.simplices.size() > 1) fit_plane(cluster);
    clusters_.push_back(std::move(cluster));
  }

  std::vector<PointId> points_of(const Cluster& cluster) const {
    std::vector<PointId> ids;
    for (const std::uint32_t simplex : cluster.simplices) {
      const auto vertices = complex_.vertices(SimplexId{simplex});
      ids.insert(ids.end(), vertices.begin(), vertices.end());
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
  }

  // Minimises sum (a.v - 1)^2. Kept only when it is no wider than the seed's plane: a thin flat does not
  // determine all coordinates of its plane.
  void fit_plane(Cluster& cluster) const {
    const std::vector<PointId> ids = points_of(cluster);
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(ids.size()), rank());
    for (std::size_t i = 0; i < ids.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = point(ids[i]);
    const Vector ones = Vector::Ones(rows.rows());
    Vector residual = ones - rows * cluster.plane;
    const double before = residual.lpNorm<Eigen::Infinity>();
    const Vector fitted = cluster.plane + rows.colPivHouseholderQr().solve(residual);
    residual = ones - rows * fitted;
    if (residual.lpNorm<Eigen::Infinity>() < before) cluster.plane = fitted;
  }

  std::uint32_t root(std::uint32_t cluster) const {
    while (clusters_[cluster].joined != cluster) cluster = clusters_[cluster].joined;
    return cluster;
  }

  // Smallest facets first: a sliver between two flats has all its vertices in both.
  void absorb_slivers() {
    for (std::uint32_t id = static_cast<std::uint32_t>(clusters_.size()); id-- > 0;) {
      const std::vector<PointId> ids = points_of(clusters_[id]);
      double best_width = tolerance_;
      std::uint32_t best = kNone;
      for (const std::uint32_t simplex : clusters_[id].simplices) {
        for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
          const std::uint32_t other_cluster = cluster_of_[neighbour.value];
          if (other_cluster == kNone || root(other_cluster) == id) continue;
          const std::uint32_t other = root(other_cluster);
          double width = 0.0;
          for (const PointId vertex : ids) {
            width = std::max(width, std::abs(clusters_[other].plane.dot(point(vertex)) - 1.0));
            if (width >= best_width) break;
          }
          if (width < best_width) {
            best_width = width;
            best = other;
          }
        }
      }
      if (best == kNone) continue;
      Cluster& into = clusters_[best];
      into.simplices.insert(into.simplices.end(), clusters_[id].simplices.begin(), clusters_[id].simplices.end());
      clusters_[id].simplices.clear();
      clusters_[id].joined = best;
    }
  }

  /// Facets are numbered by their first simplex, so the order does not depend on how they were merged.
  FacetClusters number_facets() const {
    FacetClusters facets;
    facets.facet_of_simplex.assign(complex_.row_count, FacetId{});
    facets.simplices.values.reserve(complex_.row_count);
    for (std::uint32_t simplex = 0; simplex < complex_.row_count; ++simplex) {
      if (facets.facet_of_simplex[simplex].valid()) continue;
      const FacetId facet{static_cast<std::uint32_t>(facets.facet_count())};
      std::vector<std::uint32_t> members{simplex};
      const double* from = complex_.plane(SimplexId{simplex}).data();
      if (cluster_of_[simplex] != kNone) {
        const Cluster& cluster = clusters_[root(cluster_of_[simplex])];
        members = cluster.simplices;
        std::sort(members.begin(), members.end());
        from = cluster.plane.data();
      }
      for (const std::uint32_t member : members) facets.facet_of_simplex[member] = facet;
      facets.simplices.values.insert(facets.simplices.values.end(), members.begin(), members.end());
      facets.simplices.begin.push_back(static_cast<std::uint32_t>(facets.simplices.values.size()));
      facets.planes.insert(facets.planes.end(), from, from + complex_.rank);
    }
    return facets;
  }

  const SimplicialComplex& complex_;
  const double* points_;
  std::span<const double> determinants_;
  double tolerance_;
  std::vector<bool> has_flat_ridge_;
  std::vector<std::uint32_t> cluster_of_;
  std::vector<Cluster> clusters_;
};

/// Do the normals of these facets span all dimensions? Gram-Schmidt, done as soon as they do.
bool normals_span(const FacetClusters& facets, std::span<const std::uint32_t> incident, std::size_t rank) {
  // Normals closer than this to the span of others are taken to lie in it: merged planes agree with the true
  // ones to about roundoff over the facet's size, far below.
  constexpr double kIndependent = 1e-7;
  const auto size = static_cast<Eigen::Index>(rank);
  Eigen::MatrixXd found(size, size);
  Eigen::Index count = 0;
  for (const std::uint32_t facet : incident) {
    Vector normal = ConstRow(facets.planes.data() + std::size_t{facet} * rank, size).normalized();
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

FacetClusters merge_coplanar(const SimplicialComplex& complex, const double* points,
                             std::span<const double> determinants, double tolerance) {
  return Merger(complex, points, determinants, tolerance).run();
}

std::vector<bool> find_vertices(const SimplicialComplex& complex, const FacetClusters& facets,
                                std::size_t point_count) {
  // Incidences of the points that touch a merged facet; the others are vertices without a question.
  std::vector<bool> is_vertex(point_count, false), in_doubt(point_count, false);
  std::vector<std::uint32_t> last_facet(point_count, FacetId::kNone);
  for (std::size_t facet = 0; facet < facets.facet_count(); ++facet) {
    const auto members = facets.simplices.row(facet);
    for (const std::uint32_t simplex : members) {
      for (const PointId id : complex.vertices(SimplexId{simplex})) {
        is_vertex[id.value] = true;
        if (members.size() > 1) in_doubt[id.value] = true;
      }
    }
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> incidences;
  for (std::uint32_t facet = 0; facet < facets.facet_count(); ++facet) {
    for (const std::uint32_t simplex : facets.simplices.row(facet)) {
      for (const PointId id : complex.vertices(SimplexId{simplex})) {
        if (!in_doubt[id.value] || last_facet[id.value] == facet) continue;
        last_facet[id.value] = facet;
        incidences.emplace_back(id.value, facet);
      }
    }
  }
  std::sort(incidences.begin(), incidences.end());
  std::vector<std::uint32_t> around;
  for (std::size_t begin = 0, end = 0; begin < incidences.size(); begin = end) {
    around.clear();
    for (end = begin; end < incidences.size() && incidences[end].first == incidences[begin].first; ++end) {
      around.push_back(incidences[end].second);
    }
    is_vertex[incidences[begin].first] = normals_span(facets, around, complex.rank);
  }
  return is_vertex;
}

}  // namespace ndhull
