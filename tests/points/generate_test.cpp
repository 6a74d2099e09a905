#include "tools/points/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

GenerateOptions options_for(PointFamily family, std::size_t dimension, std::size_t count) {
  GenerateOptions options;
  options.family = family;
  options.dimension = dimension;
  options.count = count;
  options.seed = 7;
  return options;
}

double norm_of(std::span<const double> row) {
  double sum = 0.0;
  for (const double value : row) sum += value * value;
  return std::sqrt(sum);
}

// Mean and variance of one column.
struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};
Moments moments_of(const PointSet& set, std::size_t column) {
  const double n = static_cast<double>(set.rows());
  Moments moments;
  for (std::size_t i = 0; i < set.rows(); ++i) moments.mean += set.row(i)[column] / n;
  for (std::size_t i = 0; i < set.rows(); ++i) {
    moments.variance += std::pow(set.row(i)[column] - moments.mean, 2) / n;
  }
  return moments;
}

// Expects mean and variance of each column within 5 standard errors of the mean for 20000 draws of variance
// at most 1, about 0.035.
void expect_moments(const GenerateOptions& options, double mean, double variance) {
  const PointSet set = generate_points(options);
  for (std::size_t k = 0; k < set.dimension; ++k) {
    const Moments moments = moments_of(set, k);
    EXPECT_NEAR(moments.mean, mean, 0.035) << to_string(options.family) << " column " << k;
    EXPECT_NEAR(moments.variance, variance, 0.05) << to_string(options.family) << " column " << k;
  }
}

void expect_refused(const GenerateOptions& options, ErrorCode code) {
  try {
    row_count(options);
    ADD_FAILURE() << "no error for " << to_string(options.family);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
  }
}

TEST(GenerateLaw, EveryFamilyGivesTheAskedRowsOfFiniteNumbers) {
  for (const PointFamily family : all_point_families()) {
    for (const std::size_t d : {2U, 5U, 8U}) {
      GenerateOptions options = options_for(family, d, 100);
      options.side = 10;
      const PointSet set = generate_points(options);
      EXPECT_EQ(set.rows(), 100U) << to_string(family);
      EXPECT_EQ(set.dimension, d);
      EXPECT_TRUE(std::all_of(set.coordinates.begin(), set.coordinates.end(),
                              [](double v) { return std::isfinite(v); }));
      EXPECT_NE(set.header.find(to_string(family)), std::string::npos);
    }
    EXPECT_EQ(point_family(to_string(family)), family);
  }
}

TEST(GenerateExample, TheHeaderIsTheCommand) {
  GenerateOptions lattice{.family = PointFamily::kLattice, .dimension = 2, .count = 0, .side = 5};
  EXPECT_EQ(generate_points(lattice).header, "ndhull generate lattice -d 2 --seed 1 --side 5");
  lattice.side = 3;
  EXPECT_EQ(generate_command(lattice), "ndhull generate lattice -d 2 --seed 1");
  EXPECT_EQ(generate_command({.family = PointFamily::kEllipsoid,
                              .dimension = 2,
                              .count = 9,
                              .seed = 4,
                              .scalar = ScalarType::kFloat32,
                              .axes = {0.1, 2.0}}),
            "ndhull generate ellipsoid -d 2 -n 9 --seed 4 --float32 --axes 0.1 2");
  EXPECT_EQ(
      generate_command({.family = PointFamily::kClusters, .dimension = 3, .cluster_count = 4, .spread = 0.5}),
      "ndhull generate clusters -d 3 -n 1000 --seed 1 --clusters 4 --spread 0.5");
  EXPECT_EQ(generate_command({.family = PointFamily::kCyclic, .curve = CyclicCurve::kMoment}),
            "ndhull generate cyclic -d 5 -n 1000 --seed 1 --curve moment");
}

TEST(GenerateExample, CapsOfALargeRadiusAreAsHighAsTheyShould) {
  const double radius = 1e8;
  const PointSet set =
      generate_points({.family = PointFamily::kLens, .dimension = 3, .count = 200, .lens_radius = radius});
  for (std::size_t row = 0; row < set.rows(); ++row) {
    const double* const x = set.coordinates.data() + 3 * row;
    const double height = (1.0 - x[0] * x[0] - x[1] * x[1]) / (2.0 * radius);
    EXPECT_NEAR(std::abs(x[2]), height, 1e-12 * height + 1e-24);
  }
}

