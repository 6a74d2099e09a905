#include "approx/facets/coplanar_merge.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "approx/facets/flat_facets.h"
#include "approx/facets/flat_plane.h"
#include "core/machine/blocks.h"
#include "core/search/plane_kernels.h"

namespace ndhull {
namespace {

using Vector = Eigen::VectorXd;
using ConstRow = Eigen::Map<const Vector>;

class Merger {
 public:
  Merger(const SimplicialComplex& complex, const double* points, std::span<const double> determinants,
         double tolerance)
      : complex_(complex), points_(points), determinants_(determinants), tolerance_(tolerance) {}

  FacetClusters run(std::span<const std::uint8_t> is_shifted) {
    has_flat_ridge_.assign(complex_.row_count, 0);
    cluster_of_.assign(complex_.row_count, kNone);
    std::vector<std::uint8_t> looks_at = simplices_at(is_shifted);
    if (2 * std::count(looks_at.begin(), looks_at.end(), 1) > std::ssize(looks_at)) {
      take_flat_facets();
      // Of the others all are looked at: a ridge to a simplex that was at a shifted vertex may be flat.
      for (std::size_t row = 0; row < looks_at.size(); ++row) looks_at[row] = cluster_of_[row] == kNone;
    }
    if (std::find(looks_at.begin(), looks_at.end(), 1) != looks_at.end()) {
      mark_flat(complex_, points_, tolerance_, looks_at, has_flat_ridge_);
      grow_facets();
    }
    if (!clusters_.empty()) absorb_slivers();
    return facets();
  }

 private:
  static constexpr std::uint32_t kNone = FacetId::kNone;

  /// A facet while merging; `joined` is another facet that has taken it in, or itself.
  struct Cluster {
    std::uint32_t joined;
    std::vector<std::uint32_t> simplices;
    Vector plane;
    std::vector<PointId> points;  // ascending
  };

  ConstRow plane(std::uint32_t simplex) const { return {complex_.plane(SimplexId{simplex}).data(), rank()}; }
  ConstRow point(PointId id) const { return {points_ + std::size_t{id.value} * complex_.rank, rank()}; }
  Eigen::Index rank() const { return static_cast<Eigen::Index>(complex_.rank); }

  PointId opposite_vertex(std::uint32_t neighbour, std::uint32_t simplex) const {
    const auto back = complex_.neighbours(SimplexId{neighbour});
    const auto slot =
        static_cast<std::size_t>(std::find(back.begin(), back.end(), SimplexId{simplex}) - back.begin());
    return complex_.vertices(SimplexId{neighbour})[slot];
  }

  /// Those with a vertex of these.
  std::vector<std::uint8_t> simplices_at(std::span<const std::uint8_t> is_vertex) const {
    constexpr std::size_t kSimplicesInBlock = 16384;
    std::vector<std::uint8_t> is_one(complex_.row_count, 0);
    for_each_block(complex_.row_count, kSimplicesInBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const SimplexId simplex{static_cast<std::uint32_t>(row)};
        for (const PointId id : complex_.vertices(simplex)) is_one[row] |= is_vertex[id.value];
      }
    });
    return is_one;
  }

  void take_flat_facets() {
    for (FlatFacet& flat : find_flat_facets(complex_, points_, determinants_, tolerance_, cluster_of_)) {
      const auto id = static_cast<std::uint32_t>(clusters_.size());
      clusters_.push_back({id, std::move(flat.simplices), plane(flat.seed), std::move(flat.points)});
      if (clusters_.back().simplices.size() > 1) fit_plane(clusters_.back());
    }
    for (std::size_t row = 0; row < complex_.row_count; ++row)
      has_flat_ridge_[row] = cluster_of_[row] != kNone;
  }

  void grow_facets() {
    std::vector<std::pair<double, std::uint32_t>> seeds;
    for (std::uint32_t simplex = 0; simplex < complex_.row_count; ++simplex) {
      // |det| / height is the area up to a constant factor.
      if (has_flat_ridge_[simplex] && cluster_of_[simplex] == kNone)
        seeds.emplace_back(-std::abs(determinants_[simplex]) * plane(simplex).norm(), simplex);
    }
    std::sort(seeds.begin(), seeds.end());
    for (const auto& [negative_area, seed] : seeds) {
      if (cluster_of_[seed] == kNone) grow_from(seed);
    }
  }

