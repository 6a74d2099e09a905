// Which planes clusters have, while rows move under them.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "approx/facets/exact_facets.h"
#include "approx/facets/facet_layout.h"
#include "approx/slabs/dual_facets.h"
#include "approx/slabs/slab_partition.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

/// Clusters of a sphere's thin slabs, and what the slabs said of them.
struct Clustered {
  explicit Clustered(double width) : sphere("120 s D7 t3", 120) {
    SimplicialComplex& complex = sphere.work.complex;
    std::vector<double> factor(complex.rank * complex.rank, 0.0), determinants(complex.row_count);
    for (std::size_t k = 0; k < complex.rank; ++k) factor[k * complex.rank + k] = 1.0;
    solve_outwards(complex, sphere.coordinates.data(), {}, determinants);
    PartitionTask task;
    std::optional<DualFacets> facets = partition_into_slabs(
        complex, *sphere.space, sphere.coordinates.data(), factor, PointsAbove(), width,
        [&](const BlockWork& also) {
          also(0, complex.row_count);
          return std::span<const double>(determinants);
        },
        task);
    facet_of = facets->facet_of_rows();
    for (std::size_t facet = 0; facet < facets->count(); ++facet)
      planes.emplace_back(facets->plane(facet).begin(), facets->plane(facet).end());
    clusters = clusters_of(std::move(*facets));
  }
  std::vector<double> plane_of(std::uint32_t cluster) const {
    const double* const plane = clusters.plane_of(sphere.work.complex, cluster);
    return {plane, plane + sphere.work.rank};
  }
  std::vector<std::vector<double>> planes_of_all() const {
    std::vector<std::vector<double>> all;
    for (std::uint32_t cluster = 0; cluster < clusters.count; ++cluster) all.push_back(plane_of(cluster));
    return all;
  }

  GrownSphere sphere;
  std::vector<std::uint32_t> facet_of;
  std::vector<std::vector<double>> planes;  // of the facets
  FacetClusters clusters;
};

TEST(FacetClusters, AreTheFacetsOfSeveralSimplicesAndThoseWithOwnPlanes) {
  for (const double width : {0.01, 0.05}) {
    Clustered found(width);
    const std::vector<std::uint32_t> listed = found.clusters.begin;
    ASSERT_EQ(listed.size(), found.clusters.count + 1);
    found.clusters.number_rows(found.facet_of.size());
    std::map<std::uint32_t, std::uint32_t> cluster_of_facet, size;
    for (const std::uint32_t facet : found.facet_of)
      if (facet != kNone) ++size[facet];
    for (std::uint32_t row = 0; row < found.facet_of.size(); ++row) {
      const std::uint32_t facet = found.facet_of[row], cluster = found.clusters.cluster_of[row];
      EXPECT_EQ(facet != kNone && size[facet] > 1, cluster != kNone);
      if (cluster == kNone) continue;
      EXPECT_EQ(cluster_of_facet.emplace(facet, cluster).first->second, cluster);
      EXPECT_EQ(listed[cluster + 1] - listed[cluster], size[facet]);
      EXPECT_EQ(found.plane_of(cluster), found.planes[facet]);
    }
    EXPECT_EQ(cluster_of_facet.size(), found.clusters.count);
    EXPECT_GT(found.clusters.planes.size(), 0u);  // planes between two simplices'
    EXPECT_LT(found.clusters.planes.size(), found.clusters.count * found.sphere.work.rank);
  }
}

TEST(FacetClusters, KeepTheirPlanesAndSimplicesWhenRowsMove) {
  Clustered listed(0.01), numbered(0.01);
  numbered.clusters.number_rows(numbered.sphere.work.complex.row_count);
  std::vector<std::uint32_t> cluster_of = numbered.clusters.cluster_of;
  const std::vector<std::vector<double>> before = listed.planes_of_all();
  for (Clustered* const found : {&listed, &numbered}) {
    SimplicialComplex& complex = found->sphere.work.complex;
    const std::vector<RowMove> moves = compact(complex);
    ASSERT_FALSE(moves.empty());
    found->clusters.move_rows(moves, complex.row_count);
    EXPECT_EQ(found->planes_of_all(), before);
    std::size_t moved_seeds = 0;
    for (const std::uint32_t seed : found->clusters.seeds)
      for (const RowMove& move : moves) moved_seeds += seed == move.to ? 1u : 0u;
    EXPECT_GT(moved_seeds, 0u);
    if (found == &listed) {
      EXPECT_EQ(listed.clusters.simplices.size(), complex.row_count);
      listed.clusters.number_rows(complex.row_count);
      for (const RowMove& move : moves) cluster_of[move.to] = cluster_of[move.from];
      cluster_of.resize(complex.row_count);
    }
    EXPECT_EQ(found->clusters.cluster_of, cluster_of);
  }
}

/// Where no row moves, 0.05, and where rows do.
TEST(FacetClusters, AreLaidOutAsTheSameFacetsWhetherListedOrNumbered) {
  using Facet = std::pair<std::set<std::uint32_t>, std::vector<double>>;
  for (const double width : {0.0002, 0.05}) {
    std::vector<std::set<Facet>> laid_out;
    for (const bool is_listed : {true, false}) {
      Clustered found(width);
      SimplicialComplex& complex = found.sphere.work.complex;
      const std::vector<RowMove> moves = compact(complex);
      found.clusters.move_rows(moves, complex.row_count);
      if (!is_listed) found.clusters.number_rows(complex.row_count);
      std::vector<double> determinants(complex.row_count, 1.0), factor(complex.rank * complex.rank, 0.0);
      ASSERT_GT(found.clusters.count, 0u);
      FacetLayout layout = lay_out(complex, determinants, found.clusters, factor);
      layout.number_simplices();
      EXPECT_EQ(layout.planes.data() != nullptr, width == 0.05);
      laid_out.emplace_back();
      for (std::uint32_t facet = 0; facet < layout.facets; ++facet) {
        const std::span<const SimplexId> simplices = layout.simplices_of(FacetId{facet});
        EXPECT_EQ(simplices.size() == 1, facet < layout.simplicial);
        Facet next;
        for (const SimplexId simplex : simplices) {
          EXPECT_EQ(layout.facet_of(simplex), FacetId{facet});
          std::set<std::uint32_t> vertices;
          for (const PointId id : complex.vertices(simplex)) vertices.insert(id.value);
          EXPECT_EQ(vertices.size(), complex.rank);
          next.first.merge(vertices);
        }
        const double* const plane = layout.plane_of(complex, FacetId{facet});
        next.second.assign(plane, plane + complex.rank);
        laid_out.back().insert(std::move(next));
      }
      EXPECT_EQ(laid_out.back().size(), layout.facets);
    }
    EXPECT_TRUE(laid_out[0] == laid_out[1]) << width;
  }
}

TEST(FacetClusters, KeepTheirPlanesWhenSimplicesAreSolvedAgain) {
  Clustered found(0.01);
  SimplicialComplex& complex = found.sphere.work.complex;
  const std::vector<std::vector<double>> before = found.planes_of_all();
  found.clusters.keep_planes(complex);
  for (std::size_t i = 0; i < complex.row_count * complex.rank; ++i) complex.planes[i] *= 1.001;
  EXPECT_EQ(found.planes_of_all(), before);
}

}  // namespace
}  // namespace ndhull
