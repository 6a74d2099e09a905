// Coverings by slabs that hold many simplices, seen from all simplices and all points by plain loops.
#include "approx/slabs/wide_cover.h"

#include <gtest/gtest.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "approx/slabs/slab_bits_kernel.h"
#include "approx/slabs/slab_choice.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

TEST(SlabBitsLaw, WhatAllRowsOfAGroupHave) {
  std::mt19937_64 random(1);
  for (const std::size_t slabs : {1u, 64u, 200u, 256u, 257u, 1000u}) {
    const std::size_t words = words_for(slabs), rows = 50, count = 37;
    EXPECT_GE(64 * words, slabs);
    for (const std::size_t size : {1u, 2u, 5u, 9u}) {
      std::vector<std::uint64_t> bits(rows * words), out(count * words);
      for (std::uint64_t& word : bits) word = random() | random();
      std::vector<std::uint16_t> ids(count * size);
      for (std::uint16_t& id : ids) id = static_cast<std::uint16_t>(random() % rows);
      intersect_rows(bits.data(), words, ids.data(), size, count, out.data());
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t w = 0; w < words; ++w) {
          std::uint64_t expected = ~std::uint64_t{0};
          for (std::size_t k = 0; k < size; ++k) expected &= bits[ids[i * size + k] * words + w];
          ASSERT_EQ(out[i * words + w], expected) << slabs << " slabs, " << size << " rows, group " << i;
        }
      }
    }
  }
}

TEST(SlabChoiceLaw, ChosenSlabsHoldAllAndEachIsNeeded) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 50; ++round) {
    const std::size_t rows = 10 + random() % 200, count = 1 + random() % 60;
    std::vector<MemberRange> slabs;
    std::vector<std::uint32_t> members;
    std::vector<std::uint8_t> hits(rows, 0);
    for (std::size_t slab = 0; slab < count; ++slab) {
      const std::size_t begin = members.size(), size = random() % 20;  // some hold nothing
      for (std::uint32_t row = 0; row < rows; ++row) {
        if (random() % rows >= size) continue;
        members.push_back(row);
        ++hits[row];
      }
      slabs.push_back({begin, members.size()});
    }
    const std::vector<std::uint32_t> chosen = choose_slabs(slabs, members, hits);
    std::vector<unsigned> times(rows, 0);
    for (const std::uint32_t slab : chosen)
      for (std::size_t i = slabs[slab].begin; i < slabs[slab].end; ++i) ++times[members[i]];
    for (std::size_t row = 0; row < rows; ++row) EXPECT_EQ(times[row] > 0, hits[row] > 0);
    for (const std::uint32_t slab : chosen) {
      bool is_needed = false;
      for (std::size_t i = slabs[slab].begin; i < slabs[slab].end; ++i)
        is_needed = is_needed || times[members[i]] == 1;
      EXPECT_TRUE(is_needed);
    }
  }
}

/// How far the simplex reaches below the plane's height over all points.
double depth_below(const GrownSphere& sphere, const FittedPlane& plane, std::uint32_t row) {
  double low = HUGE_VAL;
  for (const PointId id : sphere.work.complex.vertices(SimplexId{row}))
    low = std::min(low, sphere.product(plane.normal, id.value));
  return sphere.height(plane.normal) - low;
}

/// A covering of a sphere's simplices, and what it needs.
struct WideSphere {
  WideSphere(const char* words, std::uint32_t count)
      : sphere(words, count),
        complex(sphere.work.complex),
        grower(complex, *sphere.space, nullptr, true),
        seeds(complex, *sphere.space, true),
        scratch([this] { return SlabScratch(*sphere.space); }),
        wide(complex, *sphere.space, grower, seeds, [this]() -> SlabScratch& { return scratch.local(); }) {}

  GrownSphere sphere;
  const SimplicialComplex& complex;
  SlabGrower grower;
  SlabSeeds seeds;
  tbb::enumerable_thread_specific<SlabScratch> scratch;
  WideCover wide;
};

