// A complex to cover.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "approx/slabs/covering.h"
#include "approx/slabs/width_space.h"
#include "core/growth/growth.h"
#include "tests/hull/hull_support.h"
#include "tests/prepared_growth.h"
#include "tools/points/rbox.h"

namespace ndhull {

/// A complex in a frame whose coordinates are taken for distances.
struct FramedGrowth {
  bool is_live(std::uint32_t row) const { return work.complex.state[row] == SimplexState::kLive; }
  double product(const std::vector<double>& normal, std::uint32_t point) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < work.rank; ++k) sum += normal[k] * coordinates[point * work.rank + k];
    return sum;
  }
  double height(const std::vector<double>& normal) const {
    double highest = -HUGE_VAL;
    for (std::uint32_t id = 0; id < work.point_count; ++id) highest = std::max(highest, product(normal, id));
    return highest;
  }

  std::vector<double> coordinates;
  GrowthWork work;
  std::optional<WidthSpace> space;
};

/// The hull of points of a sphere.
struct GrownSphere : FramedGrowth {
  GrownSphere(const char* rbox_words, std::uint32_t vertex_count) : set(rbox(rbox_words)) {
    const Frame frame = prepare_growth(set.view(), coordinates, work);
    const std::size_t rank = frame.rank;
    start_growth(work, frame.simplex, FirstPoints());
    grow(work);
    std::vector<double> identity(rank * rank, 0.0);
    for (std::size_t k = 0; k < rank; ++k) identity[k * rank + k] = 1.0;
    std::vector<PointId> vertices;
    for (std::uint32_t id = 0; id < work.point_count; ++id) vertices.push_back(PointId{id});
    EXPECT_EQ(vertices.size(), vertex_count);
    space.emplace(rank, identity, coordinates.data(), work.point_count, vertices, std::vector<PointId>{});
  }

  PointSet set;
};

/// Of each facet the largest depth of a vertex of the facet's simplices below the furthest point along its
/// normal.
inline std::vector<double> facet_widths(const GrownSphere& sphere, const Covering& covering) {
  std::vector<double> lows(covering.planes.size(), HUGE_VAL), result;
  for (std::uint32_t row = 0; row < sphere.work.complex.row_count; ++row) {
    const std::uint32_t facet = covering.facet_of[row];
    EXPECT_EQ(sphere.is_live(row), facet != kNone);
    if (!sphere.is_live(row) || facet >= covering.planes.size()) continue;
    for (const PointId id : sphere.work.complex.vertices(SimplexId{row}))
      lows[facet] = std::min(lows[facet], sphere.product(covering.planes[facet].normal, id.value));
  }
  for (std::size_t facet = 0; facet < lows.size(); ++facet) {
    EXPECT_LT(lows[facet], HUGE_VAL) << "a facet without a simplex";
    result.push_back(sphere.height(covering.planes[facet].normal) - lows[facet]);
  }
  return result;
}

}  // namespace ndhull
