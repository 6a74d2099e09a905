#include "tests/support/named_polytopes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numeric>

#include "core/error.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

using Sizes = std::initializer_list<std::size_t>;

double factorial(std::size_t n) {
  double product = 1.0;
  for (std::size_t k = 2; k <= n; ++k) product *= static_cast<double>(k);
  return product;
}

std::string name_of(const char* family, Sizes parameters) {
  std::string name = family;
  char separator = '(';
  for (const std::size_t parameter : parameters) {
    name += separator + std::to_string(parameter);
    separator = ',';
  }
  return name + ')';
}

// All of the points are vertices.
NamedPolytope make(std::string name, PointSet points, std::size_t rank, std::uint64_t facets,
                   std::optional<double> volume) {
  points.header = name;
  const std::size_t vertices = points.rows();
  return {std::move(name), std::move(points), rank, facets, vertices, volume};
}

// Calls `take` with every order of 0 .. n-1, in lexicographic order.
template <class Take>
void for_each_order(std::size_t n, Take take) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  do take(order);
  while (std::next_permutation(order.begin(), order.end()));
}

using Row4 = std::array<double, 4>;

bool is_even(const std::vector<std::size_t>& order) {
  std::size_t inversions = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) inversions += order[i] > order[j] ? 1U : 0U;
  }
  return inversions % 2 == 0;
}

// Appends all (or the even) orders of `row` with all signs, each point once.
void add_orbit(const Row4& row, bool even_only, PointSet& set) {
  std::vector<Row4> orbit;
  for_each_order(4, [&](const std::vector<std::size_t>& order) {
    if (even_only && !is_even(order)) return;
    for (unsigned signs = 0; signs < 16; ++signs) {
      Row4 point{};
      for (std::size_t k = 0; k < 4; ++k) {
        const double value = row[order[k]];
        point[k] = value != 0.0 && (signs >> k & 1U) != 0 ? -value : value;
      }
      orbit.push_back(point);
    }
  });
  std::sort(orbit.begin(), orbit.end());
  orbit.erase(std::unique(orbit.begin(), orbit.end()), orbit.end());
  for (const Row4& point : orbit) set.coordinates.insert(set.coordinates.end(), point.begin(), point.end());
}

const double kRoot5 = std::sqrt(5.0);
const double kGolden = (1.0 + kRoot5) / 2.0;

std::uint64_t binomial(std::uint64_t n, std::uint64_t k) {
  std::uint64_t value = 1;
  for (std::uint64_t i = 1; i <= k; ++i) value = value * (n - k + i) / i;  // exact at each step
  return value;
}

}  // namespace

NamedPolytope cube(std::size_t d) {
  PointSet points = generate_points({.family = PointFamily::kCubeCorners, .dimension = d, .count = 0});
  return make(name_of("cube", {d}), std::move(points), d, 2 * d, std::exp2(static_cast<double>(d)));
}

NamedPolytope cross_polytope(std::size_t d) {
  PointSet points = generate_points({.family = PointFamily::kCrossPolytope, .dimension = d, .count = 0});
  return make(name_of("cross_polytope", {d}), std::move(points), d, std::uint64_t{1} << d,
              std::exp2(static_cast<double>(d)) / factorial(d));
}

NamedPolytope simplex(std::size_t d) {
  PointSet points = generate_points({.family = PointFamily::kSimplex, .dimension = d, .count = 0});
  return make(name_of("simplex", {d}), std::move(points), d, d + 1, 1.0 / factorial(d));
}

NamedPolytope cell_24() {
  PointSet points{4, {}, {}};
  add_orbit({1, 1, 0, 0}, false, points);
  return make("24-cell", std::move(points), 4, 24, 8.0);
}

