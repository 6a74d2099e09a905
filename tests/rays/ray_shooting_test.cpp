// Walks against the whole hull: the facet that a ray leaves through, the neighbour across a ridge.
#include "approx/rays/ray_shooting.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <span>

#include "core/portable_random.h"
#include "tests/hull/hull_support.h"
#include "tests/support/degeneracies.h"

namespace ndhull {
namespace {

std::vector<WalkTask> random_rays(std::size_t rank, std::size_t count, std::uint64_t seed) {
  PortableRandom random(seed);
  std::vector<WalkTask> tasks(count);
  for (WalkTask& task : tasks) {
    for (std::size_t k = 0; k < rank; ++k) task.direction.push_back(random.normal());
  }
  return tasks;
}

/// a.r of the hull's facets in the frame of the walks, the largest one: one over how far the ray goes.
double exit_value(const Hull& hull, const PointSet& set, const Frame& frame, const std::vector<double>& ray) {
  // A diagonal map: input direction = ray / scale.
  double largest = -1.0;
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
    const auto normal = hull.normal(FacetId{id});
    const auto vertex = set.row(hull.vertices_of(FacetId{id}).front().value);
    double height = 0.0, along = 0.0;
    for (std::size_t k = 0; k < frame.dimension; ++k) {
      height += normal[k] * (vertex[k] - frame.centre[k]);
      along += normal[k] * ray[k] / frame.map[k * frame.dimension + k];
    }
    largest = std::max(largest, along / height);
  }
  return largest;
}

TEST(RayShootingOracle, EndsOnTheFacetThatTheRayLeavesThrough) {
  for (const PointFamily family :
       {PointFamily::kSphere, PointFamily::kGaussian, PointFamily::kCube, PointFamily::kCubeSurface,
        PointFamily::kCubeCorners, PointFamily::kLattice, PointFamily::kCrossPolytope}) {
    for (std::size_t d = 2; d <= 6; ++d) {
      SCOPED_TRACE(std::string(to_string(family)) + " " + std::to_string(d));
      const std::size_t n = family == PointFamily::kLattice ? std::size_t{1} << d : 60;
      const PointSet set = family_points(family, n, d, 11);
      const Hull hull = hull_of(set);
      if (hull.rank < d) continue;
      RayShooter shooter(set.view());
      ASSERT_TRUE(shooter.frame().is_diagonal);
      const std::vector<WalkTask> rays = random_rays(d, 100, d);
      const std::vector<WalkResult> walks = shooter.walk(rays);
      for (std::size_t row = 0; row < rays.size(); ++row) {
        ASSERT_EQ(walks[row].end, WalkEnd::kFacet);
        const double expected = exit_value(hull, set, shooter.frame(), rays[row].direction);
        EXPECT_NEAR(walks[row].gauge / expected, 1.0, 1e-10);
      }
    }
  }
}

TEST(RayShootingOracle, FindsTheNeighboursOfTheHull) {
  const PointSet set = family_points(PointFamily::kGaussian, 80, 5, 3);
  const Hull hull = hull_of(set);
  const std::vector<VertexSet> facets = facet_sets(hull);
  RayShooter shooter(set.view());
  std::vector<WalkTask> tasks;
  std::vector<VertexSet> expected;
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
    const auto vertices = hull.vertices_of(FacetId{id});
    for (std::size_t place = 0; place < 5; ++place) {
      WalkTask task;
      for (const PointId vertex : vertices) task.basis.push_back(vertex.value);
      task.place = place;
      tasks.push_back(task);
      VertexSet neighbour;
      for (const PointId vertex : hull.vertices_of(hull.neighbours_of(FacetId{id})[place])) {
        neighbour.push_back(vertex.value);
      }
      std::sort(neighbour.begin(), neighbour.end());
      expected.push_back(neighbour);
    }
  }
  const std::vector<WalkResult> walks = shooter.walk(tasks);
  for (std::size_t row = 0; row < tasks.size(); ++row) {
    ASSERT_EQ(walks[row].end, WalkEnd::kFacet);
    EXPECT_EQ(walks[row].on_plane, expected[row]);
  }
}

