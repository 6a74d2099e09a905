// Polytopes whose facets, vertices and volume are known: by a formula or from the literature.
#include <cmath>

#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

/// The hull is what `polytope` says; `volume_factor` is what a transform has done to the volume.
Hull expect_known(const NamedPolytope& polytope, const PointSet& points, double volume_factor = 1.0) {
  Hull hull = hull_of(points);
  EXPECT_EQ(hull.status, HullStatus::kComplete);
  EXPECT_EQ(hull.rank, polytope.rank);
  EXPECT_EQ(hull.facet_count(), polytope.facets);
  EXPECT_EQ(hull.vertices.size(), polytope.vertices);
  if (polytope.volume) {
    const double volume = *polytope.volume * volume_factor;
    EXPECT_NEAR(hull.volume, volume, 1e-9 * volume);
  }
  expect_sound(hull, points);
  return hull;
}
Hull expect_known(const NamedPolytope& polytope) { return expect_known(polytope, polytope.points); }

/// Every facet has this many vertices and neighbours.
void expect_facets_alike(const Hull& hull, std::size_t vertices, std::size_t neighbours) {
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    EXPECT_EQ(hull.vertices_of(FacetId{row}).size(), vertices) << "facet " << row;
    EXPECT_EQ(hull.neighbours_of(FacetId{row}).size(), neighbours) << "facet " << row;
  }
}

/// Columns from 1e-8 to 1e8; their product.
std::vector<double> uneven_axes(std::size_t d, double& product) {
  std::vector<double> factors(d);
  product = 1.0;
  for (std::size_t k = 0; k < d; ++k) {
    factors[k] = std::pow(10.0, -8.0 + 16.0 * static_cast<double>(k) / static_cast<double>(d - 1));
    product *= factors[k];
  }
  return factors;
}

double factorial(std::size_t n) { return std::tgamma(static_cast<double>(n) + 1.0); }

TEST(CubeExample, ASideHasTwoDMinusTwoNeighboursAndHalfTheCorners) {
  for (std::size_t d = 2; d <= 8; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    const Hull hull = expect_known(cube(d));
    expect_facets_alike(hull, std::size_t{1} << (d - 1), 2 * d - 2);
    // The cube of side 2 has 2 d sides of (d-1)-volume 2^(d-1).
    EXPECT_NEAR(hull.area, static_cast<double>(2 * d) * std::pow(2.0, d - 1), 1e-9 * hull.area);
  }
}

TEST(CubeExample, NineDimensions) { expect_facets_alike(expect_known(cube(9)), 256, 16); }

TEST(CubeMetamorphic, RotatedMovedAndStretchedCubesAreCubes) {
  for (std::size_t d = 2; d <= 8; ++d) {
    const NamedPolytope known = cube(d);
    SCOPED_TRACE("d " + std::to_string(d));
    for (std::uint64_t seed = 1; seed <= (d <= 6 ? 3U : 1U); ++seed) {
      SCOPED_TRACE("rotated with seed " + std::to_string(seed));
      const Hull hull = expect_known(known, rotated(known.points, seed));
      expect_facets_alike(hull, std::size_t{1} << (d - 1), 2 * d - 2);
    }
    SCOPED_TRACE("moved, stretched");
    expect_known(known, moved(known.points, std::vector<double>(d, 1e6)));
    double product = 1.0;
    const std::vector<double> factors = uneven_axes(d, product);
    expect_known(known, axis_scaled(known.points, factors), product);
  }
}

TEST(CubeMetamorphic, RotatedCubesFarFromTheOriginAreCubes) {
  for (std::size_t d = 2; d <= 7; ++d) {
    const NamedPolytope known = cube(d);
    const PointSet points = moved(rotated(known.points, 5), std::vector<double>(d, 1e6));
    const Hull hull = hull_of(points);
    SCOPED_TRACE("d " + std::to_string(d) + ", rotated with seed 5, moved by 1e6");
    // Moving rounds the corners to 1e-10, so the facets differ from a cube's; what was given is still
    // bounded.
    EXPECT_EQ(hull.vertices.size(), known.vertices);
    EXPECT_NEAR(hull.volume, *known.volume, 1e-8 * *known.volume);
    expect_sound(hull, points);
  }
}

