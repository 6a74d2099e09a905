#include "approx/facets/sliver_merge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace ndhull {
namespace {

class SliverMerger {
 public:
  SliverMerger(const SimplicialComplex& complex, const double* points, double tolerance,
               std::vector<FlatCluster>& clusters, std::vector<std::uint32_t>& cluster_of, const WorkEnd& end)
      : complex_(complex),
        points_(points),
        tolerance_(tolerance),
        clusters_(clusters),
        cluster_of_(cluster_of),
        end_(end),
        joined_(clusters.size()),
        looks_(clusters.size()) {
    std::iota(joined_.begin(), joined_.end(), 0u);
  }

  // Smallest facets first, again until none is left: a sliver's neighbours may be slivers that join a flat
  // only later.
  bool run() {
    for (bool changed = true; changed;) {
      if (end_.is_here()) return false;
      changed = adopt_enclosed() || adopt_pinned();
      for (auto id = static_cast<std::uint32_t>(clusters_.size()); id-- > 0;) {
        if (joined_[id] != id) continue;
        if (id % kBetweenClocks == 0 && end_.is_here()) return false;
        const std::uint32_t best = best_host(id);
        if (best == kNone) continue;
        join(id, best);
        changed = true;
      }
      if (!changed) changed = join_pockets();
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = FacetId::kNone;
  static constexpr std::uint32_t kBetweenClocks = 64;

  /// What a facet's last search for a host saw, by a clock that joins and searches advance.
  struct Look {
    std::uint64_t grown_at = 0;
    std::uint64_t looked_at = 0;  // 0: not yet, or a host was found
    bool is_beside_simplices = false;
    std::vector<std::uint32_t> beside;
  };

  Eigen::Map<const Eigen::VectorXd> plane(std::uint32_t simplex) const {
    return {complex_.plane(SimplexId{simplex}).data(), rank()};
  }
  Eigen::Map<const Eigen::VectorXd> point(PointId id) const {
    return {points_ + std::size_t{id.value} * complex_.rank, rank()};
  }
  Eigen::Index rank() const { return static_cast<Eigen::Index>(complex_.rank); }

  PointId opposite_vertex(std::uint32_t neighbour, std::uint32_t simplex) const {
    return vertex_opposite(complex_, neighbour, simplex);
  }

  std::uint32_t root(std::uint32_t cluster) {
    while (joined_[cluster] != cluster) cluster = joined_[cluster] = joined_[joined_[cluster]];
    return cluster;
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
    for (const FlatCluster& cluster : clusters_) {
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
    for (const FlatCluster& cluster : clusters_) {
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

  bool is_merged(std::uint32_t simplex) {
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
      clusters_.push_back({{simplex}, plane(simplex), {vertices.begin(), vertices.end()}});
      std::sort(clusters_.back().points.begin(), clusters_.back().points.end());
      joined_.push_back(cluster_of_[simplex]);
      looks_.emplace_back();
    }
    adopted_at_ = ++clock_;
    join(cluster_of_[simplex], host);
  }

  /// Is there a facet that `id` adds nothing to? Not asked of many facets, where looking at its neighbours
  /// costs less.
  bool may_have_host(std::uint32_t id) const {
    if (clusters_.size() > clusters_[id].simplices.size() * complex_.rank) return true;
    for (std::uint32_t other = 0; other < clusters_.size(); ++other) {
      if (other != id && joined_[other] == other &&
          added_width(clusters_[id], clusters_[other], tolerance_) < HUGE_VAL)
        return true;
    }
    return false;
  }

  /// The neighbour that `id` adds nothing to, the one in whose plane it lies best; kNone when there is none.
  std::uint32_t best_host(std::uint32_t id) {
    if (is_as_before(id)) return kNone;
    looks_[id].looked_at = 0;
    if (!may_have_host(id)) return kNone;
    double best_width = HUGE_VAL;
    std::uint32_t best = kNone;
    beside_.clear();
    bool is_beside_simplices = false;
    tried_by_.resize(clusters_.size(), 0);
    tried_by_[id] = ++stamp_;
    for (const std::uint32_t simplex : clusters_[id].simplices) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex})) {
        const std::uint32_t other_cluster = cluster_of_[neighbour.value];
        is_beside_simplices |= other_cluster == kNone;
        if (other_cluster == kNone || tried_by_[other_cluster] == stamp_) continue;
        tried_by_[other_cluster] = stamp_;
        const std::uint32_t other = root(other_cluster);
        if (other != other_cluster && tried_by_[other] == stamp_) continue;
        tried_by_[other] = stamp_;
        beside_.push_back(other);
        const double width = added_width(clusters_[id], clusters_[other], tolerance_);
        if (width >= best_width) continue;
        best_width = width;
        best = other;
      }
    }
    if (best == kNone) looks_[id] = {looks_[id].grown_at, ++clock_, is_beside_simplices, beside_};
    return best;
  }

  /// Did the last look find no host, and is all that it saw as it was? Neighbours have no other planes then,
  /// nor other points.
  bool is_as_before(std::uint32_t id) const {
    const Look& look = looks_[id];
    const std::uint64_t at = look.looked_at;
    if (at == 0 || look.grown_at > at || (look.is_beside_simplices && adopted_at_ > at)) return false;
    return std::all_of(look.beside.begin(), look.beside.end(), [&](std::uint32_t other) {
      return joined_[other] == other && looks_[other].grown_at <= at;
    });
  }

  /// Largest distance of the points that `from` would add to `into` from its plane; infinite from `most` on.
  double added_width(const FlatCluster& from, const FlatCluster& into, double most) const {
    double width = 0.0;
    for (const PointId id : from.points) {
      if (std::binary_search(into.points.begin(), into.points.end(), id)) continue;
      width = std::max(width, std::abs(into.plane.dot(point(id)) - 1.0));
      if (width >= most) return HUGE_VAL;
    }
    return width;
  }

  void join(std::uint32_t id, std::uint32_t host) {
    FlatCluster& from = clusters_[id];
    FlatCluster& into = clusters_[host];
    into.simplices.insert(into.simplices.end(), from.simplices.begin(), from.simplices.end());
    std::vector<PointId> all;
    std::set_union(into.points.begin(), into.points.end(), from.points.begin(), from.points.end(),
                   std::back_inserter(all));
    into.points = std::move(all);
    from.simplices.clear();
    from.points.clear();
    joined_[id] = host;
    looks_[host].grown_at = ++clock_;
  }

  const SimplicialComplex& complex_;
  const double* points_;
  double tolerance_;
  std::vector<FlatCluster>& clusters_;
  std::vector<std::uint32_t>& cluster_of_;
  const WorkEnd& end_;
  std::vector<std::uint32_t> joined_;  // of each facet: the one that has taken it in, or itself
  std::vector<Look> looks_;
  std::vector<std::uint32_t> tried_by_;  // per cluster, the stamp of the one that looked at it last
  std::uint32_t stamp_ = 0;
  std::uint64_t clock_ = 0, adopted_at_ = 0;
  std::vector<std::uint32_t> neighbours_, simplices_beside_, beside_;
};

}  // namespace

bool absorb_slivers(const SimplicialComplex& complex, const double* points, double tolerance,
                    std::vector<FlatCluster>& clusters, std::vector<std::uint32_t>& cluster_of,
                    const WorkEnd& end) {
  return SliverMerger(complex, points, tolerance, clusters, cluster_of, end).run();
}

}  // namespace ndhull
