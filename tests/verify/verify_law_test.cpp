// The engine's own hulls before the witness, over polytopes with known facets and hard inputs.
#include <gtest/gtest.h>

#include "approx/verify/verify.h"
#include "tests/support/degeneracies.h"
#include "tests/support/named_polytopes.h"

namespace ndhull {
namespace {

void expect_verified(const PointSet& set, const HullOptions& options, VerifyMode mode) {
  const PointView points = set.view();
  const Hull hull = convex_hull(points, options);
  const Verification found = verify_hull(points, hull, mode);
  EXPECT_TRUE(found.passed()) << found.first_failure();
  EXPECT_TRUE(found.complete());
}

TEST(VerifyLaw, HullsOfNamedPolytopesKeepTheirClaims) {
  for (const NamedPolytope& polytope : small_named_polytopes()) {
    SCOPED_TRACE(polytope.name);
    if (polytope.rank > 9) continue;  // triangulations of some have millions of simplices
    expect_verified(polytope.points, {}, VerifyMode::kFloating);
  }
}

TEST(VerifyLaw, HullsOfDegenerateInputKeepTheirClaims) {
  for (std::size_t d = 2; d <= 6; ++d) {
    for (const DegenerateCase& hard : degenerate_cases(60, d, 20240601 + d)) {
      SCOPED_TRACE(hard.description);
      expect_verified(hard.points, {}, VerifyMode::kFloating);
      HullOptions options;
      options.unit_cube = true;
      expect_verified(hard.points, options, VerifyMode::kFloating);
      options.triangulate = true;
      expect_verified(hard.points, options, VerifyMode::kFloating);
    }
  }
}

TEST(VerifyLaw, ExactModeAgreesOnDegenerateInput) {
  for (std::size_t d = 2; d <= 4; ++d) {
    for (const DegenerateCase& hard : degenerate_cases(30, d, 7 + d)) {
      SCOPED_TRACE(hard.description);
      expect_verified(hard.points, {}, VerifyMode::kExact);
    }
  }
}

}  // namespace
}  // namespace ndhull