TEST(GenerateRefused, NumbersThatOverflow) {
  constexpr std::size_t kHalf = std::size_t{1} << 63;
  expect_refused({.family = PointFamily::kClusters, .dimension = 2, .count = 2, .cluster_count = kHalf},
                 ErrorCode::kUsage);
  for (const std::size_t side : {(std::size_t{1} << 32) + 1, std::size_t{1} << 32, SIZE_MAX})
    expect_refused({.family = PointFamily::kLattice, .dimension = 2, .count = 0, .side = side},
                   ErrorCode::kTooManyPoints);
}

TEST(GenerateLaw, TheSeedDecidesAndNothingElse) {
  for (const PointFamily family : all_point_families()) {
    GenerateOptions options = options_for(family, 4, 16);
    const PointSet first = generate_points(options);
    EXPECT_EQ(first.coordinates, generate_points(options).coordinates) << to_string(family);
    options.seed = 8;
    const bool is_random = family != PointFamily::kCyclic && family != PointFamily::kLattice;
    EXPECT_EQ(first.coordinates != generate_points(options).coordinates, is_random) << to_string(family);
  }
}

TEST(GenerateLaw, MoreRowsStartWithTheSameRows) {
  const PointSet few = generate_points(options_for(PointFamily::kSphere, 5, 10));
  const PointSet many = generate_points(options_for(PointFamily::kSphere, 5, 1000));
  EXPECT_TRUE(std::equal(few.coordinates.begin(), few.coordinates.end(), many.coordinates.begin()));
}

// A hash of the bits of many coordinates: another value means another machine gets other points.
TEST(GenerateRegression, BitsAreTheSameOnEveryMachine) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const PointFamily family : all_point_families()) {
    for (const double value : generate_points(options_for(family, 6, 64)).coordinates) {
      std::uint64_t bits = 0;
      static_assert(sizeof bits == sizeof value);
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3ULL;
    }
  }
  EXPECT_EQ(hash, 7664418908131051538ULL);
}

TEST(GenerateLaw, BlocksAreTheRowsInOrder) {
  GenerateOptions options = options_for(PointFamily::kBall, 5, 100000);
  const PointSet whole = generate_points(options);
  std::size_t rows = 0;
  std::size_t blocks = 0;
  generate(options, [&](const PointView& block) {
    ++blocks;
    for (std::size_t row = 0; row < block.rows; ++row) {
      for (std::size_t k = 0; k < 5; ++k) ASSERT_EQ(block.at(row, k), whole.row(rows + row)[k]);
    }
    rows += block.rows;
  });
  EXPECT_EQ(rows, 100000U);
  EXPECT_GT(blocks, 2U);
}

TEST(GenerateLaw, Float32IsTheRoundingOfFloat64) {
  GenerateOptions options = options_for(PointFamily::kGaussian, 3, 50000);
  const PointSet exact = generate_points(options);
  options.scalar = ScalarType::kFloat32;
  std::size_t index = 0;
  generate(options, [&](const PointView& block) {
    EXPECT_EQ(block.type, ScalarType::kFloat32);
    for (std::size_t row = 0; row < block.rows; ++row) {
      for (std::size_t k = 0; k < 3; ++k, ++index) {
        ASSERT_EQ(block.at(row, k), static_cast<double>(static_cast<float>(exact.coordinates[index])));
      }
    }
  });
  EXPECT_EQ(index, exact.coordinates.size());
}

TEST(GenerateSphere, PointsAreOnTheSphereAndUniform) {
  const GenerateOptions options = options_for(PointFamily::kSphere, 5, 20000);
  const PointSet set = generate_points(options);
  double fourth_moment = 0.0;
  for (std::size_t i = 0; i < set.rows(); ++i) {
    EXPECT_NEAR(norm_of(set.row(i)), 1.0, 1e-15);
    for (const double value : set.row(i))
      fourth_moment += std::pow(value, 4) / static_cast<double>(5 * set.rows());
  }
  expect_moments(options, 0.0, 1.0 / 5);
  // 3 / (d (d + 2)); points of a cube projected to the sphere have less.
  EXPECT_NEAR(fourth_moment, 3.0 / 35, 0.003);
}

TEST(GenerateBall, PointsAreInsideAndFillItEvenly) {
  const PointSet set = generate_points(options_for(PointFamily::kBall, 5, 20000));
  std::size_t inner = 0;
  for (std::size_t i = 0; i < set.rows(); ++i) {
    const double norm = norm_of(set.row(i));
    EXPECT_LE(norm, 1.0 + 1e-15);
    inner += norm <= 0.8 ? 1U : 0U;
  }
  EXPECT_NEAR(static_cast<double>(inner) / 20000, std::pow(0.8, 5), 0.018);
}

