#include "tests/hull/hull_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "core/complex/complex_check.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

/// normal . (x - reference) + centred_offset, the plane that is certified.
long double certified_distance(const Hull& hull, FacetId facet, const PointView& points, std::size_t row) {
  long double sum = hull.centred_offset(facet);
  const auto normal = hull.normal(facet);
  for (std::size_t k = 0; k < hull.dimension; ++k) {
    const long double difference = static_cast<long double>(points.at(row, k)) - hull.reference[k];
    sum += static_cast<long double>(normal[k]) * difference;
  }
  return sum;
}

bool is_ascending(std::span<const PointId> ids) {
  return std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end();
}

void expect_certified(const Hull& hull, const PointView& points) {
  EXPECT_LE(largest_outer_excess(hull, points), 0.0L);
  EXPECT_LE(largest_inner_excess(hull, points), 0.0L);
  double outer = 0.0, inner = 0.0, width = 0.0, area = 0.0;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    EXPECT_GE(hull.outer_offset(facet), 0.0) << "facet " << row;
    EXPECT_LE(hull.inner_offset(facet), 0.0) << "facet " << row;
    outer = std::max(outer, hull.outer_offset(facet));
    inner = std::min(inner, hull.inner_offset(facet));
    width = std::max(width, hull.outer_offset(facet) - hull.inner_offset(facet));
    area += hull.area_of(facet);
    long double length_sq = 0.0L, inside = hull.centred_offset(facet);
    const auto normal = hull.normal(facet);
    for (std::size_t k = 0; k < hull.dimension; ++k) {
      length_sq += static_cast<long double>(normal[k]) * normal[k];
      inside += static_cast<long double>(normal[k]) *
                (static_cast<long double>(hull.interior_point[k]) - hull.reference[k]);
    }
    // Each of d + 2 roundings moves the square by at most 2^-52 of it.
    EXPECT_NEAR(static_cast<double>(length_sq), 1.0, static_cast<double>(hull.dimension + 2) * 0x1p-52);
    EXPECT_LT(inside, 0.0L) << "the interior point is not below facet " << row;
  }
  EXPECT_EQ(hull.max_outer_offset, outer);
  EXPECT_EQ(hull.min_inner_offset, inner);
  EXPECT_EQ(hull.max_facet_width, width);
  EXPECT_NEAR(hull.area, area, 1e-12 * area);
  EXPECT_GE(hull.max_outside_gauge, -1.0);
}

/// Counts broken laws and keeps the first: a wrong hull would print a thousand lines.
class Problems {
 public:
  void check(bool holds, const char* law, std::uint32_t facet) {
    if (!holds && count_++ == 0) first_ = std::string(law) + ", facet " + std::to_string(facet);
  }
  ~Problems() { EXPECT_EQ(count_, 0U) << "first: " << first_; }
  Problems() = default;
  Problems(const Problems&) = delete;
  Problems& operator=(const Problems&) = delete;

 private:
  std::uint64_t count_ = 0;
  std::string first_;
};

void check_neighbours(const Hull& hull, std::uint32_t row, Problems& problems) {
  const FacetId facet{row};
  const auto neighbours = hull.neighbours_of(facet);
  const std::set<FacetId> distinct(neighbours.begin(), neighbours.end());
  problems.check(neighbours.size() >= hull.rank, "at least rank neighbours", row);
  problems.check(distinct.size() == neighbours.size(), "neighbours are distinct", row);
  problems.check(!distinct.contains(facet), "no facet is its own neighbour", row);
  for (const FacetId neighbour : neighbours) {
    problems.check(neighbour.value < hull.facet_count(), "neighbours exist", row);
    const auto back = hull.neighbours_of(neighbour);
    problems.check(std::find(back.begin(), back.end(), facet) != back.end(), "neighbours are mutual", row);
  }
}

