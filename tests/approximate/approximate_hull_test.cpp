// Laws of approximate hulls: the target is met, the width is what it says, no point is lost.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/approximate/approximate_laws.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

const FamilySize kShapes[] = {{PointFamily::kSphere, 400, 3},   {PointFamily::kSphere, 300, 5},
                              {PointFamily::kBall, 500, 4},     {PointFamily::kGaussian, 3000, 5},
                              {PointFamily::kGaussian, 200, 7}, {PointFamily::kCube, 400, 6},
                              {PointFamily::kClusters, 500, 4}, {PointFamily::kEllipsoid, 300, 5},
                              {PointFamily::kLens, 200, 4},     {PointFamily::kSphere, 60, 8}};

TEST(ApproximateHullLaw, WidthIsMet) {
  for (const FamilySize& shape : kShapes) {
    for (const double percent : {1.0, 5.0, 20.0}) {
      const PointSet set = family_points(shape.family, shape.n, shape.d, 20240601);
      SCOPED_TRACE(std::string(to_string(shape.family)) + " " + std::to_string(shape.d) + "-d, " +
                   std::to_string(percent) + "%");
      HullOptions options;
      options.accuracy.width = {percent, true};
      const Hull hull = hull_of(set, options);
      EXPECT_LE(hull.max_facet_width, 0.01 * percent * extent_of(set));
      expect_approximate_laws(hull, set.view());
    }
  }
}

std::vector<double> sorted_areas(const Hull& hull) {
  std::vector<double> areas;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) areas.push_back(hull.area_of(FacetId{row}));
  std::sort(areas.begin(), areas.end());
  return areas;
}

// Widths below which nothing merges leave the exact hull.
TEST(ApproximateHullLaw, WidthsThatMergeNothingGiveTheExactHull) {
  for (const char* words : {"200 s D5 t1", "80 s D8 t1"}) {
    SCOPED_TRACE(words);
    const PointSet set = rbox(words);
    HullOptions options;
    options.accuracy.width = {1e-7, true};
    const Hull hull = hull_of(set, options), exact = hull_of(set, HullOptions());
    ASSERT_EQ(hull.facet_count(), exact.facet_count());
    EXPECT_FALSE(hull.is_approximate);
    EXPECT_NEAR(hull.volume, exact.volume, 1e-14 * exact.volume);
    EXPECT_NEAR(hull.area, exact.area, 1e-14 * exact.area);
    // Points are added in another order, and the vertices of thin simplices eliminated in it.
    const std::vector<double> areas = sorted_areas(hull), exact_areas = sorted_areas(exact);
    double worst = 0.0;
    for (std::size_t i = 0; i < areas.size(); ++i)
      worst = std::max(worst, std::abs(areas[i] / exact_areas[i] - 1.0));
    EXPECT_LT(worst, 1e-11);
  }
}

// What is left out makes simplices that are facets alone wider than asked: growth has to add it, and once.
TEST(ApproximateHullLaw, WidthIsMetWhereNearlyAsMuchIsLeftOut) {
  struct Case {
    const char* points;
    double width, outside;  // percent
  };
  for (const auto& [points, width, outside] : {Case{"100 s D6", 20.0, 19.0},
                                               {"200 s D6", 10.0, 8.0},
                                               {"150 s D7", 30.0, 28.5},
                                               {"500 D6", 20.0, 19.0},
                                               {"300 s D5", 10.0, 12.0}}) {
    const PointSet set = rbox(points);
    SCOPED_TRACE(std::string(points) + ", " + std::to_string(outside) + "% left out");
    HullOptions options;
    options.accuracy.width = {width, true};
    options.accuracy.outside_width = {outside, true};
    options.limits.max_seconds = 60.0;
    const Hull hull = hull_of(set, options);
    EXPECT_EQ(hull.status, HullStatus::kComplete);
    EXPECT_LE(hull.max_facet_width, 0.01 * width * extent_of(set));
    expect_approximate_laws(hull, set.view());
  }
}