TEST(GenerateFamilies, MomentsAreThoseOfTheDistribution) {
  expect_moments(options_for(PointFamily::kGaussian, 4, 20000), 0.0, 1.0);
  expect_moments(options_for(PointFamily::kCube, 4, 20000), 0.0, 1.0 / 3);
  expect_moments(options_for(PointFamily::kCubeCorners, 4, 20000), 0.0, 1.0);
  expect_moments(options_for(PointFamily::kSimplex, 3, 20000), 0.25, 3.0 / 80);
  expect_moments(options_for(PointFamily::kCrossPolytope, 3, 20000), 0.0, 0.1);
}

TEST(GenerateCubeSurface, EachPointIsOnAFaceAndNoFaceIsPreferred) {
  const PointSet set = generate_points(options_for(PointFamily::kCubeSurface, 4, 20000));
  std::vector<std::size_t> on_face(8);
  for (std::size_t i = 0; i < set.rows(); ++i) {
    std::size_t faces = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LE(std::abs(set.row(i)[k]), 1.0);
      if (std::abs(set.row(i)[k]) == 1.0) {
        ++faces;
        ++on_face[2 * k + (set.row(i)[k] > 0.0 ? 1U : 0U)];
      }
    }
    EXPECT_GE(faces, 1U);
  }
  for (const std::size_t count : on_face) EXPECT_NEAR(static_cast<double>(count), 2500.0, 250.0);
}

TEST(GenerateFiniteFamilies, CountZeroGivesAllTheirPointsOnce) {
  struct Whole {
    PointFamily family;
    std::size_t rows;
  };
  for (const Whole& whole : {Whole{PointFamily::kCubeCorners, 32}, Whole{PointFamily::kCrossPolytope, 10},
                             Whole{PointFamily::kSimplex, 6}, Whole{PointFamily::kLattice, 243}}) {
    const PointSet set = generate_points(options_for(whole.family, 5, 0));
    std::set<std::vector<double>> distinct;
    for (std::size_t i = 0; i < set.rows(); ++i) distinct.emplace(set.row(i).begin(), set.row(i).end());
    EXPECT_EQ(set.rows(), whole.rows) << to_string(whole.family);
    EXPECT_EQ(distinct.size(), whole.rows) << to_string(whole.family);
  }
}

TEST(GenerateSolids, PointsAreInside) {
  const PointSet simplex = generate_points(options_for(PointFamily::kSimplex, 6, 500));
  const PointSet cross = generate_points(options_for(PointFamily::kCrossPolytope, 6, 500));
  for (std::size_t i = 0; i < 500; ++i) {
    double sum = 0.0;
    double sum_abs = 0.0;
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_GE(simplex.row(i)[k], 0.0);
      sum += simplex.row(i)[k];
      sum_abs += std::abs(cross.row(i)[k]);
    }
    EXPECT_LE(sum, 1.0 + 1e-15);
    EXPECT_LE(sum_abs, 1.0 + 1e-15);
  }
}

TEST(GenerateCyclic, TrigonometricInEvenDimensionsMomentInOdd) {
  const PointSet even = generate_points(options_for(PointFamily::kCyclic, 6, 40));
  for (std::size_t i = 0; i < even.rows(); ++i) EXPECT_NEAR(norm_of(even.row(i)), std::sqrt(3.0), 1e-14);
  const PointSet odd = generate_points(options_for(PointFamily::kCyclic, 3, 5));
  const std::vector<double> expected{-1, 1, -1, -.5, .25, -.125, 0, 0, 0, .5, .25, .125, 1, 1, 1};
  EXPECT_EQ(odd.coordinates, expected);
}

TEST(GenerateLens, PointsAreOnOneOfTheTwoCaps) {
  GenerateOptions options = options_for(PointFamily::kLens, 4, 1000);
  options.lens_radius = 3.0;
  const PointSet set = generate_points(options);
  for (std::size_t i = 0; i < set.rows(); ++i) {
    std::vector<double> row(set.row(i).begin(), set.row(i).end());
    row.back() = std::abs(row.back()) + std::sqrt(8.0);
    EXPECT_NEAR(norm_of(row), 3.0, 1e-14);
    EXPECT_LE(norm_of(set.row(i).first(3)), 1.0 + 1e-15);
  }
}

TEST(GenerateCone, PointsAreOnTheSide) {
  const PointSet set = generate_points(options_for(PointFamily::kCone, 4, 1000));
  for (std::size_t i = 0; i < set.rows(); ++i) {
    EXPECT_NEAR(norm_of(set.row(i).first(3)), 1.0 - set.row(i)[3], 1e-15);
    EXPECT_GE(set.row(i)[3], 0.0);
  }
}

