// Determinants of simplices whose planes are known, beside those that are solved.
#include "core/complex/determinants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
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

TEST(Determinants, PlanesOfSimplicesWithoutAComplexAreThoseOfGrowth) {
  for (const char* words : {"200 s D3 t1", "150 s D6 t1", "60 s D8 t1", "30 s D13 t1"}) {
    SCOPED_TRACE(words);
    GrownSphere sphere(words, static_cast<std::uint32_t>(std::atoi(words)));
    SimplicialComplex& complex = sphere.work.complex;
    const std::size_t rank = complex.rank;
    std::vector<double> in_complex(complex.row_count);
    solve_simplices(complex, sphere.coordinates.data(), {}, in_complex);
    std::vector<std::uint32_t> vertices, rows;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      if (!sphere.is_live(row)) continue;
      rows.push_back(row);
      for (const PointId id : complex.vertices(SimplexId{row})) vertices.push_back(id.value);
    }
    std::vector<double> planes(rows.size() * rank), determinants(rows.size());
    solve_planes(rank, sphere.coordinates.data(), vertices, planes, determinants);
    std::vector<double> alone(rank), of_one(1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_NEAR(determinants[i] / in_complex[rows[i]], 1.0, 1e-10);
      for (std::size_t k = 0; k < rank; ++k)
        EXPECT_NEAR(planes[i * rank + k], complex.plane(SimplexId{rows[i]})[k], 1e-9);
      solve_planes(rank, sphere.coordinates.data(), std::span(vertices).subspan(i * rank, rank), alone,
                   of_one);
      EXPECT_EQ(of_one[0], determinants[i]);
      EXPECT_TRUE(
          std::equal(alone.begin(), alone.end(), planes.begin() + static_cast<std::ptrdiff_t>(i * rank)));
    }
  }
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
