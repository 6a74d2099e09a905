// What facets of several simplices are told of their vertices, row by row with one thread and facet by facet
// with two, beside a plain look at each simplex.
#include "approx/facets/listed_facets.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

#include "approx/facets/exact_facets.h"
#include "approx/slabs/dual_facets.h"
#include "approx/slabs/seed_classes.h"
#include "approx/slabs/slab_partition.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

struct Listed {
  std::vector<double> low, high;
  std::vector<std::uint32_t> close;
  bool operator==(const Listed&) const = default;
};

/// A sphere's slabs as a layout in which no row has moved.
struct LaidOut {
  LaidOut() : sphere("150 s D6 t1", 150) {
    SimplicialComplex& complex = sphere.work.complex;
    compact(complex);
    const std::size_t rank = complex.rank;
    determinants.resize(complex.row_count);
    solve_outwards(complex, sphere.coordinates.data(), {}, determinants);
    std::vector<double> factor(rank * rank, 0.0);
    for (std::size_t k = 0; k < rank; ++k) factor[k * rank + k] = 1.0;
    PartitionTask task;
    std::optional<DualFacets> facets =
        partition_into_slabs(complex, *sphere.space, sphere.coordinates.data(), factor, PointsAbove(), 0.15,
                             FindDeterminants(), task);
    FacetClusters clusters = clusters_of(std::move(*facets));
    layout = lay_out(complex, determinants, clusters, factor);
    points.dimension = rank;
    points.rows.assign(sphere.coordinates.begin(), sphere.coordinates.end() - 8);
    points.row_of_point.resize(sphere.work.point_count);
    // Rows in another order than the points.
    std::iota(points.row_of_point.rbegin(), points.row_of_point.rend(), 0u);
    for (std::size_t id = 0; id < points.row_of_point.size(); ++id)
      std::copy_n(sphere.coordinates.data() + id * rank, rank,
                  points.rows.data() + points.row_of_point[id] * rank);
  }

  Listed list(int threads) {
    Listed found;
    found.low.resize(layout.facets);
    found.high.resize(layout.facets);
    found.close.resize(layout.facets);
    tbb::task_arena arena(threads);
    arena.execute([&] {
      find_own_dots(sphere.work.complex, layout, nullptr, points, layout.planes.data(),
                    {found.low, found.high, found.close});
    });
    return found;
  }

  GrownSphere sphere;
  std::vector<double> determinants;
  FacetLayout layout;
  CertificatePoints points;
};

TEST(ListedFacets, AreTheSameBitsRowByRow) {
  LaidOut made;
  ASSERT_NE(made.layout.planes.data(), nullptr);
  ASSERT_LT(8 * made.layout.facets, made.sphere.work.complex.row_count);
  EXPECT_TRUE(made.list(1) == made.list(2));
}

TEST(ListedFacets, ProductsAreThoseOfTheirSimplices) {
  LaidOut made;
  const Listed found = made.list(1);
  const std::size_t rank = made.layout.planes.data() != nullptr ? made.sphere.work.complex.rank : 0;
  for (std::uint32_t facet = 0; facet < made.layout.facets; ++facet) {
    const double* const plane = made.layout.planes.data() + facet * rank;
    double low = HUGE_VAL, high = -HUGE_VAL;
    std::set<std::uint32_t> vertices;
    for (const SimplexId simplex : made.layout.simplices_of(FacetId{facet}))
      for (const PointId id : made.sphere.work.complex.vertices(simplex)) vertices.insert(id.value);
    std::uint32_t close = 0;
    std::vector<double> products;
    for (const std::uint32_t id : vertices) {
      products.push_back(
          std::inner_product(plane, plane + rank, made.sphere.coordinates.data() + id * rank, 0.0));
      low = std::min(low, products.back());
      high = std::max(high, products.back());
    }
    for (const double product : products) close += product > high - 1e-9 ? 1u : 0u;
    EXPECT_NEAR(found.low[facet], low, 1e-13);
    EXPECT_NEAR(found.high[facet], high, 1e-13);
    EXPECT_EQ(found.close[facet], close);
  }
}

TEST(SeedClasses, TheNearestPlanesComeFirstEachRowOnce) {
  const GrownSphere sphere("200 s D4 t1", 200);
  const SimplicialComplex& complex = sphere.work.complex;
  const auto length_sq_of = [&](std::size_t row) {
    const double* const plane = complex.planes.data() + row * complex.rank;
    return std::inner_product(plane, plane + complex.rank, plane, 0.0);
  };
  SeedClasses classes(complex, length_sq_of);
  double longest = 0.0, shortest = HUGE_VAL;
  std::set<std::uint32_t> live;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    classes.put(row, length_sq_of(row));
    if (!sphere.is_live(row)) continue;
    live.insert(row);
    longest = std::max(longest, length_sq_of(row));
    shortest = std::min(shortest, length_sq_of(row));
  }
  const std::vector<std::uint32_t> sorted = classes.sorted(live.size());
  EXPECT_EQ(std::set<std::uint32_t>(sorted.begin(), sorted.end()), live);
  // A class is a 64th of the range of exponents and first bits, which are at most 6 % from a logarithm.
  const double step = std::pow(longest / shortest, 1.0 / 64.0) * 1.13;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    EXPECT_LE(length_sq_of(sorted[i]), step * length_sq_of(sorted[i - 1]));
}

}  // namespace
}  // namespace ndhull
