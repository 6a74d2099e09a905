// Coverings by slabs: each simplex in one facet, none of them deeper below its plane than the width, seen
// from all points by plain loops.
#include "approx/slab_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/frame.h"
#include "core/growth.h"
#include "tests/hull/hull_support.h"
#include "tools/rbox.h"

namespace ndhull {
namespace {

/// The hull of points of a sphere, grown in a frame whose coordinates are taken for distances.
struct GrownSphere {
  GrownSphere(const char* rbox_words, std::uint32_t vertex_count) : set(rbox(rbox_words)) {
    const Frame frame = fit_frame(set.view());
    const std::size_t rank = frame.rank;
    coordinates.resize(set.view().rows * rank + 8);
    map_points(set.view(), frame, coordinates.data());
    work.rank = rank;
    work.point_count = set.view().rows;
    work.points = coordinates.data();
    start_growth(work, frame.simplex, FirstPoints());
    grow(work);
    std::vector<double> identity(rank * rank, 0.0);
    for (std::size_t k = 0; k < rank; ++k) identity[k * rank + k] = 1.0;
    std::vector<PointId> vertices;
    for (std::uint32_t id = 0; id < work.point_count; ++id) vertices.push_back(PointId{id});
    EXPECT_EQ(vertices.size(), vertex_count);
    space.emplace(rank, identity, coordinates.data(), work.point_count, vertices, std::vector<PointId>{});
  }
  bool is_live(std::uint32_t row) const { return work.complex.state[row] == SimplexState::kLive; }
  double product(const std::vector<double>& normal, std::uint32_t point) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < work.rank; ++k) sum += normal[k] * coordinates[point * work.rank + k];
    return sum;
  }

  PointSet set;
  std::vector<double> coordinates;
  GrowthWork work;
  std::optional<WidthSpace> space;
};

/// The largest depth of a vertex of the facet's simplices below the furthest point along its normal.
std::vector<double> widths(const GrownSphere& sphere, const Covering& covering) {
  std::vector<double> lows(covering.planes.size(), HUGE_VAL), result;
  for (std::uint32_t row = 0; row < sphere.work.complex.row_count; ++row) {
    const std::uint32_t facet = covering.facet_of[row];
    EXPECT_EQ(sphere.is_live(row), facet != kNone);
    if (!sphere.is_live(row) || facet >= covering.planes.size()) continue;
    for (const PointId id : sphere.work.complex.vertices(SimplexId{row}))
      lows[facet] = std::min(lows[facet], sphere.product(covering.planes[facet].normal, id.value));
  }
  for (std::size_t facet = 0; facet < lows.size(); ++facet) {
    double height = -HUGE_VAL;
    for (std::uint32_t id = 0; id < sphere.work.point_count; ++id)
      height = std::max(height, sphere.product(covering.planes[facet].normal, id));
    EXPECT_LT(lows[facet], HUGE_VAL) << "a facet without a simplex";
    result.push_back(height - lows[facet]);
  }
  return result;
}

TEST(SlabCoverLaw, EachSimplexIsInOneFacetNoWiderThanAsked) {
  const GrownSphere sphere("400 s D5 t1", 400);
  std::size_t last = SIZE_MAX;
  for (const double width :
       {0.02, 0.1, 0.3, 0.6}) {  // most slabs small, none turned; to all large and turned
    for (const bool searches : {false, true}) {
      SlabCover cover(sphere.work.complex, *sphere.space, true);
      CoverEffort effort{.final_fit_steps = 0};
      if (searches) effort = CoverEffort{.choices = 2, .refits = 2};
      const Covering covering = cover.cover(width, effort);
      for (const double found : widths(sphere, covering)) EXPECT_LE(found, width * (1.0 + 1e-12));
      EXPECT_LT(covering.planes.size(), last);
      if (searches) last = covering.planes.size();
    }
  }
}

TEST(SlabSeedsLaw, BatchesEndWhenNoSimplexIsOpen) {
  const GrownSphere sphere("300 s D4 t2", 300);
  for (const std::size_t members : {1u, 100u, 1000u}) {  // of each slab: its seed and rows behind it
    SlabSeeds seeds(sphere.work.complex, *sphere.space, true);
    std::size_t slabs = 0;
    for (const unsigned round : {1u, 2u}) {
      seeds.open(round);
      for (std::span<const SeedChoice> batch; !(batch = seeds.next_batch()).empty();) {
        std::vector<std::uint32_t> chosen;
        PlaneFitWork work;
        for (const SeedChoice& choice : batch) {
          for (const std::uint32_t seed : choice) EXPECT_LT(seeds.hits()[seed], round);
          chosen.push_back(seeds.best_of(choice, 0.2, work));
          EXPECT_NE(std::find(choice.begin(), choice.end(), chosen.back()), choice.end());
        }
        for (const std::uint32_t seed : chosen) {
          std::vector<std::uint32_t> slab;
          for (std::uint32_t row = seed; row < sphere.work.complex.row_count && slab.size() < members; ++row)
            if (sphere.is_live(row)) slab.push_back(row);
          seeds.add_slab(slab);
          ++slabs;
        }
      }
      for (std::uint32_t row = 0; row < sphere.work.complex.row_count; ++row) {
        if (sphere.is_live(row))
          EXPECT_GE(seeds.hits()[row], round);
        else
          EXPECT_EQ(seeds.hits()[row], 0);
      }
    }
    EXPECT_GT(slabs, sphere.work.complex.row_count / members);
  }
}

}  // namespace
}  // namespace ndhull