TEST(ApproximateHullLaw, NumberOfFacetsIsMet) {
  for (const FamilySize& shape : kShapes) {
    for (const std::uint64_t count : {shape.d + 1, 2 * shape.d, 40 * shape.d}) {
      const PointSet set = family_points(shape.family, shape.n, shape.d, 20240602);
      SCOPED_TRACE(std::string(to_string(shape.family)) + " " + std::to_string(shape.d) + "-d, " +
                   std::to_string(count) + " facets");
      HullOptions options;
      options.accuracy.facets = count;
      const Hull hull = hull_of(set, options);
      EXPECT_LE(hull.facet_count(), count);
      expect_approximate_laws(hull, set.view());
    }
  }
}

// So many points that fits search a tree instead of multiplying with all of them.
TEST(ApproximateHullLaw, NumberOfFacetsIsMetWhereVerticesAreMany) {
  const PointSet set = family_points(PointFamily::kSphere, 20000, 5, 3);
  for (const std::uint64_t count : {6u, 7u, 40u}) {
    SCOPED_TRACE(count);
    HullOptions options;
    options.accuracy.facets = count;
    const Hull hull = hull_of(set, options);
    EXPECT_LE(hull.facet_count(), count);
    expect_approximate_laws(hull, set.view());
  }
}

// So many points that growth begins with some of them; their facets as they are, and merged.
TEST(ApproximateHullLaw, OutsideWidthHoldsWhereGrowthBeginsWithSomePoints) {
  const PointSet set = family_points(PointFamily::kSphere, 40000, 5, 4);
  for (const auto& [width, radius] : {std::pair{0.3, 0.0}, {0.2, 0.01}}) {
    SCOPED_TRACE(width);
    HullOptions options;
    options.accuracy.outside_width = {width, false};
    options.accuracy.centrum_radius = {radius, false};
    const Hull hull = hull_of(set, options);
    expect_approximate_laws(hull, set.view());
    if (radius == 0.0) {
      EXPECT_LE(hull.max_facet_width, 1.01 * width);
    }
  }
}

// What the search over all points finds is the certificate, whatever the input looks like: far from the
// origin, flat in more columns, of other strides, in single precision.
TEST(ApproximateHullLaw, OutsideWidthIsCertifiedByItsSearchForAnyInput) {
  const PointSet sphere = family_points(PointFamily::kSphere, 33000, 4, 7);
  const double extent = extent_of(sphere);
  HullOptions options;
  options.accuracy.outside_width = {0.1 * extent, false};
  const auto expect_laws = [&](const PointView& view) {
    const Hull hull = convex_hull(view, options);
    EXPECT_LE(hull.max_facet_width, options.accuracy.outside_width.value);
    expect_approximate_laws(hull, view);
  };
  expect_laws(sphere.view());
  expect_laws(moved(sphere, std::vector<double>{1e3, -1e6, 0.0, 40.0}).view());
  expect_laws(embedded(sphere, 6, 3).view());
  const std::vector<float> floats(sphere.coordinates.begin(), sphere.coordinates.end());
  expect_laws(PointView::row_major(floats.data(), 33000, 4));
  std::vector<double> columns;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t row = 0; row < 33000; ++row) columns.push_back(sphere.view().at(row, k));
  PointView by_columns = PointView::row_major(columns.data(), 33000, 4);
  by_columns.row_stride = 1;
  by_columns.column_stride = 33000;
  expect_laws(by_columns);
  PointView every_other = sphere.view();  // with a gap behind each row
  every_other.dimension = 3;
  expect_approximate_laws(convex_hull(every_other, options), every_other);
}

/// Cubes of gaussian numbers: like measurements, most near the middle and a few far out along the axes.
PointSet heavy_tailed_points(std::size_t count, std::size_t dimension) {
  PointSet set = family_points(PointFamily::kGaussian, count, dimension, 11);
  for (double& value : set.coordinates) value = value * value * value;
  return set;
}