NamedPolytope cell_600() {
  PointSet points{4, {}, {}};
  add_orbit({1, 0, 0, 0}, false, points);
  add_orbit({0.5, 0.5, 0.5, 0.5}, false, points);
  add_orbit({kGolden / 2, 0.5, 0.5 / kGolden, 0}, true, points);
  const double edge = 1.0 / kGolden;
  return make("600-cell", std::move(points), 4, 600, (50 + 25 * kRoot5) / 4 * std::pow(edge, 4));
}

NamedPolytope cell_120() {
  const double golden_sq = kGolden * kGolden;
  PointSet points{4, {}, {}};
  add_orbit({0, 0, 2, 2}, false, points);
  add_orbit({1, 1, 1, kRoot5}, false, points);
  add_orbit({1 / golden_sq, kGolden, kGolden, kGolden}, false, points);
  add_orbit({1 / kGolden, 1 / kGolden, 1 / kGolden, golden_sq}, false, points);
  add_orbit({0, 1 / golden_sq, 1, golden_sq}, true, points);
  add_orbit({0, 1 / kGolden, kGolden, kRoot5}, true, points);
  add_orbit({1 / kGolden, 1, kGolden, 2}, true, points);
  const double edge = 3.0 - kRoot5;
  return make("120-cell", std::move(points), 4, 120, 15.0 / 4 * (105 + 47 * kRoot5) * std::pow(edge, 4));
}

NamedPolytope permutahedron(std::size_t n) {
  NDHULL_CHECK(n >= 2);
  PointSet points{n, {}, {}};
  for_each_order(n, [&](const std::vector<std::size_t>& order) {
    for (const std::size_t value : order) points.coordinates.push_back(static_cast<double>(value + 1));
  });
  // The volume is that of a parallelepiped times the number of labelled trees (Stanley. Enumerative
  // Combinatorics, vol. 1, exercise 4.64).
  const double size = static_cast<double>(n);
  return make(name_of("permutahedron", {n}), std::move(points), n - 1, (std::uint64_t{1} << n) - 2,
              std::pow(size, size - 2) * std::sqrt(size));
}

NamedPolytope birkhoff(std::size_t n) {
  NDHULL_CHECK(n >= 2);
  PointSet points{n * n, {}, {}};
  for_each_order(n, [&](const std::vector<std::size_t>& order) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) points.coordinates.push_back(order[i] == j ? 1.0 : 0.0);
    }
  });
  // Chan, Robbins. On the volume of the polytope of doubly stochastic matrices. Exp. Math. 8(3), 1999.
  std::optional<double> volume;
  if (n == 2) volume = 2.0;
  if (n == 3) volume = 9.0 / 8.0;
  if (n == 4) volume = 176.0 / 2835.0;
  return make(name_of("birkhoff", {n}), std::move(points), (n - 1) * (n - 1), n == 2 ? 2 : n * n, volume);
}

NamedPolytope cyclic_trigonometric(std::size_t n, std::size_t d) {
  NDHULL_CHECK(n > d && d % 2 == 0);
  PointSet points = generate_points(
      {.family = PointFamily::kCyclic, .dimension = d, .count = n, .curve = CyclicCurve::kTrigonometric});
  return make(name_of("cyclic_trigonometric", {n, d}), std::move(points), d, cyclic_facet_count(n, d), {});
}

NamedPolytope moment_curve(std::size_t n, std::size_t d) {
  NDHULL_CHECK(n > d);
  PointSet points = generate_points(
      {.family = PointFamily::kCyclic, .dimension = d, .count = n, .curve = CyclicCurve::kMoment});
  return make(name_of("moment_curve", {n, d}), std::move(points), d, cyclic_facet_count(n, d), {});
}

NamedPolytope grid(std::size_t side, std::size_t d) {
  NDHULL_CHECK(side >= 2);
  PointSet points =
      generate_points({.family = PointFamily::kLattice, .dimension = d, .count = 0, .side = side});
  NamedPolytope polytope = make(name_of("grid", {side, d}), std::move(points), d, 2 * d,
                                std::pow(static_cast<double>(side - 1), static_cast<double>(d)));
  polytope.vertices = std::size_t{1} << d;
  return polytope;
}

