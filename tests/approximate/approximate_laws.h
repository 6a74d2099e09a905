// What holds for every approximate hull, from the points and the simplices alone.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "approx/geometry/boundedness.h"
#include "approx/verify/verify.h"
#include "tests/hull/hull_support.h"

namespace ndhull {

/// Points to look at: so many of a family.
struct FamilySize {
  PointFamily family;
  std::size_t n, d;
};

/// Outer minus inner of the widest facet from all points and all vertices of its simplices, in long double.
inline long double measured_width(const Hull& hull, const PointView& points) {
  long double widest = 0.0L;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const auto normal = hull.normal(FacetId{row});
    const auto product = [&](std::size_t point) {
      long double sum = 0.0L;
      for (std::size_t k = 0; k < points.dimension; ++k)
        sum += static_cast<long double>(normal[k]) * (points.at(point, k) - hull.reference[k]);
      return sum;
    };
    long double high = -HUGE_VALL, low = HUGE_VALL;
    for (std::size_t point = 0; point < points.rows; ++point) high = std::max(high, product(point));
    for (const SimplexId simplex : hull.simplices_of(FacetId{row})) {
      for (const PointId id : hull.simplices().vertices(simplex)) low = std::min(low, product(id.value));
    }
    widest = std::max(widest, (high - low) / hull.input_per_length_unit(FacetId{row}));
  }
  return widest;
}

/// What holds for every approximate hull.
inline void expect_approximate_laws(const Hull& hull, const PointView& points) {
  EXPECT_EQ(hull.points_outside, 0U);
  ASSERT_GT(hull.facet_count(), hull.rank);
  EXPECT_LE(largest_outer_excess(hull, points), 0.0L);
  EXPECT_LE(largest_inner_excess(hull, points), 0.0L);
  const long double measured = measured_width(hull, points);
  EXPECT_GE(static_cast<long double>(hull.max_facet_width), measured - 1e-15L);
  // An unmerged facet's offsets may lie on both sides of 0 by roundoff; apart from that the width is tight.
  EXPECT_LE(static_cast<long double>(hull.max_facet_width),
            measured * (1.0L + 1e-9L) + 20.0L * hull.roundoff);
  const Verification verification = verify_hull(points, hull, VerifyMode::kFloating);
  EXPECT_TRUE(verification.passed()) << verification.first_failure();
  std::vector<double> normals;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const auto normal = hull.normal(FacetId{row});
    normals.insert(normals.end(), normal.begin(), normal.end());
  }
  EXPECT_TRUE(find_open_direction(normals, hull.dimension, hull.subspace_equations).bounded);
}

}  // namespace ndhull
