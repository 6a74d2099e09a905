// Coverings by slabs: each simplex in one facet, none of them deeper below its plane than the width, seen
// from all points by plain loops.
#include "approx/slabs/slab_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

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
      for (const double found : facet_widths(sphere, covering)) EXPECT_LE(found, width * (1.0 + 1e-12));
      EXPECT_LT(covering.planes.size(), last);
      if (searches) last = covering.planes.size();
    }
  }
}

TEST(SlabCoverLaw, ACoveringOfFarTooManyFacetsIsGivenUp) {
  const GrownSphere sphere("400 s D5 t1", 400);
  SlabCover cover(sphere.work.complex, *sphere.space, true);
  const CoverEffort effort{.final_fit_steps = 0};
  const std::size_t all = cover.cover(0.02, effort).planes.size();
  EXPECT_EQ(cover.cover(0.02, effort, all).planes.size(), all);
  EXPECT_TRUE(cover.cover(0.02, effort, all / 8).planes.empty());
  EXPECT_GT(cover.expected_facets(), static_cast<double>(all) / 4.0);
  EXPECT_LT(cover.expected_facets(), static_cast<double>(all) * 4.0);
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
          EXPECT_EQ(seeds.hits()[row], 255);  // takes no part
      }
    }
    EXPECT_GT(slabs, sphere.work.complex.row_count / members);
  }
}

}  // namespace
}  // namespace ndhull
