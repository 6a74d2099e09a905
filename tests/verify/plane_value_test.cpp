// Values of planes: bounds that hold, signs that are exact; orientation and heights.
#include "core/plane_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/exact_orientation.h"

namespace ndhull {
namespace {

constexpr DoubtfulSign kWays[] = {DoubtfulSign::kExtendedThenExact, DoubtfulSign::kExact};

int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

/// A plane through a point, up to rounding, and the numbers it stands on.
struct NearTie {
  std::vector<double> normal, reference, point;
  CentredPlane plane;

  NearTie(std::size_t d, std::mt19937_64& random) : normal(d), reference(d), point(d) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    double value = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      normal[k] = uniform(random);
      reference[k] = random() % 2 == 0 ? 0.0 : 1e6 * uniform(random);
      point[k] = reference[k] + uniform(random);
      value += normal[k] * (point[k] - reference[k]);
    }
    const double claimed = random() % 2 == 0 ? 0.0 : uniform(random);
    plane = {normal, reference, claimed * 0.1 - value, claimed, 0.1};
  }
};

TEST(PlaneValueLaw, SignsNearTiesAreThoseOfExactArithmetic) {
  std::mt19937_64 random(20240601);
  std::size_t open_in_double = 0;
  for (int round = 0; round < 2000; ++round) {
    const NearTie tie(1 + random() % 12, random);
    const int exact = sign_of(exact_plane_value(tie.plane, tie.point));
    const BoundedValue in_double = plane_value_double(tie.plane, tie.point);
    const BoundedValue extended = plane_value_extended(tie.plane, tie.point);
    open_in_double += in_double.certain() ? 0U : 1U;
    if (in_double.certain()) {
      EXPECT_EQ(sign_of(in_double.value), exact);
    }
    if (extended.certain()) {
      EXPECT_EQ(sign_of(extended.value), exact);
    }
    for (const DoubtfulSign way : kWays) EXPECT_EQ(sign_of(plane_sign(tie.plane, tie.point, way)), exact);
  }
  EXPECT_GT(open_in_double, 1000u);
}

TEST(PlaneValueLaw, BoundsHold) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 2000; ++round) {
    const NearTie tie(1 + random() % 12, random);
    const double exact = exact_plane_value(tie.plane, tie.point);
    const BoundedValue in_double = plane_value_double(tie.plane, tie.point);
    const BoundedValue extended = plane_value_extended(tie.plane, tie.point);
    EXPECT_LE(std::fabs(in_double.value - exact), in_double.error);
    EXPECT_LE(std::fabs(extended.value - exact), extended.error + 0x1p-52 * std::fabs(exact));
    EXPECT_LT(extended.error, 0x1p-30 * in_double.error);
  }
}

TEST(PlaneValueExample, OneUlpDecides) {
  const std::vector<double> normal{1.0 / 3.0, 0.1, -0.7};
  for (const DoubtfulSign way : kWays) {
    const std::vector<double> on{0.0, 0.0, 0.0};
    EXPECT_EQ(plane_sign({.normal = normal, .reference = {}}, on, way), 0.0);
    const std::vector<double> out{std::numeric_limits<double>::denorm_min(), 0.0, 0.0};
    EXPECT_GT(plane_sign({.normal = normal, .reference = {}}, out, way),
              0.0);  // a third of the smallest double
  }
}

TEST(PlaneValueExample, OverflowAndUnderflowAreDecidedExactly) {
  const double huge = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const std::vector<double> normal{huge, -huge};
  for (const DoubtfulSign way : kWays) {
    const std::vector<double> equal{huge, huge};
    const std::vector<double> above{huge, std::nextafter(huge, 0.0)};
    EXPECT_EQ(plane_sign({.normal = normal, .reference = {}}, equal, way), 0.0);
    EXPECT_EQ(plane_sign({.normal = normal, .reference = {}, .offset = -tiny}, equal, way), -tiny);
    EXPECT_GT(plane_sign({.normal = normal, .reference = {}, .offset = -1.0}, above, way), 1.0);
    const std::vector<double> small{tiny, 0.0};
    const std::vector<double> slope{-tiny, 1.0};
    EXPECT_EQ(plane_sign({.normal = slope, .reference = {}}, small, way), -tiny);
  }
}

TEST(PlaneValueExample, ClaimIsAnExactProduct) {
  // 0.1 * 0.1 is not a double: the claim is a little more than the double 0.1 * 0.1, or a little less.
  const std::vector<double> normal{1.0};
  const std::vector<double> point{0.1 * 0.1};
  const double residual = std::fma(0.1, 0.1, -(0.1 * 0.1));
  ASSERT_NE(residual, 0.0);
  for (const DoubtfulSign way : kWays) {
    EXPECT_EQ(plane_sign({.normal = normal, .reference = {}, .claimed = 0.1, .unit = 0.1}, point, way),
              -residual);
  }
}

TEST(ExactOrientationExample, SimplexItsMirrorAndFlatPoints) {
  for (std::size_t d = 1; d <= 10; ++d) {
    std::vector<double> points((d + 1) * d, 0.0);
    for (std::size_t k = 0; k < d; ++k) points[(k + 1) * d + k] = 1.0;
    EXPECT_EQ(exact_orientation(points, d), 1) << d;
    points[d] = -1.0;
    EXPECT_EQ(exact_orientation(points, d), -1) << d;
    points[d] = 0.0;
    EXPECT_EQ(exact_orientation(points, d), 0) << d;
    points[d] = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(exact_orientation(points, d), 1) << d;
  }
}

TEST(ExactHeightExample, WidthAndItsLeverDecide) {
  const std::vector<double> vertices{0, 0, 1, 0};  // the segment from 0 to 1 on the axis
  const std::vector<double> normal{0, 1};
  const auto test = [&](double x, double y, double outer, double inner) {
    return exact_height_test(vertices, normal, std::vector<double>{x, y}, outer, inner, 1.0);
  };
  EXPECT_EQ(test(0.5, 0.0, 0.0, 0.0), HeightTest::kWithin);
  EXPECT_EQ(test(0.5, 1e-300, 0.0, 0.0), HeightTest::kAbove);
  EXPECT_EQ(test(0.5, 0.25, 0.125, -0.125), HeightTest::kWithin);
  EXPECT_EQ(test(0.5, std::nextafter(0.25, 1.0), 0.125, -0.125), HeightTest::kAbove);
  EXPECT_EQ(test(3.0, 0.75, 0.125, -0.125), HeightTest::kWithin);  // 3 times the width at 3 lengths
  EXPECT_EQ(test(3.0, std::nextafter(0.75, 1.0), 0.125, -0.125), HeightTest::kAbove);
  const std::vector<double> equal{1, 1, 1, 1};
  EXPECT_EQ(exact_height_test(equal, normal, std::vector<double>{0, 0}, 0.0, 0.0, 1.0),
            HeightTest::kSingular);
}

}  // namespace
}  // namespace ndhull
