// Proofs that points are inside: how good they are in hulls of any shape.
#include "core/complex/membership.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/growth/growth.h"
#include "tests/prepared_growth.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

// The rounding of a proof is covered with a ball inside the hull. Where that is small no simplex has a better
// proof than the one the point is in, and none is looked for.
TEST(MembershipProof, LooksNoFurtherThanRoundingLetsIt) {
  const PointSet set =
      generate_points({.family = PointFamily::kLattice, .dimension = 4, .count = 0, .side = 4});
  std::vector<double> coordinates;
  GrowthWork work;
  const Frame frame = prepare_growth(set.view(), coordinates, work);
  start_growth(work, frame.simplex, FirstPoints());
  ASSERT_EQ(grow(work), GrowthStop::kNoOutsidePoints);
  std::vector<PointId> points;
  for (std::uint32_t id = 0; id < set.rows(); ++id) points.push_back(PointId{id});
  HullBall ball = find_ball(work.rank, coordinates.data(), set.rows(), frame.simplex);
  for (const double smaller : {1.0, 1e-3, 1e-6}) {
    SCOPED_TRACE(smaller);
    HullBall small = ball;
    small.inner_radius *= smaller;
    std::uint64_t searched_all = 0;
    for (const LocatedPoint& point :
         prove_inside(work.complex, coordinates.data(), small, points, work.options.shift, searched_all))
      EXPECT_LT(point.gauge, 4e-12 + 1e-12 / smaller);
    EXPECT_EQ(searched_all, 0u);
  }
}

}  // namespace
}  // namespace ndhull
