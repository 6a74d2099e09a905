#include "approx/facets/coplanar_merge.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "approx/facets/flat_facets.h"
#include "approx/facets/flat_plane.h"
#include "approx/facets/sliver_merge.h"
#include "core/machine/blocks.h"
#include "core/search/plane_kernels.h"

namespace ndhull {
namespace {

using Vector = Eigen::VectorXd;
using ConstRow = Eigen::Map<const Vector>;

class Merger {
 public:
  Merger(const SimplicialComplex& complex, const double* points, std::span<const double> determinants,
         double tolerance, const WorkEnd& end)
      : complex_(complex), points_(points), determinants_(determinants), tolerance_(tolerance), end_(end) {}

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
    bool is_complete = true;
    if (!clusters_.empty()) {
      is_complete = absorb_slivers(complex_, points_, tolerance_, clusters_, cluster_of_, end_);
    }
    FacetClusters result = facets();
    result.is_cut_short = !is_complete;
    return result;
  }

 private:
  static constexpr std::uint32_t kNone = FacetId::kNone;

  ConstRow plane(std::uint32_t simplex) const { return {complex_.plane(SimplexId{simplex}).data(), rank()}; }
  ConstRow point(PointId id) const { return {points_ + std::size_t{id.value} * complex_.rank, rank()}; }
  Eigen::Index rank() const { return static_cast<Eigen::Index>(complex_.rank); }

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
      clusters_.push_back({std::move(flat.simplices), plane(flat.seed), std::move(flat.points)});
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
    FlatCluster cluster{{seed}, plane(seed), {}};
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
        const PointId opposite = vertex_opposite(complex_, neighbour.value, simplex);
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

  void fit_plane(FlatCluster& cluster) {
    fit_flat_plane(points_, complex_.rank, cluster.points, cluster.plane.data());
  }

  /// Numbers the facets of more than one simplex.
  FacetClusters facets() const {
    FacetClusters result;
    result.cluster_of.assign(complex_.row_count, kNone);
    for (const FlatCluster& cluster : clusters_) {
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
  const WorkEnd& end_;
  std::vector<std::uint8_t> has_flat_ridge_;
  std::vector<std::uint32_t> cluster_of_;
  std::vector<FlatCluster> clusters_;
  std::vector<PointLook> looks_;
  std::uint32_t stamp_ = 0;
};

}  // namespace

FacetClusters merge_coplanar(const SimplicialComplex& complex, const double* points,
                             std::span<const std::uint8_t> is_shifted, std::span<const double> determinants,
                             double tolerance, const WorkEnd& end) {
  return Merger(complex, points, determinants, tolerance, end).run(is_shifted);
}

}  // namespace ndhull