TEST(GenerateEllipsoid, AxesAreThoseAskedFor) {
  GenerateOptions options = options_for(PointFamily::kEllipsoid, 3, 200);
  options.axes = {4.0, 2.0, 0.5};
  const PointSet set = generate_points(options);
  for (std::size_t i = 0; i < set.rows(); ++i) {
    const std::span<const double> row = set.row(i);
    EXPECT_NEAR(std::pow(row[0] / 4, 2) + std::pow(row[1] / 2, 2) + std::pow(row[2] / 0.5, 2), 1.0, 1e-14);
  }
}

TEST(GenerateClusters, SpreadZeroLeavesTheCentres) {
  GenerateOptions options = options_for(PointFamily::kClusters, 3, 500);
  options.cluster_count = 7;
  options.spread = 0.0;
  const PointSet set = generate_points(options);
  std::set<std::vector<double>> distinct;
  for (std::size_t i = 0; i < set.rows(); ++i) distinct.emplace(set.row(i).begin(), set.row(i).end());
  EXPECT_EQ(distinct.size(), 7U);
}

TEST(GenerateErrors, ParametersOutsideTheirRangeAreRefused) {
  expect_refused(options_for(PointFamily::kSphere, 0, 10), ErrorCode::kDimensionTooLow);
  expect_refused(options_for(PointFamily::kSphere, 3, 0), ErrorCode::kUsage);
  expect_refused(options_for(PointFamily::kCubeCorners, 60, 0), ErrorCode::kTooManyPoints);
  expect_refused(options_for(PointFamily::kLattice, 2, 10), ErrorCode::kUsage);
  expect_refused(options_for(PointFamily::kCone, 1, 10), ErrorCode::kUsage);
  GenerateOptions lens = options_for(PointFamily::kLens, 3, 10);
  lens.lens_radius = 1.0;
  expect_refused(lens, ErrorCode::kUsage);
  GenerateOptions cyclic = options_for(PointFamily::kCyclic, 3, 10);
  cyclic.curve = CyclicCurve::kTrigonometric;
  expect_refused(cyclic, ErrorCode::kUsage);
  GenerateOptions ellipsoid = options_for(PointFamily::kEllipsoid, 3, 10);
  ellipsoid.axes = {1.0, 2.0};
  expect_refused(ellipsoid, ErrorCode::kUsage);
  GenerateOptions clusters = options_for(PointFamily::kClusters, 3, 10);
  clusters.spread = -1.0;
  expect_refused(clusters, ErrorCode::kUsage);
  clusters.spread = 1.0;
  clusters.cluster_count = 0;
  expect_refused(clusters, ErrorCode::kUsage);
  GenerateOptions lattice = options_for(PointFamily::kLattice, 3, 0);
  lattice.side = 0;
  expect_refused(lattice, ErrorCode::kUsage);
  EXPECT_THROW(point_family("shpere"), Error);
}

TEST(GenerateErrors, CoordinatesThatAreNoNumbersAreRefused) {
  const auto expect_out_of_range = [](const GenerateOptions& options) {
    try {
      generate_points(options);
      ADD_FAILURE() << to_string(options.family);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kOutOfRange) << error.what();
    }
  };
  GenerateOptions lens = options_for(PointFamily::kLens, 3, 10);
  lens.lens_radius = 1e300;  // its square is no double, its caps are
  EXPECT_NO_THROW(generate_points(lens));
  GenerateOptions clusters = options_for(PointFamily::kClusters, 3, 50);
  clusters.spread = 1e308;
  expect_out_of_range(clusters);
  clusters.spread = 1e39;
  EXPECT_NO_THROW(generate_points(clusters));
  clusters.scalar = ScalarType::kFloat32;
  expect_out_of_range(clusters);
}

TEST(PortableRandomLaw, LogarithmAndCircleAreAccurate) {
  PortableRandom random(3);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::ldexp(random.unit() + 0x1p-53, static_cast<int>(random.below(200)) - 100);
    EXPECT_NEAR(portable_log(x), std::log(x), 4e-16 * std::max(1e-3, std::abs(std::log(x))));
    const std::uint64_t denominator = 1 + random.below(1000000);
    const std::uint64_t numerator = random.below(3 * denominator);
    const long double angle = 2.0L * 3.14159265358979323846L *
                              static_cast<long double>(numerator % denominator) /
                              static_cast<long double>(denominator);
    const CirclePoint point = portable_circle(numerator, denominator);
    EXPECT_NEAR(point.cosine, static_cast<double>(std::cos(angle)), 3e-16);
    EXPECT_NEAR(point.sine, static_cast<double>(std::sin(angle)), 3e-16);
  }
  EXPECT_EQ(portable_circle(3, 4).cosine, 0.0);
  EXPECT_EQ(portable_circle(3, 4).sine, -1.0);
}

}  // namespace
}  // namespace ndhull