// Wide slabs of a hull with long spikes cover it and leave directions open. Those are closed by few
// simplices, not by slabs so small that none is open.
TEST(ApproximateHullLaw, WideFacetsOfSpikyHullsAreFew) {
  const PointSet set = heavy_tailed_points(2000, 6);
  for (const double percent : {10.0, 20.0, 40.0}) {
    SCOPED_TRACE(percent);
    HullOptions options;
    options.accuracy.width = {percent, true};
    const Hull hull = hull_of(set, options);
    EXPECT_LE(hull.max_facet_width, 0.01 * percent * extent_of(set));
    if (percent == 40.0) {
      EXPECT_LE(hull.facet_count(), 2 * set.dimension);
    }
    expect_approximate_laws(hull, set.view());
  }
}

TEST(ApproximateHullRegression, AnUnfittableSimplexTakesInWhatIsAboveItsOwnPlane) {
  PointSet set = family_points(PointFamily::kLens, 655, 6, 3);
  for (double& coordinate : set.coordinates) coordinate = static_cast<double>(static_cast<float>(coordinate));
  HullOptions options;
  options.accuracy.width = {2.3, true};
  const Hull hull = hull_of(set, options);
  EXPECT_EQ(hull.status, HullStatus::kComplete);
  EXPECT_LE(hull.max_facet_width, 0.023 * extent_of(set));
}

// Where a hull is too large to be grown to the end, points far above simplices that are facets alone make
// these wide, however narrow the slabs: a number of facets takes such points in as a width does.
TEST(ApproximateHullRegression, ANumberOfFacetsIsAsNarrowAsTheWidthThatNeedsSoMany) {
  const auto largest_ratio = [](const PointSet& set, double percent) {
    HullOptions options;
    options.accuracy.width = {percent, true};
    const Hull by_width = hull_of(set, options);
    options.accuracy.width = {};
    options.accuracy.facets = by_width.facet_count();
    const Hull by_count = hull_of(set, options);
    EXPECT_LE(by_count.facet_count(), by_width.facet_count());
    return by_count.max_facet_width / by_width.max_facet_width;
  };
  EXPECT_LT(largest_ratio(family_points(PointFamily::kCube, 1000, 9, 5), 35.0), 1.0);
  EXPECT_LT(largest_ratio(family_points(PointFamily::kClusters, 3000, 9, 5), 30.0), 1.2);
}

/// More facets than the hull has are flat, and no more than it has.
TEST(ApproximateHullLaw, AsManyFacetsAsTheExactHullAreAsNarrow) {
  const auto check = [](const PointSet& set, bool unit_cube) {
    HullOptions options;
    options.unit_cube = unit_cube;
    const Hull exact = hull_of(set, options);
    if (exact.rank < 2) return;
    const double rounding = 1e-12 * (unit_cube ? 1.0 : extent_of(set));
    const std::uint64_t all = exact.facet_count(), least = exact.rank + 1;
    for (const std::uint64_t count : {least, std::max(least, all - 1), all, all + 1, 2 * all}) {
      options.accuracy.facets = count;
      const Hull hull = hull_of(set, options);
      SCOPED_TRACE(std::to_string(count) + " facets of " + std::to_string(all));
      EXPECT_LE(hull.facet_count(), count);
      if (count >= all) {
        EXPECT_LE(hull.max_facet_width, exact.max_facet_width + rounding);
      }
      expect_approximate_laws(hull, set.view());
    }
  };
  for (std::size_t d = 2; d <= 5; ++d) {
    for (const DegenerateCase& input : degenerate_cases(50, d, 3)) {
      SCOPED_TRACE(input.description + " in " + std::to_string(d) + "-d");
      for (const bool unit_cube : {false, true}) check(input.points, unit_cube);
    }
  }
  check(family_points(PointFamily::kCone, 27, 2, 7056), true);
  check(family_points(PointFamily::kCubeSurface, 80, 3, 4134), true);
  check(family_points(PointFamily::kCubeSurface, 99, 6, 5966), false);
}