TEST(CrossPolytopeExample, EveryChoiceOfSignsIsAFacet) {
  for (std::size_t d = 2; d <= 12; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    const Hull hull = expect_known(cross_polytope(d));
    expect_facets_alike(hull, d, d);
    EXPECT_NEAR(hull.volume, std::pow(2.0, d) / factorial(d), 1e-9 * hull.volume);
  }
}

TEST(CrossPolytopeMetamorphic, RotationMovesNoFacet) {
  for (std::size_t d = 2; d <= 10; ++d) {
    const NamedPolytope known = cross_polytope(d);
    SCOPED_TRACE("d " + std::to_string(d) + ", seed 3");
    expect_known(known, rotated(known.points, 3));
  }
}

TEST(SimplexExample, FacetsArePairwiseNeighbours) {
  for (std::size_t d = 1; d <= 12; ++d) {
    SCOPED_TRACE("d " + std::to_string(d));
    const Hull hull = expect_known(simplex(d));
    if (d > 1) expect_facets_alike(hull, d, d);
  }
}

TEST(RegularPolytopesExample, OfFourDimensions) {
  // Octahedra have 6 vertices and 8 sides, dodecahedra 20 and 12.
  expect_facets_alike(expect_known(cell_24()), 6, 8);
  expect_facets_alike(expect_known(cell_600()), 4, 4);
  expect_facets_alike(expect_known(cell_120()), 20, 12);
}

TEST(RegularPolytopesMetamorphic, RotatedOnesHaveTheSameFacets) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const NamedPolytope& known : {cell_24(), cell_600(), cell_120()}) {
      SCOPED_TRACE(known.name);
      expect_known(known, rotated(known.points, seed));
    }
  }
}

TEST(PermutahedronExample, FacetsAreTheProperSubsets) {
  for (std::size_t n = 2; n <= 7; ++n) {
    SCOPED_TRACE("n " + std::to_string(n));
    const NamedPolytope known = permutahedron(n);
    EXPECT_EQ(known.facets, (std::uint64_t{1} << n) - 2);
    const Hull hull = expect_known(known);
    for (std::uint32_t row = 0; row < hull.facet_count() && n > 2; ++row) {
      // A facet is a product of permutahedra of k and n-k things.
      const double vertices = static_cast<double>(hull.vertices_of(FacetId{row}).size());
      bool known_product = false;
      for (std::size_t k = 1; k < n; ++k)
        known_product |= vertices == std::round(factorial(k) * factorial(n - k));
      EXPECT_TRUE(known_product) << "facet " << row << " has " << vertices << " vertices";
    }
  }
}

// A round of repair must not leave simplices that overlap: facets were right, the volume 2e-6 too large.
TEST(PermutahedronRegression, RepairedHullsHaveTheRightVolume) {
  const NamedPolytope known = permutahedron(7);
  for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{49}}) {
    HullOptions options;
    options.seed = seed;
    const Hull hull = hull_of(known.points, options);
    EXPECT_EQ(hull.facet_count(), known.facets) << "seed " << seed;
    EXPECT_NEAR(hull.volume, *known.volume, 1e-9 * *known.volume) << "seed " << seed;
  }
}

TEST(BirkhoffExample, FacetsAreTheEntriesOfTheMatrix) {
  for (std::size_t n = 2; n <= 4; ++n) {
    SCOPED_TRACE("n " + std::to_string(n));
    const Hull hull = expect_known(birkhoff(n));
    EXPECT_EQ(hull.rank, (n - 1) * (n - 1));
    // x_ij = 0 leaves n! - (n-1)! permutations.
    if (n == 4) expect_facets_alike(hull, 18, 15);
  }
}

