// Which simplices facets are made of, with what is to be true of all partitions.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "approx/slabs/dual_facets.h"
#include "core/ids.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {

/// The simplices of each facet: all live ones, each in one, those of a facet connected.
inline std::vector<std::vector<std::uint32_t>> members_of(const GrownSphere& sphere,
                                                          const DualFacets& facets) {
  std::vector<std::vector<std::uint32_t>> members(facets.count());
  const std::vector<std::uint32_t> facet_of = facets.facet_of_rows();
  for (std::uint32_t row = 0; row < sphere.work.complex.row_count; ++row) {
    const std::uint32_t facet = facet_of[row];
    EXPECT_EQ(facet != kNone, sphere.is_live(row));
    if (facet < members.size()) members[facet].push_back(row);
  }
  for (std::uint32_t facet = 0; facet < facets.count(); ++facet) {
    EXPECT_EQ(facets.members_of(facet).front().value, facets.seeds[facet]);
    std::vector<std::uint32_t> met{facets.seeds[facet]};
    for (std::size_t i = 0; i < met.size(); ++i) {
      for (const SimplexId neighbour : sphere.work.complex.neighbours(SimplexId{met[i]})) {
        if (facet_of[neighbour.value] == facet &&
            std::find(met.begin(), met.end(), neighbour.value) == met.end())
          met.push_back(neighbour.value);
      }
    }
    std::sort(met.begin(), met.end());
    EXPECT_EQ(met, members[facet]);
  }
  return members;
}

}  // namespace ndhull
