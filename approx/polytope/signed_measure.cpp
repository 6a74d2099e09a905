#include "approx/polytope/signed_measure.h"

#include <cmath>
#include <numeric>

#include "core/dimension_switch.h"
#include "core/id_rows.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

constexpr std::size_t kMostValues = std::size_t{1} << 27;  // a gigabyte
constexpr std::size_t kParentsInBlock = 256;

constexpr std::size_t components(std::size_t rank, std::size_t grade) {
  if (grade > rank) return 0;
  std::size_t count = 1;
  for (std::size_t k = 1; k <= grade; ++k) count = count * (rank - grade + k) / k;
  return count;
}

/// Adds the exterior product of x and a (Grade - 1)-vector v to sum, a Grade-vector. The components without
/// the last axis come first, then those with it, both in this order.
template <std::size_t Rank, std::size_t Grade>
void add_product(const double* x, const double* v, double* sum) {
  if constexpr (Grade > 0 && Grade <= Rank) {
    constexpr std::size_t kWithout = components(Rank - 1, Grade), kOfV = components(Rank - 1, Grade - 1);
    const double last = Grade % 2 == 0 ? -x[Rank - 1] : x[Rank - 1];
    for (std::size_t k = 0; k < kOfV; ++k) sum[kWithout + k] += last * v[k];
    add_product<Rank - 1, Grade>(x, v, sum);
    add_product<Rank - 1, Grade - 1>(x, v + kOfV, sum + kWithout);
  }
}

using AddProduct = void (*)(const double*, const double*, double*);

AddProduct product_of(std::size_t rank, std::size_t grade) {
  return call_with_dimension<1, kMaxRank>(rank, [&](auto d) {
    return call_with_dimension<1, kMaxRank>(grade, [&](auto k) -> AddProduct { return &add_product<d, k>; });
  });
}

/// The numbers 0 .. parents.size() - 1, those with the same parent together, ascending.
IdRows by_parent(const std::vector<std::uint32_t>& parents, std::size_t count) {
  IdRows rows;
  rows.begin.assign(count + 1, 0);
  for (const std::uint32_t parent : parents) ++rows.begin[parent + 1];
  std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
  std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
  rows.values.resize(parents.size());
  for (std::uint32_t i = 0; i < parents.size(); ++i) rows.values[next[parents[i]]++] = i;
  return rows;
}

/// Of each simplex of the dual hull: 1, or -1 where it takes an odd number of swaps to sort its planes.
std::vector<double> vertex_signs(const PlanePolytope& polytope, std::size_t rank) {
  std::vector<double> signs;
  for (std::size_t simplex = 0; simplex < polytope.vertex_of.size(); ++simplex) {
    const std::uint32_t* const row = polytope.planes.data() + simplex * rank;
    double sign = 1.0;
    for (std::size_t i = 0; i < rank; ++i)
      for (std::size_t k = i + 1; k < rank; ++k) sign = row[k] < row[i] ? -sign : sign;
    signs.push_back(sign);
  }
  return signs;
}

/// Of each facet's measure, a (rank-1)-vector, the part along its plane's normal.
double area_of(std::size_t rank, const FaceLevel& facets, const std::vector<double>& measures,
               const std::vector<double>& normals) {
  double area = 0.0;
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    const double* const normal = normals.data() + *facets.row(facet) * rank;
    // Component t lacks axis rank - 1 - t.
    for (std::size_t t = 0; t < rank; ++t) {
      const std::size_t axis = rank - 1 - t;
      area += (axis % 2 == 0 ? 1.0 : -1.0) * normal[axis] * measures[facet * rank + t];
    }
  }
  return std::abs(area);
}

}  // namespace

std::optional<PolytopeMeasure> measure_signed(std::size_t rank, const PlanePolytope& polytope,
                                              const FaceLevels& levels, const std::vector<double>& vertices,
                                              const std::vector<double>& normals) {
  PolytopeMeasure result;
  FaceLevel level = levels.vertices();
  // Simplices of the dual hull are all oriented alike; faces have the order of their planes' numbers. The
  // sign of a face in one above it is that of the place of the plane left out: a boundary has no boundary.
  std::vector<double> measures = vertex_signs(polytope, rank);
  for (std::size_t dimension = 1; dimension <= rank; ++dimension) {
    std::vector<std::uint32_t> parents;
    FaceLevel higher = levels.above(level, parents);
    if (levels.has_ended()) break;
    const std::size_t below = components(rank, dimension - 1), here = components(rank, dimension);
    if (higher.size() * here + measures.size() > kMostValues) return std::nullopt;
    const AddProduct add = product_of(rank, dimension);
    const IdRows children = by_parent(parents, higher.size());
    std::vector<double> of_higher(higher.size() * here, 0.0);
    for_each_block(higher.size(), kParentsInBlock, [&](std::size_t begin, std::size_t end) {
      std::vector<double> edge(rank);
      for (std::size_t parent = begin; parent < end && !levels.has_ended(); ++parent) {
        const double* const apex = vertices.data() + higher.base[parent] * rank;
        for (const std::uint32_t child : children.row(parent)) {
          const std::size_t face = child / level.width;
          if (level.base[face] == higher.base[parent]) continue;  // the cone is flat
          const double* const base = vertices.data() + level.base[face] * rank;
          const double factor = (child % level.width % 2 == 0 ? 1.0 : -1.0) / static_cast<double>(dimension);
          for (std::size_t k = 0; k < rank; ++k) edge[k] = factor * (base[k] - apex[k]);
          add(edge.data(), measures.data() + face * below, of_higher.data() + parent * here);
        }
      }
    });
    level = std::move(higher);
    measures = std::move(of_higher);
    if (level.width == 1) result.area = area_of(rank, level, measures, normals);
  }
  if (levels.has_ended()) return PolytopeMeasure{levels.end_status(), 0.0, 0.0};
  result.volume = measures.empty() ? 0.0 : std::abs(measures[0]);
  return result;
}

}  // namespace ndhull