TEST(ApproximateHullLaw, MoreFacetsAreNarrower) {
  const PointSet set = family_points(PointFamily::kSphere, 500, 5, 7);
  double last = HUGE_VAL;
  for (const std::uint64_t count : {20U, 60U, 200U, 600U}) {
    HullOptions options;
    options.accuracy.facets = count;
    const double width = hull_of(set, options).max_facet_width;
    EXPECT_LT(width, last);
    last = width;
  }
}

TEST(ApproximateHullLaw, DegenerateInputsAreAnswered) {
  for (std::size_t d = 2; d <= 6; ++d) {
    for (const DegenerateCase& input : degenerate_cases(d <= 4 ? 100 : 50, d, 3)) {
      SCOPED_TRACE(input.description);
      HullOptions options;
      options.accuracy.width = {5.0, true};
      const Hull hull = hull_of(input.points, options);
      EXPECT_LE(hull.max_facet_width, 0.05 * extent_of(input.points));
      if (hull.rank >= 2) expect_approximate_laws(hull, input.points.view());
    }
  }
}

TEST(ApproximateHullLaw, SameForEveryNumberOfThreads) {
  const PointSet set = family_points(PointFamily::kSphere, 400, 6, 11);
  const auto planes_of = [&](unsigned threads) {
    HullOptions options{.threads = threads};
    options.accuracy.facets = 300;
    const Hull hull = hull_of(set, options);
    std::vector<double> numbers;
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
      const auto normal = hull.normal(FacetId{row});
      numbers.insert(numbers.end(), normal.begin(), normal.end());
      numbers.insert(numbers.end(), {hull.offset(FacetId{row}), hull.outer_offset(FacetId{row})});
    }
    return numbers;
  };
  const std::vector<double> one = planes_of(1);
  for (const unsigned threads : {2U, 3U}) {
    const std::vector<double> several = planes_of(threads);
    ASSERT_EQ(one.size(), several.size());
    EXPECT_EQ(std::memcmp(one.data(), several.data(), one.size() * sizeof(double)), 0);
  }
}

TEST(ApproximateHullLaw, UnitCubeMeasuresWidthsThere) {
  PointSet set = family_points(PointFamily::kBall, 400, 4, 5);
  const double factors[] = {1000.0, 1.0, 0.01, 1.0};
  set = axis_scaled(set, factors);
  HullOptions options{.unit_cube = true};
  options.accuracy.width = {0.05, false};
  const Hull hull = hull_of(set, options);
  EXPECT_LE(hull.max_facet_width, 0.05);
  EXPECT_GT(hull.max_facet_width, 0.02);
  expect_approximate_laws(hull, set.view());
}

TEST(ApproximateHullExample, AreaOfAMergedCubeFaceIsTheFaces) {
  const PointSet cube = rbox("c D5");
  HullOptions options;
  options.accuracy.width = {0.01, false};
  const Hull hull = hull_of(cube, options);
  const double side = extent_of(cube);
  ASSERT_EQ(hull.facet_count(), 10U);
  for (std::uint32_t row = 0; row < 10; ++row)
    EXPECT_NEAR(hull.area_of(FacetId{row}), std::pow(side, 4.0), 1e-9 * std::pow(side, 4.0));
  EXPECT_NEAR(hull.area, 10.0 * std::pow(side, 4.0), 1e-8);
}