void expect_incidences(const Hull& hull) {
  Problems problems;
  std::vector<std::uint32_t> facets_at(hull.point_count, 0);
  std::vector<bool> simplex_seen(hull.simplices().row_count, false);
  std::uint64_t simplicial = 0;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    check_neighbours(hull, row, problems);
    const auto vertices = hull.vertices_of(facet);
    problems.check(vertices.size() >= hull.rank, "at least rank vertices", row);
    std::set<PointId> distinct(vertices.begin(), vertices.end());
    problems.check(distinct.size() == vertices.size(), "vertices are distinct", row);
    for (const PointId vertex : vertices) ++facets_at.at(vertex.value);
    simplicial += hull.is_simplicial(facet) ? 1U : 0U;
    for (const SimplexId simplex : hull.simplices_of(facet)) {
      problems.check(hull.facet_of(simplex) == facet, "facet_of names the simplex's facet", row);
      problems.check(!simplex_seen.at(simplex.value), "no simplex is in two facets", row);
      simplex_seen[simplex.value] = true;
      for (const PointId vertex : hull.simplices().vertices(simplex)) distinct.erase(vertex);
    }
    problems.check(distinct.empty(), "vertices are vertices of the facet's simplices", row);
  }
  EXPECT_EQ(hull.simplicial_facet_count(), simplicial);
  EXPECT_EQ(std::count(simplex_seen.begin(), simplex_seen.end(), false), 0);
  EXPECT_TRUE(is_ascending(hull.vertices));
  std::size_t used = 0;
  for (std::size_t id = 0; id < facets_at.size(); ++id) used += facets_at[id] > 0 ? 1U : 0U;
  EXPECT_EQ(hull.vertices.size(), used);
  const auto in_few = [&](PointId vertex) { return facets_at.at(vertex.value) < hull.rank; };
  EXPECT_EQ(std::count_if(hull.vertices.begin(), hull.vertices.end(), in_few), 0) << "vertices in few facets";
}

}  // namespace

PointSet family_points(PointFamily family, std::size_t n, std::size_t d, std::uint64_t seed) {
  return generate_points({.family = family, .dimension = d, .count = n, .seed = seed});
}

std::vector<VertexSet> facet_sets(const Hull& hull) {
  std::vector<VertexSet> facets(hull.facet_count());
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    for (const PointId vertex : hull.vertices_of(FacetId{row})) facets[row].push_back(vertex.value);
    std::sort(facets[row].begin(), facets[row].end());
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

std::vector<VertexSet> renamed(const std::vector<VertexSet>& facets,
                               const std::vector<std::size_t>& new_of_old) {
  std::vector<VertexSet> result = facets;
  for (VertexSet& facet : result) {
    for (std::uint32_t& id : facet) id = static_cast<std::uint32_t>(new_of_old.at(id));
    std::sort(facet.begin(), facet.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

PointSet vertex_rows(const PointSet& set, const Hull& hull) {
  PointSet result{set.dimension, {}, set.header};
  for (const PointId vertex : hull.vertices) {
    const auto row = set.row(vertex.value);
    result.coordinates.insert(result.coordinates.end(), row.begin(), row.end());
  }
  return result;
}

double extent_of(const PointSet& set) {
  double extent = 0.0;
  for (std::size_t k = 0; k < set.dimension; ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < set.rows(); ++i) {
      low = std::min(low, set.row(i)[k]);
      high = std::max(high, set.row(i)[k]);
    }
    extent = std::max(extent, high - low);
  }
  return extent;
}

// Doubles rule out the points that are far below a plane, long double decides about the rest. Points are
// taken in parts that stay in the first cache.
long double largest_outer_excess(const Hull& hull, const PointView& points) {
  if (hull.facet_count() == 0) return 0.0L;
  constexpr std::size_t kPart = 256;
  const std::size_t n = points.rows, d = points.dimension;
  std::vector<double> columns((n + kPart) * d), largest(d, 0.0);
  const auto part = [&](std::size_t begin) { return columns.data() + begin * d; };  // [k * kPart + i - begin]
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < d; ++k) {
      double& value = part(i - i % kPart)[k * kPart + i % kPart];
      value = points.at(i, k) - hull.reference[k];
      largest[k] = std::max(largest[k], std::abs(value));
    }
  }
  long double excess = -std::numeric_limits<long double>::infinity();
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    const auto normal = hull.normal(facet);
    const long double outer =
        static_cast<long double>(hull.outer_offset(facet)) * hull.input_per_length_unit(facet);
    double size = std::abs(hull.centred_offset(facet));
    for (std::size_t k = 0; k < d; ++k) size += std::abs(normal[k]) * largest[k];
    // Twice the bound of a dot product of d terms with rounded differences.
    const double bound = 2.0 * static_cast<double>(d + 3) * 0x1p-53 * size;
    const double threshold = static_cast<double>(std::max(excess, -1.0L * size) + outer) - bound;
    for (std::size_t begin = 0; begin < n; begin += kPart) {
      std::array<double, kPart> value;
      value.fill(hull.centred_offset(facet));
      for (std::size_t k = 0; k < d; ++k) {
        const double* const column = part(begin) + k * kPart;
        for (std::size_t i = 0; i < kPart; ++i) value[i] += normal[k] * column[i];
      }
      for (std::size_t i = 0; i < std::min(kPart, n - begin); ++i) {
        if (value[i] > threshold)
          excess = std::max(excess, certified_distance(hull, facet, points, begin + i) - outer);
      }
    }
  }
  return excess;
}

