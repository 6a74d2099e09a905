// Laws that hold for every input, over families, named polytopes and degenerate sets, in all dimensions.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

/// About so many points in d dimensions give thousands of facets, not millions.
std::size_t modest_count(std::size_t d) {
  return d <= 4 ? 200 : d == 5 ? 120 : d == 6 ? 60 : d == 7 ? 35 : 20;
}

std::vector<DegenerateCase> family_cases(std::size_t d, std::uint64_t seed) {
  std::vector<DegenerateCase> cases;
  for (const PointFamily family : all_point_families()) {
    const std::size_t n = modest_count(d);
    const std::size_t lattice = static_cast<std::size_t>(std::pow(3.0, static_cast<double>(d)));
    GenerateOptions options{.family = family, .dimension = d, .count = n, .seed = seed};
    if (family == PointFamily::kLattice) options.count = std::min(n, lattice);
    std::string description = std::string(to_string(family)) + ", n " + std::to_string(options.count) +
                              ", d " + std::to_string(d) + ", seed " + std::to_string(seed);
    cases.push_back({std::move(description), generate_points(options)});
  }
  return cases;
}

/// Everything of the hull's laws for one input.
void expect_laws(const DegenerateCase& input) {
  SCOPED_TRACE(input.description);
  const Hull hull = hull_of(input.points);
  EXPECT_EQ(hull.status, HullStatus::kComplete);
  expect_sound(hull, input.points);
  EXPECT_LE(hull.max_facet_width, 1e-11 * extent_of(input.points));
  EXPECT_LE(hull.max_outside_gauge, 1e-11);
  if (hull.rank >= 2) expect_euler(face_numbers(hull.simplices()));
}

TEST(HullLaw, HoldsForEveryFamily) {
  for (std::size_t d = 2; d <= 8; ++d) {
    for (const DegenerateCase& input : family_cases(d, 20240601)) expect_laws(input);
  }
}

TEST(HullLaw, HoldsForDegenerateInputs) {
  for (std::size_t d = 2; d <= 7; ++d) {
    for (std::uint64_t seed = 1; seed <= (d <= 5 ? 4U : 2U); ++seed) {
      for (const DegenerateCase& input : degenerate_cases(modest_count(d), d, seed)) expect_laws(input);
    }
  }
}

TEST(HullLaw, HoldsForFewPoints) {
  for (std::size_t d = 2; d <= 6; ++d) {
    for (std::size_t n = 2; n <= d + 4; ++n) {
      for (const DegenerateCase& input : degenerate_cases(n, d, 100 * d + n)) expect_laws(input);
    }
  }
}

TEST(HullLaw, HoldsForDegenerateInputsScaledFarAwayAndTurned) {
  for (std::size_t d = 3; d <= 6; ++d) {
    for (const DegenerateCase& input : degenerate_cases(modest_count(d) / 2, d, 31)) {
      expect_laws({input.description + ", rotated with 8", rotated(input.points, 8)});
      const std::vector<double> small(d, 1e-30);
      expect_laws({input.description + ", times 1e-30", axis_scaled(input.points, small)});
      const std::vector<double> large(d, 1e+30);
      expect_laws({input.description + ", times 1e30", axis_scaled(input.points, large)});
    }
  }
}

// h_k = h_(d-k) for the boundary of a simplicial polytope; h from f by McMullen's sums.
TEST(HullLaw, DehnSommervilleHoldsForTheSimplices) {
  for (std::size_t d = 2; d <= 8; ++d) {
    std::vector<DegenerateCase> inputs = family_cases(d, 5);
    if (d <= 6) {
      for (DegenerateCase& input : degenerate_cases(modest_count(d) / 2, d, 5))
        inputs.push_back(std::move(input));
    }
    for (const DegenerateCase& input : inputs) {
      const Hull hull = hull_of(input.points);
      if (hull.rank < 2) continue;
      SCOPED_TRACE(input.description);
      const std::vector<std::uint64_t> faces = face_numbers(hull.simplices());
      const std::size_t r = hull.rank;
      std::vector<std::int64_t> h(r + 1, 0);
      for (std::size_t k = 0; k <= r; ++k) {
        for (std::size_t i = 0; i <= k; ++i) {
          double choose = 1.0;  // r - i over k - i
          for (std::size_t j = 0; j < k - i; ++j)
            choose = choose * static_cast<double>(r - i - j) / static_cast<double>(j + 1);
          const std::int64_t f = i == 0 ? 1 : static_cast<std::int64_t>(faces[i - 1]);
          h[k] += ((k - i) % 2 == 0 ? 1 : -1) * std::llround(choose) * f;
        }
      }
      for (std::size_t k = 0; k <= r; ++k) EXPECT_EQ(h[k], h[r - k]) << "k " << k;
      // Each is at least 1, or the numbers are no polytope's.
      EXPECT_GE(*std::min_element(h.begin(), h.end()), 1);
    }
  }
}

