// Determinants of simplices whose planes are known, beside those that are solved.
#include "core/complex/determinants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "approx/facets/exact_facets.h"
#include "tests/approximate/grown_sphere.h"

namespace ndhull {
namespace {

constexpr auto nothing = [](std::size_t, std::size_t) {};

bool find(const GrownSphere& sphere, std::vector<double>& determinants) {
  determinants.assign(sphere.work.complex.row_count, NAN);
  return find_determinants(sphere.work.complex, sphere.coordinates.data(), determinants, nothing);
}

TEST(Determinants, AreThoseThatAreSolved) {
  int free_rows = 0;
  for (const char* words : {"40 s D2 t1", "200 s D3 t1", "300 s D4 t1", "400 s D5 t1", "150 s D6 t1",
                            "100 s D7 t1", "60 s D8 t1", "40 s D9 t1", "30 s D13 t1"}) {
    SCOPED_TRACE(words);
    GrownSphere sphere(words, static_cast<std::uint32_t>(std::atoi(words)));
    std::vector<double> found, solved(sphere.work.complex.row_count);
    EXPECT_TRUE(find(sphere, found));
    solve_simplices(sphere.work.complex, sphere.coordinates.data(), {}, solved);
    double sum = 0.0, solved_sum = 0.0;
    for (std::uint32_t row = 0; row < solved.size(); ++row) {
      if (!sphere.is_live(row)) {
        EXPECT_EQ(found[row], 0.0);
        ++free_rows;
        continue;
      }
      sum += found[row];
      solved_sum += solved[row];
      EXPECT_NEAR(found[row] / solved[row], 1.0, 1e-10);
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
  EXPECT_FALSE(find(sphere, determinants));
  std::vector<double> outwards(determinants.size()), solved(determinants.size());
  find_outwards(sphere.work.complex, sphere.coordinates.data(), outwards);
  solve_outwards(sphere.work.complex, sphere.coordinates.data(), {}, solved);
  EXPECT_EQ(outwards, solved);
}

}  // namespace
}  // namespace ndhull
