// Stars beside the complex that growth makes of the same points, and searches among rows beside plain loops.
#include "core/growth/vertex_stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <vector>

#include "core/growth/growth.h"
#include "tests/prepared_growth.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

using Row = std::vector<std::uint32_t>;

/// Points of a sphere about 0, each of which is its own normal, and the simplices that growth makes of them.
struct Sphere {
  explicit Sphere(const char* words) : set(rbox(words)), rank(set.dimension) {
    std::vector<double> coordinates;
    GrowthWork work;
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    start_growth(work, frame.simplex, FirstPoints());
    grow(work);
    for (std::uint32_t row = 0; row < work.complex.row_count; ++row) {
      if (work.complex.state[row] != SimplexState::kLive) continue;
      Row ids;
      for (const PointId id : work.complex.vertices(SimplexId{row})) ids.push_back(id.value);
      std::sort(ids.begin(), ids.end());
      simplices.insert(ids);
    }
  }
  std::optional<SimplexRows> stars(const StarOptions& options = {}) const {
    return grow_stars(rank, set.coordinates, set.coordinates, options);
  }

  PointSet set;
  std::size_t rank;
  std::set<Row> simplices;
};

Row row_of(const SimplexRows& rows, std::uint32_t row) {
  Row ids(rows.rank());
  rows.vertices_of(row, ids.data());
  return ids;
}

TEST(VertexStars, HaveTheSimplicesOfGrowth) {
  for (const char* words : {"50 s D3", "200 s D4", "300 s D5", "80 s D6", "50 s D7", "30 s D8", "16 s D9"}) {
    SCOPED_TRACE(words);
    const Sphere sphere(words);
    const std::optional<SimplexRows> rows = sphere.stars();
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->count(), sphere.simplices.size());
    Row last;
    for (std::uint32_t row = 0; row < rows->count(); ++row) {
      const Row ids = row_of(*rows, row);
      EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
      EXPECT_LT(last, ids);
      EXPECT_TRUE(sphere.simplices.contains(ids));
      last = ids;
    }
  }
}

TEST(VertexStars, AreGivenUpWhenAsked) {
  const Sphere sphere("200 s D5");
  EXPECT_TRUE(sphere.stars({.most_rows = sphere.simplices.size()}));
  EXPECT_FALSE(sphere.stars({.most_rows = sphere.simplices.size() - 1}));
  std::atomic<std::size_t> most = 0;  // any thread asks
  EXPECT_FALSE(sphere.stars({.gives_up = [&](std::size_t stars, std::uint64_t simplices) {
    for (std::size_t before = most; stars > before && !most.compare_exchange_weak(before, stars);) {
    }
    return simplices > sphere.simplices.size() / 2;
  }}));
  EXPECT_GT(most, 0U);
  EXPECT_LT(most, 200U);
}

// A point inside has no star, and a normal along which another point is further is none.
TEST(VertexStars, AreNotMadeUp) {
  Sphere sphere("60 s D5");
  std::vector<double> normals = sphere.set.coordinates;
  for (std::size_t k = 0; k < 5; ++k) normals[7 * 5 + k] = -normals[7 * 5 + k];
  EXPECT_FALSE(grow_stars(5, sphere.set.coordinates, normals, {}));
  for (std::size_t k = 0; k < 5; ++k) sphere.set.coordinates[7 * 5 + k] *= 0.01;
  EXPECT_FALSE(sphere.stars());
}

TEST(SimplexRows, FindThoseWithinSomeVertices) {
  const Sphere sphere("80 s D6");
  const std::optional<SimplexRows> rows = sphere.stars();
  ASSERT_TRUE(rows);
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    // The vertices of every few rows together: some simplices are within them, most others are not.
    std::set<std::uint32_t> among;
    for (std::uint32_t i = 0; i < 3; ++i)
      for (const std::uint32_t id :
           row_of(*rows, static_cast<std::uint32_t>((seed * 97 + i) % rows->count())))
        among.insert(id);
    std::vector<std::uint8_t> is_among(rows->vertex_count());
    for (const std::uint32_t id : among) is_among[id] = 1;
    std::vector<std::uint32_t> expected, found;
    for (std::uint32_t row = 0; row < rows->count(); ++row) {
      const Row ids = row_of(*rows, row);
      if (std::all_of(ids.begin(), ids.end(), [&](std::uint32_t id) { return among.contains(id); }))
        expected.push_back(row);
    }
    const Row vertices(among.begin(), among.end());
    rows->for_each_within(vertices, is_among.data(), [&](std::uint32_t row) { found.push_back(row); });
    EXPECT_EQ(found, expected);
    EXPECT_GE(found.size(), 1U);
  }
}

}  // namespace
}  // namespace ndhull
