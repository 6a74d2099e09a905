#include "tests/support/degeneracies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/portable_random.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

PointSet gaussian(std::size_t n, std::size_t d, std::uint64_t seed) {
  return generate_points({.family = PointFamily::kGaussian, .dimension = d, .count = n, .seed = seed});
}

void append(PointSet& set, std::span<const double> row) {
  set.coordinates.insert(set.coordinates.end(), row.begin(), row.end());
}

// Columns that stretch from 1e-8 to 1e8.
std::vector<double> spread_factors(std::size_t d) {
  std::vector<double> factors(d);
  for (std::size_t k = 0; k < d; ++k) factors[k] = k % 3 == 0 ? 1e-8 : k % 3 == 1 ? 1e8 : 1.0;
  return factors;
}

// The largest lattice with at most n points, of side 2 at least.
std::size_t lattice_side(std::size_t n, std::size_t d) {
  std::size_t side = 2;
  while (std::pow(static_cast<double>(side + 1), static_cast<double>(d)) <= static_cast<double>(n)) ++side;
  return side;
}

}  // namespace

// Gram-Schmidt on a normal matrix; the second pass removes what cancellation left in the first (Giraud,
// Langou, Rozloznik. The loss of orthogonality in the Gram-Schmidt process. Comput. Math. Appl. 50, 2005).
std::vector<double> random_orthogonal(std::size_t d, std::uint64_t seed) {
  PointSet rows = gaussian(d, d, seed);
  for (std::size_t i = 0; i < d; ++i) {
    const std::span<double> row = rows.row(i);
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::span<const double> done = rows.row(j);
        const double along = std::inner_product(row.begin(), row.end(), done.begin(), 0.0);
        for (std::size_t k = 0; k < d; ++k) row[k] -= along * done[k];
      }
      const double norm = std::sqrt(std::inner_product(row.begin(), row.end(), row.begin(), 0.0));
      NDHULL_CHECK(norm > 0.0);
      for (double& value : row) value /= norm;
    }
  }
  return rows.coordinates;
}

PointSet multiplied(const PointSet& set, std::span<const double> matrix, std::size_t columns) {
  NDHULL_CHECK(matrix.size() == set.dimension * columns);
  PointSet result{columns, std::vector<double>(set.rows() * columns, 0.0), set.header};
  for (std::size_t i = 0; i < set.rows(); ++i) {
    const std::span<double> row = result.row(i);
    for (std::size_t j = 0; j < set.dimension; ++j) {
      for (std::size_t k = 0; k < columns; ++k) row[k] += set.row(i)[j] * matrix[j * columns + k];
    }
  }
  return result;
}

PointSet rotated(const PointSet& set, std::uint64_t seed) {
  return multiplied(set, random_orthogonal(set.dimension, seed), set.dimension);
}

PointSet embedded(const PointSet& set, std::size_t dimension, std::uint64_t seed) {
  NDHULL_CHECK(dimension >= set.dimension);
  const std::vector<double> basis = random_orthogonal(dimension, seed);
  return multiplied(set, std::span(basis).first(set.dimension * dimension), dimension);
}

PointSet moved(const PointSet& set, std::span<const double> offset) {
  NDHULL_CHECK(offset.size() == set.dimension);
  PointSet result = set;
  for (std::size_t k = 0; k < result.coordinates.size(); ++k)
    result.coordinates[k] += offset[k % set.dimension];
  return result;
}

PointSet axis_scaled(const PointSet& set, std::span<const double> factors) {
  NDHULL_CHECK(factors.size() == set.dimension);
  PointSet result = set;
  for (std::size_t k = 0; k < result.coordinates.size(); ++k)
    result.coordinates[k] *= factors[k % set.dimension];
  return result;
}

PointSet mirrored(const PointSet& set, std::size_t column) {
  NDHULL_CHECK(column < set.dimension);
  PointSet result = set;
  for (std::size_t i = 0; i < set.rows(); ++i) result.row(i)[column] = -result.row(i)[column];
  return result;
}

PointSet with_mirror_images(const PointSet& set, std::size_t column) {
  PointSet result = set;
  append(result, mirrored(set, column).coordinates);
  return result;
}

PointSet permuted_rows(const PointSet& set, std::uint64_t seed, std::vector<std::size_t>* old_of_new) {
  PortableRandom random(seed);
  std::vector<std::size_t> order(set.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random.below(k)]);
  PointSet result{set.dimension, {}, set.header};
  result.coordinates.reserve(set.coordinates.size());
  for (const std::size_t row : order) append(result, set.row(row));
  if (old_of_new != nullptr) *old_of_new = std::move(order);
  return result;
}

PointSet with_duplicates(const PointSet& set, std::size_t count, std::uint64_t seed) {
  NDHULL_CHECK(set.rows() > 0);
  PortableRandom random(seed);
  PointSet result = set;
  for (std::size_t k = 0; k < count; ++k) append(result, set.row(random.below(set.rows())));
  return result;
}