TEST(HullLaw, TriangulatedFacetsAreTheSimplices) {
  for (std::size_t d = 2; d <= 6; ++d) {
    for (const DegenerateCase& input : degenerate_cases(modest_count(d) / 2, d, 17)) {
      SCOPED_TRACE(input.description);
      const Hull merged = hull_of(input.points);
      const Hull split = hull_of(input.points, {.triangulate = true});
      EXPECT_EQ(split.facet_count(), split.simplices().row_count);
      EXPECT_EQ(split.facet_count(), split.simplicial_facet_count());
      EXPECT_GE(split.facet_count(), merged.facet_count());
      EXPECT_LE(largest_outer_excess(split, input.points.view()), 0.0L);
      EXPECT_LE(largest_inner_excess(split, input.points.view()), 0.0L);
      EXPECT_NEAR(split.volume, merged.volume, 1e-9 * merged.volume);
    }
  }
}

TEST(HullMetamorphic, HullOfTheVerticesHasTheSameFacets) {
  for (std::size_t d = 2; d <= 7; ++d) {
    for (const PointFamily family : {PointFamily::kBall, PointFamily::kGaussian, PointFamily::kClusters}) {
      SCOPED_TRACE(std::string(to_string(family)) + ", d " + std::to_string(d) + ", seed 3");
      const PointSet set = family_points(family, 2 * modest_count(d), d, 3);
      const Hull hull = hull_of(set);
      std::vector<std::size_t> old_of_new;
      for (const PointId vertex : hull.vertices) old_of_new.push_back(vertex.value);
      EXPECT_EQ(renamed(facet_sets(hull_of(vertex_rows(set, hull))), old_of_new), facet_sets(hull));
    }
  }
  for (const NamedPolytope& known : {grid(3, 4), grid(4, 3), grid(3, 5), cell_24()}) {
    SCOPED_TRACE(known.name);
    const Hull hull = hull_of(known.points);
    const Hull again = hull_of(vertex_rows(known.points, hull));
    EXPECT_EQ(again.facet_count(), hull.facet_count());
    EXPECT_EQ(again.vertices.size(), hull.vertices.size());
    EXPECT_NEAR(again.volume, hull.volume, 1e-12 * hull.volume);
  }
}

TEST(HullMetamorphic, InteriorPointsChangeNothing) {
  for (std::size_t d = 2; d <= 7; ++d) {
    for (const PointFamily family : {PointFamily::kSphere, PointFamily::kGaussian}) {
      SCOPED_TRACE(std::string(to_string(family)) + ", d " + std::to_string(d) + ", seed 21");
      const PointSet set = family_points(family, modest_count(d), d, 21);
      const PointSet filled = with_interior_points(set, 300, 22);
      const Hull hull = hull_of(set), same = hull_of(filled);
      EXPECT_EQ(facet_sets(same), facet_sets(hull));
      EXPECT_NEAR(same.volume, hull.volume, 1e-12 * hull.volume);
      expect_sound(same, filled);
    }
  }
  for (const NamedPolytope& known : small_named_polytopes()) {
    if (known.rank < known.points.dimension || known.rank > 8) continue;
    SCOPED_TRACE(known.name);
    const Hull hull = hull_of(with_interior_points(known.points, 50, 1));
    EXPECT_EQ(hull.facet_count(), known.facets);
    EXPECT_EQ(hull.vertices.size(), known.vertices);
  }
}

TEST(HullMetamorphic, OrderOfTheRowsDoesNotMatter) {
  for (std::size_t d = 2; d <= 7; ++d) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE("gaussian, d " + std::to_string(d) + ", seed " + std::to_string(seed));
      const PointSet set = family_points(PointFamily::kGaussian, modest_count(d), d, seed);
      std::vector<std::size_t> old_of_new;
      const PointSet other = permuted_rows(set, seed, &old_of_new);
      EXPECT_EQ(renamed(facet_sets(hull_of(other)), old_of_new), facet_sets(hull_of(set)));
    }
  }
  for (const NamedPolytope& known : small_named_polytopes()) {
    if (known.rank > 9) continue;
    SCOPED_TRACE(known.name);
    std::vector<std::size_t> old_of_new;
    const PointSet other = permuted_rows(known.points, 6, &old_of_new);
    EXPECT_EQ(renamed(facet_sets(hull_of(other)), old_of_new), facet_sets(hull_of(known.points)));
  }
}