TEST(CyclicPolytopeExample, ReachesTheUpperBound) {
  const struct {
    std::size_t n, d;
    std::uint64_t facets;
  } cases[] = {{30, 6, 3250}, {30, 8, 17250}, {25, 12, 35700}};
  for (const auto& known : cases) {
    SCOPED_TRACE("n " + std::to_string(known.n) + ", d " + std::to_string(known.d));
    const Hull hull = expect_known(cyclic_trigonometric(known.n, known.d));
    EXPECT_EQ(hull.facet_count(), known.facets);
    expect_facets_alike(hull, known.d, known.d);
  }
  for (std::size_t d = 3; d <= 6; ++d) {
    SCOPED_TRACE("moment curve, n 16, d " + std::to_string(d));
    expect_known(moment_curve(16, d));
  }
}

TEST(GridExample, OnlyTheCornersAreVertices) {
  for (const NamedPolytope& known : {grid(4, 5), grid(3, 6), grid(3, 7)}) {
    SCOPED_TRACE(known.name);
    const std::size_t d = known.rank;
    expect_facets_alike(expect_known(known), std::size_t{1} << (d - 1), 2 * d - 2);
  }
}

TEST(GridMetamorphic, RotatedGridsHaveTheSameFacetsAndCorners) {
  for (const NamedPolytope& known : {grid(4, 5), grid(3, 6), grid(3, 7)}) {
    SCOPED_TRACE(known.name + ", seed 11");
    const std::size_t d = known.rank;
    const Hull hull = expect_known(known, rotated(known.points, 11));
    expect_facets_alike(hull, std::size_t{1} << (d - 1), 2 * d - 2);
  }
}

TEST(CombinatorialPolytopesExample, CutsAndLinearOrders) {
  const NamedPolytope cut5 = cut_polytope(5), cut6 = cut_polytope(6), orders = linear_ordering(5);
  EXPECT_EQ(cut5.facets, 56U);
  EXPECT_EQ(cut6.facets, 368U);
  EXPECT_EQ(orders.facets, 40U);
  for (const NamedPolytope& known : {cut5, cut6, orders}) {
    SCOPED_TRACE(known.name);
    expect_known(known);
  }
}

TEST(ProductOfSimplicesExample, HasAPlusBPlusTwoFacets) {
  for (std::size_t a = 1; a <= 5; ++a) {
    for (std::size_t b = a; b <= 5; ++b) {
      SCOPED_TRACE("a " + std::to_string(a) + ", b " + std::to_string(b));
      const NamedPolytope known = product_of_simplices(a, b);
      const Hull hull = expect_known(known);
      EXPECT_EQ(hull.facet_count(), a + b + 2);
      EXPECT_EQ(hull.vertices.size(), (a + 1) * (b + 1));
      expect_known(known, rotated(known.points, a * 10 + b));
    }
  }
}

TEST(PolytopesLaw, TheFacetsVertexSetsFormAPolytopesLattice) {
  for (const NamedPolytope& known :
       {cube(3), cube(4), cube(5), cell_24(), permutahedron(4), permutahedron(5), birkhoff(3), grid(3, 3),
        cyclic_trigonometric(8, 4), product_of_simplices(2, 3), cut_polytope(4), cross_polytope(5)}) {
    SCOPED_TRACE(known.name);
    const Hull hull = hull_of(known.points);
    const std::vector<std::uint64_t> faces = lattice_face_numbers(facet_sets(hull), hull.rank);
    expect_euler(faces);
    EXPECT_EQ(faces.front(), known.vertices);
    EXPECT_EQ(faces.back(), known.facets);
    // A ridge is what two neighbours share.
    std::uint64_t pairs = 0;
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row)
      pairs += hull.neighbours_of(FacetId{row}).size();
    EXPECT_EQ(pairs, 2 * faces[faces.size() - 2]);
  }
}

}  // namespace
}  // namespace ndhull