TEST(RayShootingLaw, ClosesEveryWalkOnDegenerateInputs) {
  for (std::size_t d = 2; d <= 6; ++d) {
    for (const DegenerateCase& input : degenerate_cases(60, d, d)) {
      SCOPED_TRACE(input.description + ", d " + std::to_string(d));
      RayShooter shooter(input.points.view());
      const std::size_t rank = shooter.frame().rank;
      if (rank < 2) continue;
      const std::vector<WalkTask> rays = random_rays(rank, 50, d);
      for (const WalkResult& walk : shooter.walk(rays)) {
        ASSERT_EQ(walk.end, WalkEnd::kFacet);
        EXPECT_GE(walk.on_plane.size(), rank);
        const Eigen::Map<const Eigen::VectorXd> plane(walk.plane.data(), static_cast<Eigen::Index>(rank));
        for (std::uint32_t id = 0; id < shooter.point_count(); ++id) {
          EXPECT_LE(plane.dot(shooter.points().point(id)), 1.0 + walk.coplanar);
        }
      }
    }
  }
}

TEST(RayShootingLaw, DoesNotDependOnTheThreads) {
  const PointSet set = family_points(PointFamily::kGaussian, 20000, 7, 9);
  std::vector<std::vector<WalkResult>> results;
  for (const std::size_t threads : {1U, 3U}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    RayShooter shooter(set.view());
    results.push_back(shooter.walk(random_rays(7, 700, 2)));
  }
  for (std::size_t row = 0; row < results[0].size(); ++row) {
    EXPECT_EQ(results[0][row].basis, results[1][row].basis);
    EXPECT_EQ(results[0][row].plane, results[1][row].plane);
  }
}

TEST(RayShootingExample, MeetsEqualPointsOnce) {
  const PointSet set = with_duplicates(family_points(PointFamily::kSphere, 40, 4, 6), 200, 8);
  RayShooter shooter(set.view());
  EXPECT_EQ(shooter.distinct_count(), 40U);
  for (const WalkResult& walk : shooter.walk(random_rays(4, 100, 1))) {
    ASSERT_EQ(walk.on_plane.size(), 4U);
    EXPECT_LT(walk.on_plane.back(), 40U);
  }
}

/// Walks over the ridges of one facet begin with one inverse when they are taken together.
TEST(RayShootingLaw, WalksThatBeginTogetherEndAsEachAlone) {
  for (const std::size_t rank : {3U, 6U, 20U}) {
    const PointSet set = family_points(PointFamily::kGaussian, 200, rank, rank);
    RayShooter shooter(set.view());
    std::vector<WalkTask> tasks;
    for (const WalkResult& hit : shooter.walk(random_rays(rank, 5, 1))) {
      ASSERT_EQ(hit.end, WalkEnd::kFacet);
      tasks.push_back({.direction = random_rays(rank, 1, tasks.size())[0].direction});
      for (std::size_t place = 0; place < rank; ++place)
        tasks.push_back({.direction = {}, .basis = hit.basis, .place = place});
    }
    const std::vector<WalkResult> together = shooter.walk(tasks);
    for (std::size_t row = 0; row < tasks.size(); ++row) {
      const std::vector<WalkResult> alone = shooter.walk(std::span(tasks).subspan(row, 1));
      EXPECT_EQ(together[row].end, WalkEnd::kFacet);
      EXPECT_EQ(together[row].basis, alone[0].basis);
      EXPECT_EQ(together[row].on_plane, alone[0].on_plane);
      EXPECT_EQ(together[row].plane, alone[0].plane);
      EXPECT_EQ(together[row].determinant, alone[0].determinant);
    }
  }
}

TEST(RayShootingExample, EndsEarlyInsideTheHull) {
  const PointSet set = family_points(PointFamily::kSphere, 100, 5, 6);
  RayShooter shooter(set.view());
  const auto vertex = shooter.points().point(0);
  WalkTask inside{.direction = {vertex.data(), vertex.data() + 5}, .asks_inside = true};
  for (double& x : inside.direction) x *= 0.5;
  WalkTask outside = inside;
  outside.skip = 0;  // of the hull without the point itself
  for (double& x : outside.direction) x *= 2.0;
  const std::vector<WalkTask> tasks = {inside, outside};
  const std::vector<WalkResult> walks = shooter.walk(tasks);
  EXPECT_EQ(walks[0].end, WalkEnd::kInside);
  ASSERT_EQ(walks[1].end, WalkEnd::kOutside);
  EXPECT_GT(walks[1].gauge, walks[1].level);
  const Eigen::Map<const Eigen::VectorXd> plane(walks[1].plane.data(), 5);
  for (std::uint32_t id = 0; id < 100; ++id) {
    EXPECT_EQ(plane.dot(shooter.points().point(id)) > walks[1].level, id == 0);
  }
}

}  // namespace
}  // namespace ndhull