TEST(HullMetamorphic, MotionsAndScalesLeaveTheFacets) {
  for (std::size_t d = 2; d <= 7; ++d) {
    const PointSet set = family_points(PointFamily::kGaussian, modest_count(d), d, 77);
    const Hull hull = hull_of(set);
    const std::vector<VertexSet> facets = facet_sets(hull);
    SCOPED_TRACE("gaussian, d " + std::to_string(d) + ", seed 77");
    EXPECT_EQ(facet_sets(hull_of(rotated(set, 78))), facets);
    EXPECT_EQ(facet_sets(hull_of(moved(set, std::vector<double>(d, 3.0)))), facets);
    EXPECT_EQ(facet_sets(hull_of(mirrored(set, 0))), facets);
    std::vector<double> factors(d);
    double product = 1.0;
    for (std::size_t k = 0; k < d; ++k)
      product *= factors[k] = std::ldexp(1.0, 10 * static_cast<int>(k) - 20);
    const Hull scaled = hull_of(axis_scaled(set, factors));
    EXPECT_EQ(facet_sets(scaled), facets);
    EXPECT_NEAR(scaled.volume, hull.volume * product, 1e-9 * hull.volume * product);
  }
}

TEST(HullMetamorphic, VolumesOfTheTwoHalvesOfABoxAddUp) {
  for (std::size_t d = 2; d <= 6; ++d) {
    // A cross-polytope is cut by x_0 = 0 into two halves, each with the other axes' corners.
    const NamedPolytope whole = cross_polytope(d);
    double sum = 0.0;
    for (const double side : {-1.0, 1.0}) {
      PointSet half{d, {}, {}};
      for (std::size_t i = 0; i < whole.points.rows(); ++i) {
        const auto row = whole.points.row(i);
        if (row[0] * side < 0.0) continue;
        half.coordinates.insert(half.coordinates.end(), row.begin(), row.end());
      }
      sum += hull_of(half).volume;
    }
    EXPECT_NEAR(sum, hull_of(whole.points).volume, 1e-12) << "d " << d;
  }
}

bool same_bytes(const Hull& a, const Hull& b) {
  if (a.facet_count() != b.facet_count() || a.vertices != b.vertices) return false;
  for (std::uint32_t row = 0; row < a.facet_count(); ++row) {
    const FacetId facet{row};
    const auto left = a.normal(facet), right = b.normal(facet);
    if (std::memcmp(left.data(), right.data(), left.size_bytes()) != 0) return false;
    const double numbers[] = {a.offset(facet), a.outer_offset(facet), a.inner_offset(facet),
                              a.area_of(facet)};
    const double others[] = {b.offset(facet), b.outer_offset(facet), b.inner_offset(facet), b.area_of(facet)};
    if (std::memcmp(numbers, others, sizeof numbers) != 0) return false;
    const auto vertices = a.vertices_of(facet), other_vertices = b.vertices_of(facet);
    if (!std::equal(vertices.begin(), vertices.end(), other_vertices.begin(), other_vertices.end()))
      return false;
  }
  return std::memcmp(&a.volume, &b.volume, sizeof a.volume) == 0 &&
         a.max_outside_gauge == b.max_outside_gauge;
}

TEST(HullLaw, SameInputAndSeedGiveTheSameBytesForAnyNumberOfThreads) {
  for (std::size_t d = 2; d <= 7; ++d) {
    std::vector<DegenerateCase> inputs = degenerate_cases(modest_count(d), d, 41);
    inputs.push_back(
        {"sphere, d " + std::to_string(d), family_points(PointFamily::kSphere, modest_count(d), d, 41)});
    for (const DegenerateCase& input : inputs) {
      SCOPED_TRACE(input.description);
      const Hull first = hull_of(input.points, {.seed = 3, .threads = 1});
      EXPECT_TRUE(same_bytes(first, hull_of(input.points, {.seed = 3, .threads = 1})));
      EXPECT_TRUE(same_bytes(first, hull_of(input.points, {.seed = 3, .threads = 2})));
    }
  }
  const PointSet large = family_points(PointFamily::kSphere, 20000, 5, 41);
  EXPECT_TRUE(same_bytes(hull_of(large, {.threads = 1}), hull_of(large, {.threads = 2})));
}

TEST(HullLaw, TheSeedOfTheShiftsChangesNoGenericFacet) {
  for (std::size_t d = 3; d <= 7; ++d) {
    const PointSet set = family_points(PointFamily::kGaussian, modest_count(d), d, 55);
    EXPECT_EQ(facet_sets(hull_of(set, {.seed = 1})), facet_sets(hull_of(set, {.seed = 2}))) << "d " << d;
    const NamedPolytope known = grid(3, d <= 5 ? d : 3);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      EXPECT_EQ(hull_of(known.points, {.seed = seed}).facet_count(), known.facets)
          << known.name << " seed " << seed;
    }
  }
}

}  // namespace
}  // namespace ndhull