NamedPolytope cut_polytope(std::size_t n) {
  NDHULL_CHECK(n >= 3 && n <= 7);
  constexpr std::array<std::uint64_t, 8> kFacets{0, 0, 0, 4, 16, 56, 368, 116764};
  PointSet points{n * (n - 1) / 2, {}, {}};
  // Node 0 stays on its side, so that a cut and its complement come once.
  for (std::size_t side = 0; side < std::size_t{1} << n; side += 2) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        points.coordinates.push_back(static_cast<double>((side >> i ^ side >> j) & 1U));
      }
    }
  }
  const std::size_t rank = points.dimension;
  return make(name_of("cut_polytope", {n}), std::move(points), rank, kFacets[n], {});
}

NamedPolytope linear_ordering(std::size_t n) {
  NDHULL_CHECK(n >= 3 && n <= 6);
  constexpr std::array<std::uint64_t, 7> kFacets{0, 0, 0, 8, 20, 40, 910};
  PointSet points{n * (n - 1), {}, {}};
  for_each_order(n, [&](const std::vector<std::size_t>& place) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (i != j) points.coordinates.push_back(place[i] < place[j] ? 1.0 : 0.0);
      }
    }
  });
  return make(name_of("linear_ordering", {n}), std::move(points), n * (n - 1) / 2, kFacets[n], {});
}

NamedPolytope product_of_simplices(std::size_t a, std::size_t b) {
  NDHULL_CHECK(a >= 1 && b >= 1);
  PointSet points{a + b, {}, {}};
  for (std::size_t i = 0; i <= a; ++i) {
    for (std::size_t j = 0; j <= b; ++j) {
      for (std::size_t k = 1; k <= a; ++k) points.coordinates.push_back(k == i ? 1.0 : 0.0);
      for (std::size_t k = 1; k <= b; ++k) points.coordinates.push_back(k == j ? 1.0 : 0.0);
    }
  }
  return make(name_of("product_of_simplices", {a, b}), std::move(points), a + b, a + b + 2,
              1.0 / (factorial(a) * factorial(b)));
}

std::uint64_t cyclic_facet_count(std::uint64_t n, std::uint64_t d) {
  NDHULL_CHECK(d >= 1 && n > d);
  const std::uint64_t k = d / 2;
  if (d % 2 == 1) return 2 * binomial(n - k - 1, k);
  return binomial(n - k, k) + binomial(n - k - 1, k - 1);  // = n / (n - k) binomial(n - k, k)
}

std::vector<NamedPolytope> small_named_polytopes() {
  std::vector<NamedPolytope> list;
  for (const std::size_t d : Sizes{1, 2, 3, 5, 7}) {
    list.push_back(cube(d));
    list.push_back(cross_polytope(d));
    list.push_back(simplex(d));
  }
  list.push_back(cell_24());
  list.push_back(cell_600());
  list.push_back(cell_120());
  for (const std::size_t n : Sizes{2, 3, 4, 5, 6}) list.push_back(permutahedron(n));
  for (const std::size_t n : Sizes{2, 3, 4, 5}) list.push_back(birkhoff(n));
  for (const std::size_t d : Sizes{2, 4, 6}) list.push_back(cyclic_trigonometric(2 * d + 4, d));
  for (const std::size_t d : Sizes{3, 4, 5}) list.push_back(moment_curve(d + 4, d));
  for (const std::size_t d : Sizes{2, 3, 4, 5}) list.push_back(grid(3, d));
  for (const std::size_t n : Sizes{3, 4, 5}) list.push_back(cut_polytope(n));
  for (const std::size_t n : Sizes{3, 4, 5}) list.push_back(linear_ordering(n));
  list.push_back(product_of_simplices(2, 3));
  list.push_back(product_of_simplices(4, 4));
  return list;
}

}  // namespace ndhull
