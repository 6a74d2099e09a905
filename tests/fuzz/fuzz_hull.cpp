// The hull of small integer coordinates: collisions, collinear and coplanar points come for free.
//
// Input: byte 0 is the dimension (2..6) and the options, every further byte is one coordinate (0..9).
// Any broken law is an NDHULL_CHECK, which the fuzzer sees as a crash.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "approx/hull.h"
#include "core/error.h"

namespace {

using ndhull::FacetId;
using ndhull::Hull;
using ndhull::PointId;

constexpr std::size_t kMostPoints = 60;  // 6-d hulls of so many lattice points take milliseconds
constexpr unsigned kCoordinateCount = 10;

// Rounding of the distances computed here: coordinates below 10, at most 6 products, so 100 units in the last
// place are generous; and the rounding of Hull::offset, which is within roundoff.
constexpr double kOwnRoundoff = 1e-12;
// The coordinates are exact integers: nothing may be wider than rounding and a few inward shifts explain.
constexpr double kWidestFacet = 1e-7;

struct Cloud {
  std::size_t dimension = 0;
  std::vector<double> coordinates;
  std::size_t rows() const { return coordinates.size() / dimension; }
  std::span<const double> row(std::size_t index) const {
    return {coordinates.data() + index * dimension, dimension};
  }
};

Cloud read_cloud(const std::uint8_t* data, std::size_t size) {
  Cloud cloud;
  cloud.dimension = 2 + data[0] % 5u;
  const std::size_t rows = std::min((size - 1) / cloud.dimension, kMostPoints);
  for (std::size_t index = 0; index < rows * cloud.dimension; ++index) {
    cloud.coordinates.push_back(static_cast<double>(data[1 + index] % kCoordinateCount));
  }
  return cloud;
}

/// The affine rank, exactly: elimination modulo a prime. Minors are below (9 sqrt 6)^6 < 2^27 (Hadamard), so
/// none that is not zero vanishes modulo 2^31 - 1.
std::size_t affine_rank(const Cloud& cloud) {
  constexpr std::int64_t kPrime = 2147483647;
  const auto power = [](std::int64_t base, std::int64_t exponent) {
    std::int64_t result = 1;
    for (; exponent > 0; exponent /= 2, base = base * base % kPrime) {
      if (exponent % 2 == 1) result = result * base % kPrime;
    }
    return result;
  };
  std::vector<std::vector<std::int64_t>> basis;  // echelon rows, each with a leading 1 at its pivot
  std::vector<std::size_t> pivots;
  for (std::size_t row = 1; row < cloud.rows(); ++row) {
    std::vector<std::int64_t> difference(cloud.dimension);
    for (std::size_t column = 0; column < cloud.dimension; ++column) {
      const auto value = static_cast<std::int64_t>(cloud.row(row)[column] - cloud.row(0)[column]);
      difference[column] = (value + kPrime) % kPrime;
    }
    for (std::size_t index = 0; index < basis.size(); ++index) {
      const std::int64_t factor = difference[pivots[index]];
      for (std::size_t column = 0; column < cloud.dimension; ++column) {
        difference[column] = (difference[column] + (kPrime - factor) * basis[index][column]) % kPrime;
      }
    }
    const auto pivot =
        std::find_if(difference.begin(), difference.end(), [](std::int64_t value) { return value != 0; });
    if (pivot == difference.end()) continue;
    const std::int64_t inverse = power(*pivot, kPrime - 2);
    pivots.push_back(static_cast<std::size_t>(pivot - difference.begin()));
    for (std::int64_t& value : difference) value = value * inverse % kPrime;
    basis.push_back(std::move(difference));
  }
  return basis.size();
}

double distance(const Hull& hull, FacetId facet, std::span<const double> point) {
  double sum = hull.offset(facet);
  const std::span<const double> normal = hull.normal(facet);
  for (std::size_t column = 0; column < point.size(); ++column) sum += normal[column] * point[column];
  return sum;
}

bool contains(std::span<const FacetId> facets, FacetId facet) {
  return std::find(facets.begin(), facets.end(), facet) != facets.end();
}

void check_facet(const Hull& hull, FacetId facet, const Cloud& cloud) {
  const double unit = hull.input_per_length_unit(facet);
  const double slack = kOwnRoundoff + 2 * hull.roundoff * unit;
  double norm_sq = 0.0;
  for (const double value : hull.normal(facet)) norm_sq += value * value;
  NDHULL_CHECK(std::abs(norm_sq - 1.0) < 1e-9);
  NDHULL_CHECK(hull.outer_offset(facet) >= 0.0 && hull.inner_offset(facet) <= 0.0);

  for (std::size_t row = 0; row < cloud.rows(); ++row) {
    NDHULL_CHECK(distance(hull, facet, cloud.row(row)) <= hull.outer_offset(facet) * unit + slack);
  }
  NDHULL_CHECK(distance(hull, facet, hull.interior_point) < 0.0);

  const std::span<const PointId> vertices = hull.vertices_of(facet);
  NDHULL_CHECK(vertices.size() >= hull.rank);
  for (const PointId vertex : vertices) {
    NDHULL_CHECK(std::binary_search(hull.vertices.begin(), hull.vertices.end(), vertex));
    NDHULL_CHECK(distance(hull, facet, cloud.row(vertex.value)) >= hull.inner_offset(facet) * unit - slack);
  }
  const std::span<const FacetId> neighbours = hull.neighbours_of(facet);
  NDHULL_CHECK(neighbours.size() >= hull.rank);
  for (const FacetId neighbour : neighbours) {
    NDHULL_CHECK(neighbour != facet && neighbour.value < hull.facet_count());
    NDHULL_CHECK(contains(hull.neighbours_of(neighbour), facet));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return 0;
  const Cloud cloud = read_cloud(data, size);
  if (cloud.rows() == 0) return 0;
  ndhull::HullOptions options;
  options.triangulate = (data[0] & 0x40u) != 0;
  options.unit_cube = (data[0] & 0x80u) != 0;
  options.threads = 1;
  const Hull hull = ndhull::convex_hull(
      ndhull::PointView::row_major(cloud.coordinates.data(), cloud.rows(), cloud.dimension), options);

  NDHULL_CHECK(hull.status == ndhull::HullStatus::kComplete);
  NDHULL_CHECK(hull.points_outside == 0);
  NDHULL_CHECK(hull.rank == affine_rank(cloud));
  NDHULL_CHECK(std::is_sorted(hull.vertices.begin(), hull.vertices.end()));
  NDHULL_CHECK(hull.vertices.empty() || hull.vertices.back().value < cloud.rows());
  NDHULL_CHECK(hull.max_facet_width <= kWidestFacet);
  if (hull.rank == 0) {
    NDHULL_CHECK(hull.facet_count() == 0);
    return 0;
  }
  NDHULL_CHECK(hull.vertices.size() >= hull.rank + 1 && hull.facet_count() >= hull.rank + 1);
  NDHULL_CHECK(hull.area > 0.0 && hull.volume > 0.0);
  if (hull.rank == 1) {  // two facets, one vertex each
    NDHULL_CHECK(hull.facet_count() == 2 && hull.vertices.size() == 2);
    return 0;
  }
  for (std::uint32_t facet = 0; facet < hull.facet_count(); ++facet) check_facet(hull, FacetId{facet}, cloud);
  return 0;
}