PointSet with_interior_points(const PointSet& set, std::size_t count, std::uint64_t seed) {
  NDHULL_CHECK(set.rows() > 0);
  PortableRandom random(seed);
  PointSet result = set;
  std::vector<double> weights(set.rows());
  for (std::size_t i = 0; i < count; ++i) {
    // Weights above 1/2 before they are normalised keep the point away from every facet.
    for (double& weight : weights) weight = 0.5 + 0.5 * random.unit();
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> point(set.dimension, 0.0);
    for (std::size_t row = 0; row < set.rows(); ++row) {
      for (std::size_t k = 0; k < set.dimension; ++k) point[k] += weights[row] / sum * set.row(row)[k];
    }
    append(result, point);
  }
  return result;
}

PointSet product(const PointSet& left, const PointSet& right) {
  PointSet set;
  set.dimension = left.dimension + right.dimension;
  const auto add = [&](const PointSet& from, std::size_t row) {
    const auto first = from.coordinates.begin() + static_cast<std::ptrdiff_t>(row * from.dimension);
    set.coordinates.insert(set.coordinates.end(), first, first + static_cast<std::ptrdiff_t>(from.dimension));
  };
  for (std::size_t i = 0; i < left.rows(); ++i) {
    for (std::size_t j = 0; j < right.rows(); ++j) {
      add(left, i);
      add(right, j);
    }
  }
  return set;
}

PointSet moved_by_one_ulp(const PointSet& set, std::uint64_t seed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  PortableRandom random(seed);
  PointSet result = set;
  for (double& value : result.coordinates) {
    const std::size_t way = random.below(3);
    if (way != 0) value = std::nextafter(value, way == 1 ? kInfinity : -kInfinity);
  }
  return result;
}

PointSet slab(std::size_t n, std::size_t d, double thickness, std::uint64_t seed) {
  NDHULL_CHECK(d >= 1);
  std::vector<double> factors(d, 1.0);
  factors.back() = thickness / 2;
  return axis_scaled(
      generate_points({.family = PointFamily::kCube, .dimension = d, .count = n, .seed = seed}), factors);
}

PointSet co_flat(std::size_t n, std::size_t d, std::size_t k, std::uint64_t seed) {
  NDHULL_CHECK(k <= d);
  PointSet result = gaussian(n, d, seed);
  const std::vector<double> basis = random_orthogonal(d, seed + 1);
  const PointSet base = gaussian(1, d, seed + 2);
  PointSet flat = gaussian(n, d, seed + 3);
  for (std::size_t i = 0; i < n; ++i) std::fill_n(flat.row(i).begin(), k, 0.0);
  flat = moved(multiplied(flat, basis, d), base.row(0));
  for (std::size_t i = 0; i < n; i += 2) std::copy_n(flat.row(i).begin(), d, result.row(i).begin());
  return result;
}

std::vector<DegenerateCase> degenerate_cases(std::size_t n, std::size_t d, std::uint64_t seed) {
  NDHULL_CHECK(d >= 2 && n >= 2);
  std::vector<DegenerateCase> cases;
  const auto add = [&](const std::string& what, PointSet points) {
    const std::string description =
        what + ", n " + std::to_string(n) + ", d " + std::to_string(d) + ", seed " + std::to_string(seed);
    points.header = description;
    cases.push_back({description, std::move(points)});
  };
  const PointSet normal = gaussian(n, d, seed);
  const PointSet lattice = generate_points(
      {.family = PointFamily::kLattice, .dimension = d, .count = 0, .side = lattice_side(n, d)});
  const PointSet sphere =
      generate_points({.family = PointFamily::kSphere, .dimension = d, .count = n, .seed = seed});

  add("duplicate", with_duplicates(gaussian((n + 1) / 2, d, seed), n / 2, seed));
  add("collinear", co_flat(n, d, d - 1, seed));
  add("co-flat", co_flat(n, d, 1, seed));
  add("lattice", lattice);
  add("lattice, one ulp off", moved_by_one_ulp(lattice, seed));
  add("lattice, rotated", rotated(lattice, seed));
  add("cospherical", sphere);
  add("cospherical with mirror images", with_mirror_images(sphere, 0));
  add("slab of 1e-14", slab(n, d, 1e-14, seed));
  add("axes stretched by 1e-8 and 1e8", axis_scaled(normal, spread_factors(d)));
  add("far from the origin", moved(normal, std::vector<double>(d, 1e8)));
  add("flat", embedded(gaussian(n, d - 1, seed), d, seed));
  PortableRandom random(seed);
  PointSet integers{d, std::vector<double>(n * d), {}};
  for (double& value : integers.coordinates) value = static_cast<double>(random.below(4));
  add("small integers", std::move(integers));
  return cases;
}

}  // namespace ndhull
