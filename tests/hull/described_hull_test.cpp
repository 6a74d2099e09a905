// The hull by whole facets: the closed forms, and the hull that grows simplices.
#include "approx/facets/described_hull.h"

#include <cctype>
#include <cmath>

#include "core/error.h"
#include "core/frame.h"
#include "core/portable_random.h"
#include "core/whole_facets/pulled_complex.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

Hull grown(const PointSet& set) {
  HullOptions options;
  options.wants_simplices = true;
  return hull_of(set, options);
}

bool is_described(const Hull& hull) { return hull.statistics.created_facets > 0; }

std::string name_of(const testing::TestParamInfo<NamedPolytope>& parameter) {
  std::string name = parameter.param.name;
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
  return name;
}

class DescribedPolytopes : public testing::TestWithParam<NamedPolytope> {};

TEST_P(DescribedPolytopes, HaveTheFacetsAndVerticesOfTheirClosedForm) {
  const NamedPolytope& polytope = GetParam();
  for (const PointSet& set : {polytope.points, permuted_rows(polytope.points, 3)}) {
    const Frame frame = fit_frame(set.view());
    std::vector<double> coordinates(set.rows() * frame.rank);
    map_points(set.view(), frame, coordinates.data());
    HullDescription description(coordinates.data(), set.rows(), frame, 1 << 20);
    bool is_found = false;
    for (int piece = 0; piece < 64 && !is_found; ++piece) is_found = description.advance(1 << 20);
    ASSERT_TRUE(is_found);
    const DescribedHull hull = description.take();
    EXPECT_EQ(hull.facets, polytope.facets);
    EXPECT_EQ(hull.vertices.size(), polytope.vertices);
    EXPECT_EQ(hull.facet_vertices.begin.size(), hull.facets + 1);
    EXPECT_EQ(hull.neighbours.begin.size(), hull.facets + 1);
  }
}

INSTANTIATE_TEST_SUITE_P(DescribedHullOracle, DescribedPolytopes,
                         testing::Values(cube(3), cube(6), cross_polytope(5), simplex(6), cell_24(),
                                         cell_600(), cell_120(), permutahedron(5), birkhoff(4), grid(4, 4),
                                         grid(3, 5), cut_polytope(5), linear_ordering(4),
                                         product_of_simplices(3, 4), cyclic_trigonometric(16, 6)),
                         name_of);

class StructuredInputs : public testing::TestWithParam<NamedPolytope> {};

TEST_P(StructuredInputs, AgreeWithTheGrownHull) {
  const NamedPolytope& polytope = GetParam();
  int images = 0;
  for (const PointSet& set : {polytope.points, rotated(polytope.points, 5), permuted_rows(polytope.points, 6),
                              with_duplicates(polytope.points, 50, 7)}) {
    SCOPED_TRACE("image " + std::to_string(images++) + " of " + polytope.name);
    const Hull hull = hull_of(set), other = grown(set);
    if (polytope.rank > 5) {  // else simplices may be there first
      EXPECT_TRUE(is_described(hull));
    }
    EXPECT_FALSE(is_described(other));
    EXPECT_EQ(hull.facet_count(), polytope.facets);
    EXPECT_EQ(hull.vertices.size(), polytope.vertices);
    // Of points given twice either may be the vertex.
    if (set.rows() == polytope.points.rows()) {
      EXPECT_EQ(facet_sets(hull), facet_sets(other));
    }
    EXPECT_NEAR(hull.volume, other.volume, 1e-9 * other.volume);
    EXPECT_NEAR(hull.area, other.area, 1e-9 * other.area);
    EXPECT_EQ(hull.simplicial_facet_count(), other.simplicial_facet_count());
    expect_sound(hull, set);
    constexpr std::size_t kFewSimplices = 20'000;  // their faces are listed
    if (hull.simplex_count() < kFewSimplices) expect_euler(face_numbers(hull.simplices()));
  }
}

INSTANTIATE_TEST_SUITE_P(DescribedHullOracle, StructuredInputs,
                         testing::Values(cube(7), cube(8), grid(3, 7), permutahedron(6)), name_of);

TEST(DescribedHullLaw, CornersOfCubesAtRandom) {
  // Facets of all shapes, some of them simplices.
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PointSet set = permuted_rows(cube(8).points, seed);
    set.coordinates.resize((60 + 30 * seed) * set.dimension);
    const Hull hull = hull_of(set), other = grown(set);
    EXPECT_EQ(facet_sets(hull), facet_sets(other));
    EXPECT_NEAR(hull.volume, other.volume, 1e-9 * other.volume);
    expect_sound(hull, set);
  }
}

TEST(DescribedHullLaw, RoughPlanesAreNeverTakenForFlatOnes) {
  // From far below what counts as flat to far above what counts as clear.
  for (int exponent = -15; exponent <= -4; ++exponent) {
    SCOPED_TRACE("a 7-d cube, each coordinate moved by up to 1e" + std::to_string(exponent));
    PointSet set = cube(7).points;
    PortableRandom random(11);
    for (double& coordinate : set.coordinates) coordinate += std::pow(10.0, exponent) * random.symmetric();
    const Hull hull = hull_of(set);
    EXPECT_EQ(hull.points_outside, 0u);
    EXPECT_LT(hull.max_facet_width, 1e-11 * extent_of(set));
    expect_sound(hull, set);
  }
}

TEST(DescribedHullExample, AllOrdersOfFiveThingsInTwentyCoordinates) {
  const NamedPolytope polytope = linear_ordering(5);
  const Hull hull = hull_of(polytope.points), other = grown(polytope.points);
  EXPECT_TRUE(is_described(hull));
  EXPECT_EQ(hull.facet_count(), 40u);
  EXPECT_EQ(facet_sets(hull), facet_sets(other));
  EXPECT_NEAR(hull.volume, other.volume, 1e-9 * other.volume);
  EXPECT_NEAR(hull.area, other.area, 1e-9 * other.area);
}

TEST(DescribedHullExample, CubesWhoseSimplicesNobodyCanList) {
  const NamedPolytope polytope = cube(10);
  const Hull hull = hull_of(polytope.points);
  EXPECT_EQ(hull.facet_count(), 20u);
  EXPECT_EQ(hull.vertices.size(), 1024u);
  EXPECT_NEAR(hull.volume, 1024.0, 1e-9);
  EXPECT_EQ(hull.simplex_count(), 7'257'600u);  // 20 times 9!
  EXPECT_EQ(hull.points_outside, 0u);
}

// The facets' numbers of simplices are as large as they can be told, so their sum would begin at 0 again.
TEST(PulledComplexLaw, MoreSimplicesThanCanBeListedAreRefused) {
  PulledFaces faces{.rank = 2,
                    .faces = {{.begin = 0, .count = 2, .is_simplex = true, .measure = 1.0, .simplices = 1},
                              {.begin = 0, .count = 2, .measure = 1.0, .simplices = UINT64_MAX}},
                    .entries = {0, 1},
                    .facets = {0, 1}};
  EXPECT_EQ(count_simplices(faces), UINT64_MAX);
  const std::vector<std::uint32_t> first_rows{0, 1};
  try {
    make_complex(faces, first_rows);
    FAIL() << "expected Error kTooManySimplices";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kTooManySimplices);
  }
}

}  // namespace
}  // namespace ndhull