  void grow_from(std::uint32_t seed) {
    const auto id = static_cast<std::uint32_t>(clusters_.size());
    Cluster cluster{id, {seed}, plane(seed), {}};
    cluster_of_[seed] = id;
    ++stamp_;
    for (const PointId vertex : complex_.vertices(SimplexId{seed})) {
      look_of(vertex) = {stamp_, true};
      cluster.points.push_back(vertex);
    }
    for (std::size_t i = 0; i < cluster.simplices.size(); ++i) {
      const std::uint32_t simplex = cluster.simplices[i];
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
        if (!has_flat_ridge_[neighbour.value] || cluster_of_[neighbour.value] != kNone) continue;
        const PointId opposite = opposite_vertex(neighbour.value, simplex);
        PointLook& look = look_of(opposite);  // many simplices have the same: its gauge is taken once
        if (look.stamp != stamp_) {
          look = {stamp_, std::abs(cluster.plane.dot(point(opposite)) - 1.0) <= tolerance_};
          if (look.is_in_plane) cluster.points.push_back(opposite);
        }
        if (!look.is_in_plane) continue;
        cluster_of_[neighbour.value] = id;
        cluster.simplices.push_back(neighbour.value);
      }
    }
    if (cluster.simplices.size() > 1) fit_plane(cluster);
    std::sort(cluster.points.begin(), cluster.points.end());
    clusters_.push_back(std::move(cluster));
  }

  /// Was a point looked at for the cluster with this stamp, and is it in its seed's plane?
  struct PointLook {
    std::uint32_t stamp = 0;
    bool is_in_plane = false;
  };

  PointLook& look_of(PointId id) {
    if (id.value >= looks_.size()) looks_.resize(2 * std::size_t{id.value} + 2);
    return looks_[id.value];
  }

  void fit_plane(Cluster& cluster) {
    fit_flat_plane(points_, complex_.rank, cluster.points, cluster.plane.data());
  }

  std::uint32_t root(std::uint32_t cluster) const {
    while (clusters_[cluster].joined != cluster) cluster = clusters_[cluster].joined;
    return cluster;
  }

  // A facet that adds nothing to a neighbour joins it: each of its vertices is one of the neighbour's or lies
  // in the neighbour's plane. Smallest facets first, again until none is left: a sliver's neighbours may be
  // slivers that join a flat only later.
  void absorb_slivers() {
    for (bool changed = true; changed;) {
      changed = adopt_enclosed() || adopt_pinned();
      for (auto id = static_cast<std::uint32_t>(clusters_.size()); id-- > 0;) {
        if (clusters_[id].joined != id) continue;
        const std::uint32_t best = best_host(id);
        if (best == kNone) continue;
        join(id, best);
        changed = true;
      }
      if (!changed) changed = join_pockets();
    }
  }

  /// A facet has at least rank neighbours. One of several simplices with fewer is a pocket between flats,
  /// deeper than the tolerance: it joins the neighbour in whose plane it lies best.
  bool join_pockets() {
    bool any = false;
    for (auto id = static_cast<std::uint32_t>(clusters_.size()); id-- > 0;) {
      if (clusters_[id].simplices.size() < 2 || !list_neighbours(id)) continue;
      double best_width = HUGE_VAL;
      std::uint32_t best = kNone;
      for (const std::uint32_t other : neighbours_) {
        const double width = added_width(clusters_[id], clusters_[other], HUGE_VAL);
        if (width >= best_width) continue;
        best_width = width;
        best = other;
      }
      if (best == kNone) continue;
      join(id, best);
      any = true;
    }
    return any;
  }

  /// The facets of several simplices beside this one. False: it has rank neighbours.
  bool list_neighbours(std::uint32_t id) {
    neighbours_.clear();
    std::vector<std::uint32_t>& alone = simplices_beside_;
    alone.clear();
    for (const std::uint32_t simplex : clusters_[id].simplices) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
        const bool is_of_several = is_merged(neighbour.value);
        const std::uint32_t other = is_of_several ? root(cluster_of_[neighbour.value]) : neighbour.value;
        std::vector<std::uint32_t>& list = is_of_several ? neighbours_ : alone;
        if ((is_of_several && other == id) || std::find(list.begin(), list.end(), other) != list.end())
          continue;
        list.push_back(other);
        if (neighbours_.size() + alone.size() >= complex_.rank) return false;
      }
    }
    return true;
  }

  /// A simplex with two ridges to the same facet has all its vertices there, and joins it however it is
  /// tilted.
  bool adopt_enclosed() {
    bool any = false;
    std::vector<std::uint32_t> hosts;
    for (const std::uint32_t simplex : simplices_beside_facets()) {
      hosts.clear();
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
        if (cluster_of_[neighbour.value] != kNone) hosts.push_back(root(cluster_of_[neighbour.value]));
      }
      std::sort(hosts.begin(), hosts.end());
      const auto twice = std::adjacent_find(hosts.begin(), hosts.end());
      if (twice == hosts.end()) continue;
      adopt(simplex, *twice);
      any = true;
    }
    return any;
  }

  /// Simplices in no cluster that are neighbours of a facet of several, ascending.
  std::vector<std::uint32_t> simplices_beside_facets() const {
    std::vector<std::uint32_t> beside;
    if (std::find(cluster_of_.begin(), cluster_of_.end(), kNone) == cluster_of_.end()) return beside;
    for (const Cluster& cluster : clusters_) {
      if (cluster.simplices.size() < 2) continue;
      for (const std::uint32_t simplex : cluster.simplices) {
        for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex}))
          if (cluster_of_[neighbour.value] == kNone) beside.push_back(neighbour.value);
      }
    }
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    return beside;
  }

  /// A vertex of a hull is in at least rank facets. A simplex that has a vertex in fewer, all the others
  /// around it being merged, is a sliver thicker than the tolerance: it joins the facet whose plane it is
  /// nearest to.
  bool adopt_pinned() {
    const std::size_t enough = complex_.rank;
    std::vector<std::uint32_t> facets_at;  // of each point of a facet of several; 0: of no such facet
    for (const Cluster& cluster : clusters_) {
      if (cluster.simplices.size() < 2) continue;
      if (cluster.points.back().value >= facets_at.size()) facets_at.resize(cluster.points.back().value + 1u);
      for (const PointId id : cluster.points) ++facets_at[id.value];
    }
    const auto in_doubt = [&](PointId id) {
      return id.value < facets_at.size() && facets_at[id.value] != 0 && facets_at[id.value] < enough;
    };
    auto doubts = std::count_if(facets_at.begin(), facets_at.end(),
                                [&](std::uint32_t count) { return count != 0 && count < enough; });
    // Most vertices are in so many simplices that a part of all settles it.
    for (std::uint32_t simplex = 0; simplex < complex_.row_count && doubts > 0; ++simplex) {
      if (is_merged(simplex)) continue;
      for (const PointId id : complex_.vertices(SimplexId{simplex}))
        if (in_doubt(id) && ++facets_at[id.value] == enough) --doubts;
    }
    if (doubts == 0) return false;
    bool any = false;
    for (std::uint32_t simplex = 0; simplex < complex_.row_count; ++simplex) {
      if (is_merged(simplex)) continue;
      const auto vertices = complex_.vertices(SimplexId{simplex});
      if (std::any_of(vertices.begin(), vertices.end(), in_doubt)) any = adopt_nearest(simplex) || any;
    }
    return any;
  }

  bool is_merged(std::uint32_t simplex) const {
    return cluster_of_[simplex] != kNone && clusters_[root(cluster_of_[simplex])].simplices.size() > 1;
  }

  bool adopt_nearest(std::uint32_t simplex) {
    double best_width = HUGE_VAL;
    std::uint32_t best = kNone;
    for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
      if (!is_merged(neighbour.value)) continue;
      const std::uint32_t host = root(cluster_of_[neighbour.value]);
      const double width =
          std::abs(clusters_[host].plane.dot(point(opposite_vertex(simplex, neighbour.value))) - 1.0);
      if (width >= best_width) continue;
      best_width = width;
      best = host;
    }
    if (best != kNone) adopt(simplex, best);
    return best != kNone;
  }

  /// Moves a simplex that is a facet of its own into `host`.
  void adopt(std::uint32_t simplex, std::uint32_t host) {
    if (cluster_of_[simplex] == kNone) {
      cluster_of_[simplex] = static_cast<std::uint32_t>(clusters_.size());
      const auto vertices = complex_.vertices(SimplexId{simplex});
      clusters_.push_back(
          {cluster_of_[simplex], {simplex}, plane(simplex), {vertices.begin(), vertices.end()}});
      std::sort(clusters_.back().points.begin(), clusters_.back().points.end());
    }
    has_flat_ridge_[simplex] = 1;
    join(cluster_of_[simplex], host);
  }

  /// Is there a facet that `id` adds nothing to? Not asked of many facets, where looking at its neighbours
  /// costs less.
  bool may_have_host(std::uint32_t id) const {
    if (clusters_.size() > clusters_[id].simplices.size() * complex_.rank) return true;
    for (std::uint32_t other = 0; other < clusters_.size(); ++other) {
      if (other != id && clusters_[other].joined == other &&
          added_width(clusters_[id], clusters_[other], tolerance_) < HUGE_VAL)
        return true;
    }
    return false;
  }

  /// The neighbour that `id` adds nothing to, the one in whose plane it lies best; kNone when there is none.
  std::uint32_t best_host(std::uint32_t id) {
    if (!may_have_host(id)) return kNone;
    double best_width = HUGE_VAL;
    std::uint32_t best = kNone;
    tried_by_.resize(clusters_.size(), 0);
    tried_by_[id] = ++stamp_;
    for (const std::uint32_t simplex : clusters_[id].simplices) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
        const std::uint32_t other_cluster = cluster_of_[neighbour.value];
        if (other_cluster == kNone || other_cluster == id) continue;
        const std::uint32_t other = root(other_cluster);
        if (tried_by_[other] == stamp_) continue;
        tried_by_[other] = stamp_;
        const double width = added_width(clusters_[id], clusters_[other], tolerance_);
        if (width >= best_width) continue;
        best_width = width;
        best = other;
      }
    }
    return best;
  }

  /// Largest distance of the points that `from` would add to `into` from its plane; infinite from `most` on.
  double added_width(const Cluster& from, const Cluster& into, double most) const {
    double width = 0.0;
    for (const PointId id : from.points) {
      if (std::binary_search(into.points.begin(), into.points.end(), id)) continue;
      width = std::max(width, std::abs(into.plane.dot(point(id)) - 1.0));
      if (width >= most) return HUGE_VAL;
    }
    return width;
  }

  void join(std::uint32_t id, std::uint32_t host) {
    Cluster& from = clusters_[id];
    Cluster& into = clusters_[host];
    into.simplices.insert(into.simplices.end(), from.simplices.begin(), from.simplices.end());
    std::vector<PointId> all;
    std::set_union(into.points.begin(), into.points.end(), from.points.begin(), from.points.end(),
                   std::back_inserter(all));
    into.points = std::move(all);
    from.simplices.clear();
    from.points.clear();
    from.joined = host;
  }

  /// Numbers the facets of more than one simplex.
  FacetClusters facets() const {
    FacetClusters result;
    result.cluster_of.assign(complex_.row_count, kNone);
    for (const Cluster& cluster : clusters_) {
      if (cluster.simplices.size() < 2) continue;
      for (const std::uint32_t simplex : cluster.simplices) result.cluster_of[simplex] = result.count;
      result.planes.insert(result.planes.end(), cluster.plane.data(), cluster.plane.data() + rank());
      ++result.count;
    }
    return result;
  }

  const SimplicialComplex& complex_;
  const double* points_;
  std::span<const double> determinants_;
  double tolerance_;
  std::vector<std::uint8_t> has_flat_ridge_;
  std::vector<std::uint32_t> cluster_of_;
  std::vector<Cluster> clusters_;
  std::vector<PointLook> looks_;
  std::vector<std::uint32_t> tried_by_;  // per cluster, the stamp of the one that looked at it last
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> neighbours_, simplices_beside_;
};

}  // namespace

FacetClusters merge_coplanar(const SimplicialComplex& complex, const double* points,
                             std::span<const std::uint8_t> is_shifted, std::span<const double> determinants,
                             double tolerance) {
  return Merger(complex, points, determinants, tolerance).run(is_shifted);
}

}  // namespace ndhull