long double largest_inner_excess(const Hull& hull, const PointView& points) {
  long double excess = hull.facet_count() == 0 ? 0.0L : -std::numeric_limits<long double>::infinity();
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    const long double inner =
        static_cast<long double>(hull.inner_offset(facet)) * hull.input_per_length_unit(facet);
    for (const SimplexId simplex : hull.simplices_of(facet)) {
      for (const PointId vertex : hull.simplices().vertices(simplex)) {
        excess = std::max(excess, inner - certified_distance(hull, facet, points, vertex.value));
      }
    }
  }
  return excess;
}

void expect_sound(const Hull& hull, const PointView& points) {
  EXPECT_EQ(hull.dimension, points.dimension);
  EXPECT_EQ(hull.point_count, points.rows);
  EXPECT_EQ(hull.interior_point.size(), points.dimension);
  EXPECT_EQ(hull.subspace_equations.size(), (hull.dimension - hull.rank) * (hull.dimension + 1));
  if (hull.rank == 0) {
    EXPECT_EQ(hull.facet_count(), 0U);
    EXPECT_EQ(hull.vertices.size(), 1U);
    return;
  }
  expect_certified(hull, points);
  if (hull.rank == 1) {
    EXPECT_EQ(hull.facet_count(), 2U);
    EXPECT_EQ(hull.vertices.size(), 2U);
    return;
  }
  expect_incidences(hull);
  const ComplexCheck check = check_complex(hull.simplices());
  EXPECT_TRUE(check.sound()) << check.first_problem;
  EXPECT_EQ(check.simplices, hull.simplices().row_count);
  EXPECT_GT(hull.volume, 0.0);
  EXPECT_GT(hull.area, 0.0);
  EXPECT_EQ(hull.points_outside, 0U);
}

// A face is the XOR of random keys of its vertices: 64 bits tell a few million faces apart.
std::vector<std::uint64_t> face_numbers(const SimplicialComplex& complex) {
  std::vector<std::uint64_t> key_of_point;
  PortableRandom random(20240601);
  std::vector<std::unordered_set<std::uint64_t>> faces(complex.rank);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    const auto vertices = complex.vertices(SimplexId{row});
    for (const PointId vertex : vertices) {
      while (key_of_point.size() <= vertex.value) {
        const std::uint64_t high = random.below(std::uint64_t{1} << 32);
        key_of_point.push_back(high << 32 | random.below(std::uint64_t{1} << 32));
      }
    }
    for (std::uint32_t subset = 1; subset < std::uint32_t{1} << complex.rank; ++subset) {
      std::uint64_t key = 0;
      for (std::size_t k = 0; k < complex.rank; ++k)
        key ^= (subset >> k & 1U) ? key_of_point[vertices[k].value] : 0;
      faces[static_cast<std::size_t>(__builtin_popcount(subset)) - 1].insert(key);
    }
  }
  std::vector<std::uint64_t> counts;
  for (const auto& of_dimension : faces) counts.push_back(of_dimension.size());
  return counts;
}

// The facets of a face are the largest of its intersections with the polytope's facets.
std::vector<std::uint64_t> lattice_face_numbers(const std::vector<VertexSet>& facets, std::size_t rank) {
  std::vector<std::uint64_t> counts(rank, 0);
  std::set<VertexSet> faces(facets.begin(), facets.end());
  for (std::size_t k = rank; k-- > 0;) {
    counts[k] = faces.size();
    std::set<VertexSet> lower;
    for (const VertexSet& face : faces) {
      std::set<VertexSet> parts;
      for (const VertexSet& facet : facets) {
        VertexSet part;
        std::set_intersection(face.begin(), face.end(), facet.begin(), facet.end(), std::back_inserter(part));
        if (part.size() < face.size() && !part.empty()) parts.insert(part);
      }
      for (const VertexSet& part : parts) {
        const bool largest = std::none_of(parts.begin(), parts.end(), [&](const VertexSet& other) {
          return other.size() > part.size() &&
                 std::includes(other.begin(), other.end(), part.begin(), part.end());
        });
        if (largest) lower.insert(part);
      }
    }
    faces = std::move(lower);
  }
  return counts;
}

void expect_euler(const std::vector<std::uint64_t>& faces) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    sum += (k % 2 == 0 ? 1 : -1) * static_cast<std::int64_t>(faces[k]);
  }
  EXPECT_EQ(sum, faces.size() % 2 == 0 ? 0 : 2);
}

}  // namespace ndhull
