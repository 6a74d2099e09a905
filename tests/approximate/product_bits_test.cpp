// Products in single precision, beside extended precision.
#include "approx/slabs/product_bits_kernel.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace ndhull {
namespace {

// Limits at products themselves, a little beside them, and far from all.
TEST(ProductBits, AreThoseOfExactProductsWhereTheyAreKnown) {
  constexpr std::size_t kPoints = 50, kPlanes = 150;  // more than one of the kernel's blocks
  for (std::size_t rank = 2; rank <= 16; ++rank) {
    std::mt19937 random(static_cast<unsigned>(rank));
    std::normal_distribution<double> normal;
    std::vector<double> coordinates(kPoints * rank), planes(kPlanes * rank + 8);
    for (double& entry : coordinates) entry = normal(random);
    for (double& entry : planes) entry = normal(random);
    const auto product = [&](std::size_t plane, std::size_t point) {
      long double sum = 0.0L;
      for (std::size_t k = 0; k < rank; ++k)
        sum += static_cast<long double>(planes[plane * rank + k]) * coordinates[point * rank + k];
      return sum;
    };
    std::vector<std::uint32_t> ids(kPlanes * rank);
    for (std::uint32_t& id : ids) id = static_cast<std::uint32_t>(random() % kPoints);
    std::vector<double> least;
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      const auto of_first = static_cast<double>(product(plane, ids[plane * rank]));
      const double beside[] = {0.0, 1e-8, -1e-8, 1e-3, -1e-3, 1e30};
      least.push_back(of_first + beside[plane % 6]);
    }
    std::vector<ProductBits> bits(kPlanes);
    compare_products(FloatPoints(rank, coordinates), planes.data(), ids.data(), least, bits);
    std::size_t unknown = 0;
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      EXPECT_EQ(bits[plane].at_least & bits[plane].unknown, 0);
      EXPECT_EQ((bits[plane].at_least | bits[plane].unknown) >> rank, 0);
      for (std::size_t k = 0; k < rank; ++k) {
        if ((bits[plane].unknown >> k & 1) != 0) {
          ++unknown;
          continue;
        }
        EXPECT_EQ((bits[plane].at_least >> k & 1) != 0, product(plane, ids[plane * rank + k]) >= least[plane])
            << rank << "-d, plane " << plane;
      }
    }
    EXPECT_GT(unknown, kPlanes / 6);  // those whose limit is a product
    EXPECT_LT(unknown, kPlanes * rank / 2 + kPlanes / 2);
  }
}

}  // namespace
}  // namespace ndhull
