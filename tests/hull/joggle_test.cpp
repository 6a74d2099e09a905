// Joggled input: simplicial facets, no decision near, planes that hold for the points as they were.
#include "approx/joggle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "approx/verify/verify.h"
#include "core/error.h"
#include "tests/hull/hull_support.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

/// Every claim of the joggled hull, about the points that were given.
void expect_holds_for(const PointSet& given, const JoggledHull& joggled) {
  EXPECT_FALSE(has_precision_problem(joggled.hull));
  EXPECT_EQ(joggled.hull.simplicial_facet_count(), joggled.hull.facet_count());
  EXPECT_LE(largest_outer_excess(joggled.hull, given.view()), 0.0L);
  EXPECT_LE(largest_inner_excess(joggled.hull, given.view()), 0.0L);
  EXPECT_EQ(joggled.hull.points_outside, 0U);
  const Verification verification = verify_hull(given.view(), joggled.hull, VerifyMode::kFloating);
  EXPECT_TRUE(verification.passed()) << verification.first_failure();
  const double diagonal = joggled.size * std::sqrt(static_cast<double>(given.dimension));
  EXPECT_GT(joggled.moved, 0.0);
  EXPECT_LE(joggled.moved, diagonal * (1.0 + 1e-12) + 1e-15);
  EXPECT_GE(joggled.hull.max_facet_width, 2.0 * joggled.moved);
}

TEST(Joggle, MakesDegenerateInputSimplicialAndWidensThePlanes) {
  for (const char* command :
       {"c D3", "c D5", "d c D4", "500 W0 D3 t1", "300 W0 D4 t1", "64 M1,0 D3", "100 s D4 t1"}) {
    SCOPED_TRACE(command);
    const PointSet points = rbox(command);
    const JoggledHull joggled = joggled_hull(points.view(), {}, {});
    EXPECT_EQ(joggled.size, default_joggle(points.view()));
    EXPECT_EQ(joggled.retries, 0U);
    expect_holds_for(points, joggled);
    // The widest facet is the joggle on both sides and rounding, nothing else.
    EXPECT_LE(joggled.hull.max_facet_width, 2.0 * joggled.moved + 20.0 * joggled.hull.roundoff);
  }
}

// Squares of what these move are 0.
TEST(Joggle, WidensThePlanesOfTinyPoints) {
  PointSet points = rbox("c D3");
  for (double& x : points.coordinates) x = std::ldexp(x, -530);
  const JoggledHull joggled = joggled_hull(points.view(), {}, {});
  expect_holds_for(points, joggled);
}

TEST(Joggle, GivesFlatPointsTheThicknessOfTheJoggle) {
  PointSet points = rbox("50 D3 t1");
  for (std::size_t row = 0; row < points.rows(); ++row) points.row(row)[2] = 0.25;
  const JoggledHull joggled = joggled_hull(points.view(), {}, {.size = 1e-6});
  EXPECT_EQ(joggled.hull.rank, 3U);
  expect_holds_for(points, joggled);
}

TEST(Joggle, GrowsTenfoldUntilNoDecisionIsNear) {
  const PointSet points = rbox("300 W0 D4 t2");
  const double size = 2.0 * joggle_roundoff(points.view());
  const JoggledHull joggled = joggled_hull(points.view(), {}, {.size = size});
  ASSERT_GT(joggled.retries, 2U);
  EXPECT_NEAR(joggled.size / size, std::pow(10.0, joggled.retries - 1), 1e-6 * joggled.size / size);
  expect_holds_for(points, joggled);
}

TEST(Joggle, IsTheSameForTheSameSeedAndForAnyThreads) {
  const PointSet points = rbox("200 W0 D4 t1");
  const JoggledHull one = joggled_hull(points.view(), {.threads = 1}, {.size = 1e-9, .seed = 3});
  const JoggledHull two = joggled_hull(points.view(), {.threads = 2}, {.size = 1e-9, .seed = 3});
  const JoggledHull other = joggled_hull(points.view(), {}, {.size = 1e-9, .seed = 4});
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(facet_sets(one.hull), facet_sets(two.hull));
  EXPECT_EQ(one.hull.max_facet_width, two.hull.max_facet_width);
  EXPECT_NE(one.points, other.points);
}

TEST(Joggle, RefusesASizeBelowRoundoff) {
  const PointSet points = rbox("c D3");
  EXPECT_THROW(joggled_hull(points.view(), {}, {.size = 0.5 * joggle_roundoff(points.view())}), Error);
}

TEST(Joggle, SaysWhatIsWrongWithThePoints) {
  const std::vector<double> values{0.0, 1.0, 2.0, std::nan("")};
  try {
    joggled_hull(PointView::row_major(values.data(), 2, 2), {}, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kNotFinite);
  }
}

TEST(JoggleLaw, ProblemsBecomeRareAsTheJoggleGrows) {
  const PointSet cube = rbox("c D3");
  const auto share = [&cube](double size) {
    return static_cast<double>(count_precision_problems(cube.view(), {}, {.size = size}, 400)) / 400.0;
  };
  const double at_roundoff = share(1e-15), middle = share(1e-14), large = share(1e-13), none = share(1e-10);
  EXPECT_GT(at_roundoff, 0.8);
  EXPECT_GT(at_roundoff, middle);
  EXPECT_GT(middle, large);
  // Halving of the share with each doubling of the joggle: some 30 % at 1e-14, a tenth of it at 1e-13.
  EXPECT_NEAR(middle, 0.3, 0.15);
  EXPECT_LT(large, 0.1);
  EXPECT_EQ(none, 0.0);
}

}  // namespace
}  // namespace ndhull