/// The area of the projection of a simplex along a unit normal: det(edges, normal) / (rank - 1)!.
double projected_area(const Hull& hull, const PointView& points, SimplexId simplex,
                      const Eigen::VectorXd& normal) {
  const auto rank = static_cast<Eigen::Index>(hull.rank);
  const auto ids = hull.simplices().vertices(simplex);
  Eigen::MatrixXd edges(rank, rank);
  for (Eigen::Index i = 0; i < rank; ++i) {
    for (Eigen::Index k = 0; k < rank; ++k) {
      const auto column = static_cast<std::size_t>(k);
      edges(i, k) = i == rank - 1 ? normal[k]
                                  : points.at(ids[static_cast<std::size_t>(i) + 1].value, column) -
                                        points.at(ids[0].value, column);
    }
  }
  return std::abs(edges.determinant()) / std::tgamma(static_cast<double>(rank));
}

/// Across the simplex: the direction that all of its edges are perpendicular to.
Eigen::VectorXd normal_of(const Hull& hull, const PointView& points, SimplexId simplex) {
  const auto rank = static_cast<Eigen::Index>(hull.rank);
  const auto ids = hull.simplices().vertices(simplex);
  Eigen::MatrixXd edges(rank - 1, rank);
  for (Eigen::Index i = 0; i + 1 < rank; ++i)
    for (Eigen::Index k = 0; k < rank; ++k)
      edges(i, k) = points.at(ids[static_cast<std::size_t>(i) + 1].value, static_cast<std::size_t>(k)) -
                    points.at(ids[0].value, static_cast<std::size_t>(k));
  return Eigen::FullPivLU<Eigen::MatrixXd>(edges).kernel().col(0).normalized();
}

void expect_areas_of_projections(const PointSet& set, const HullOptions& options) {
  const Hull hull = hull_of(set, options);
  ASSERT_LT(hull.facet_count(), hull.simplex_count());
  double surface = 0.0;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const auto normal = hull.normal(FacetId{row});
    const Eigen::Map<const Eigen::VectorXd> along(normal.data(), static_cast<Eigen::Index>(normal.size()));
    double projected = 0.0;
    for (const SimplexId simplex : hull.simplices_of(FacetId{row})) {
      projected += projected_area(hull, set.view(), simplex, along);
      surface += projected_area(hull, set.view(), simplex, normal_of(hull, set.view(), simplex));
    }
    // Simplices that face away from the plane's normal would count with the other sign; at these widths none
    // do.
    EXPECT_NEAR(hull.area_of(FacetId{row}), projected, 1e-9);
  }
  EXPECT_NEAR(hull.area, surface, 1e-9 * surface);
}

TEST(ApproximateHullOracle, AreasAreThoseOfSimplicesAndOfTheirProjections) {
  HullOptions few;
  few.accuracy.facets = 40;
  expect_areas_of_projections(rbox("300 s D4 t1"), few);
  HullOptions thin;
  thin.accuracy.width = {0.02, false};
  expect_areas_of_projections(rbox("120 s D6 t1"), thin);
}

TEST(OutsideWidthLaw, PointsLeftOutAreLessOutside) {
  for (const FamilySize& shape : kShapes) {
    const PointSet set = family_points(shape.family, shape.n, shape.d, 99);
    SCOPED_TRACE(std::string(to_string(shape.family)) + " " + std::to_string(shape.d) + "-d");
    const double width = 0.05 * extent_of(set);
    HullOptions options;
    options.accuracy.outside_width = {width, false};
    const Hull hull = hull_of(set, options);
    EXPECT_LE(hull.max_outer_offset, 1.05 * width);
    EXPECT_LE(hull.facet_count(), hull_of(set).facet_count());
    expect_approximate_laws(hull, set.view());
  }
}

TEST(ApproximateHullLaw, ALimitGivesACertifiedHullAllTheSame) {
  const PointSet set = family_points(PointFamily::kSphere, 500, 6, 1);
  HullOptions options{.limits = {.max_facets = 2000}};
  options.accuracy.width = {0.001, false};
  const Hull hull = hull_of(set, options);
  EXPECT_EQ(hull.status, HullStatus::kFacetLimit);
  expect_approximate_laws(hull, set.view());
}

}  // namespace
}  // namespace ndhull