TEST(WideCoverLaw, EachSimplexIsInAFacetThatHoldsItMostlyTheOneWhereItIsHighest) {
  WideSphere on("700 s D5 t3", 700);
  const GrownSphere& sphere = on.sphere;
  const SimplicialComplex& complex = on.complex;
  EXPECT_FALSE(on.wide.cover(0.01, CoverEffort{}).has_value()) << "few simplices in a slab";
  for (const unsigned choices : {1u, 2u}) {
    const double width = 0.5;
    const std::optional<Covering> covering = on.wide.cover(width, CoverEffort{.choices = choices});
    ASSERT_TRUE(covering.has_value());
    std::vector<float> depth_of(complex.row_count, -1.0f);
    on.wide.find_depths(*covering, depth_of);
    std::size_t rows = 0, lower = 0;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      EXPECT_EQ(sphere.is_live(row), covering->facet_of[row] != kNone);
      if (!sphere.is_live(row)) continue;
      ASSERT_LT(covering->facet_of[row], covering->planes.size());
      const double depth = depth_below(sphere, covering->planes[covering->facet_of[row]], row);
      EXPECT_LE(depth, width);
      EXPECT_GE(depth_of[row], depth) << "the depth of its facet";
      EXPECT_LE(depth_of[row], width);
      if (++rows % 16 != 0) continue;
      double least = HUGE_VAL;
      for (const FittedPlane& plane : covering->planes)
        least = std::min(least, depth_below(sphere, plane, row));
      lower += depth > least + width / 254.0 ? 1u : 0u;
    }
    // The slabs for what the sample did not know of come last, and take nothing from others.
    EXPECT_LT(8 * lower, rows / 16);
  }
}

/// How many of the simplices are connected with the first one of their facet only by way of others.
std::size_t count_cut_off(const SimplicialComplex& complex, const Covering& covering) {
  std::vector<std::uint8_t> is_reached(complex.row_count, 0), is_begun(covering.planes.size(), 0);
  std::size_t cut_off = 0;
  for (std::uint32_t first = 0; first < complex.row_count; ++first) {
    const std::uint32_t facet = covering.facet_of[first];
    if (facet == kNone || is_reached[first] != 0) continue;
    std::vector<std::uint32_t> part{first};
    is_reached[first] = 1;
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const SimplexId neighbour : complex.neighbours(SimplexId{part[i]})) {
        if (covering.facet_of[neighbour.value] != facet || is_reached[neighbour.value] != 0) continue;
        is_reached[neighbour.value] = 1;
        part.push_back(neighbour.value);
      }
    }
    if (is_begun[facet] != 0) cut_off += part.size();
    is_begun[facet] = 1;
  }
  return cut_off;
}

/// Every simplex is in a facet that holds it. Returns how many there are.
std::size_t expect_held(const WideSphere& on, const Covering& covering, double width) {
  std::size_t live = 0;
  for (std::uint32_t row = 0; row < on.complex.row_count; ++row) {
    EXPECT_EQ(on.sphere.is_live(row), covering.facet_of[row] != kNone);
    if (!on.sphere.is_live(row) || covering.facet_of[row] >= covering.planes.size()) continue;
    ++live;
    EXPECT_LE(depth_below(on.sphere, covering.planes[covering.facet_of[row]], row), width);
  }
  return live;
}

TEST(WideCoverLaw, ManyFacetsHangTogether) {
  WideSphere on("300 s D7 t3", 300);
  const double width = 0.3;
  const std::optional<Covering> covering = on.wide.cover(width, CoverEffort{});
  ASSERT_TRUE(covering.has_value());
  EXPECT_GT(covering->planes.size(), 256U);
  EXPECT_FALSE(on.wide.has_strays());
  const std::size_t live = expect_held(on, *covering, width);
  EXPECT_EQ(live, on.seeds.live_count());
  EXPECT_LT(50 * count_cut_off(on.complex, *covering), live);
}

// Passes over what has no facet yet went on for ever once nothing was left.
TEST(WideCoverRegression, EndsWhereNeighboursTakeAllSimplices) {
  WideSphere on("14000 s D3 t3", 14000);
  const double width = 0.0187;
  const std::optional<Covering> covering = on.wide.cover(width, CoverEffort{});
  ASSERT_TRUE(covering.has_value());
  EXPECT_GT(covering->planes.size(), 256U);
  EXPECT_EQ(expect_held(on, *covering, width), on.seeds.live_count());
}

}  // namespace
}  // namespace ndhull
