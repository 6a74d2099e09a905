// Determinants that come from neighbours, beside those that are solved.
#include "core/determinants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "approx/exact_facets.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

bool chain(const GrownSphere& sphere, std::vector<double>& determinants) {
  determinants.assign(sphere.work.complex.row_count, NAN);
  return chain_determinants(sphere.work.complex, sphere.coordinates.data(), sphere.work.point_count,
                            determinants);
}

// The last has more points than 16 bits can tell.
TEST(Determinants, OfNeighboursAreThoseThatAreSolved) {
  int free_rows = 0;
  for (const char* words : {"40 s D2 t1", "200 s D3 t1", "300 s D4 t1", "400 s D5 t1", "150 s D6 t1",
                            "100 s D7 t1", "60 s D8 t1", "40 s D9 t1", "70000 s D3 t1"}) {
    SCOPED_TRACE(words);
    GrownSphere sphere(words, static_cast<std::uint32_t>(std::atoi(words)));
    std::vector<double> chained, solved(sphere.work.complex.row_count);
    EXPECT_TRUE(chain(sphere, chained));
    solve_simplices(sphere.work.complex, sphere.coordinates.data(), {}, solved);
    double sum = 0.0, solved_sum = 0.0;
    for (std::uint32_t row = 0; row < solved.size(); ++row) {
      if (!sphere.is_live(row)) {
        EXPECT_EQ(chained[row], 0.0);
        ++free_rows;
        continue;
      }
      sum += chained[row];
      solved_sum += solved[row];
      EXPECT_NEAR(chained[row] / solved[row], 1.0, 1e-10);
    }
    EXPECT_NEAR(sum / solved_sum, 1.0, 1e-13);
  }
  EXPECT_GT(free_rows, 0);
}

TEST(Determinants, PlanesThatHaveLostDigitsAreTold) {
  GrownSphere sphere("150 s D6 t1", 150);
  std::vector<double> determinants;
  for (std::uint32_t row = 0; row < sphere.work.complex.row_count; row += 100)
    sphere.work.complex.planes[row * sphere.work.rank] *= 1.0 + 1e-6;
  EXPECT_FALSE(chain(sphere, determinants));
  std::vector<double> outwards(determinants.size()), solved(determinants.size());
  chain_outwards(sphere.work.complex, sphere.coordinates.data(), sphere.work.point_count, outwards);
  solve_outwards(sphere.work.complex, sphere.coordinates.data(), {}, solved);
  EXPECT_EQ(outwards, solved);
}

}  // namespace
}  // namespace ndhull
