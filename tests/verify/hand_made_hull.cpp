#include "tests/verify/hand_made_hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/exact_orientation.h"

namespace ndhull {
namespace {

using Simplices = std::vector<std::vector<std::uint32_t>>;

/// Rows in one orientation about the interior point, neighbours by equal ridges.
void fill_complex(HandMadeHull& hull, const Simplices& simplices) {
  const std::size_t d = hull.claimed.dimension;
  hull.complex = SimplicialComplex(d, simplices.size() + 4);  // room for a test to add some
  hull.complex.row_count = simplices.size();
  std::map<std::vector<std::uint32_t>, std::pair<std::size_t, std::size_t>> open_ridges;
  for (std::size_t row = 0; row < simplices.size(); ++row) {
    std::vector<std::uint32_t> ids = simplices[row];
    std::vector<double> corners;
    for (const std::uint32_t id : ids) {
      corners.insert(corners.end(), hull.points.begin() + static_cast<std::ptrdiff_t>(id * d),
                     hull.points.begin() + static_cast<std::ptrdiff_t>((id + 1) * d));
    }
    corners.insert(corners.end(), hull.interior.begin(), hull.interior.end());
    if (exact_orientation(corners, d) < 0) std::swap(ids[0], ids[1]);
    hull.complex.state[row] = SimplexState::kLive;
    std::copy(ids.begin(), ids.end(), hull.simplex_vertices(row));
    for (std::size_t slot = 0; slot < d; ++slot) {
      std::vector<std::uint32_t> ridge = ids;
      ridge.erase(ridge.begin() + static_cast<std::ptrdiff_t>(slot));
      std::sort(ridge.begin(), ridge.end());
      const auto [found, is_new] = open_ridges.try_emplace(ridge, row, slot);
      if (is_new) continue;
      hull.simplex_neighbours(row)[slot] = static_cast<std::uint32_t>(found->second.first);
      hull.simplex_neighbours(found->second.first)[found->second.second] = static_cast<std::uint32_t>(row);
      open_ridges.erase(found);
    }
  }
}

/// Vertices and neighbours of the facets, from facet_of_simplex; their planes are there already.
void fill_facets(HandMadeHull& hull) {
  for (std::uint32_t row = 0; row < hull.complex.row_count; ++row) {
    const FacetId own = hull.facet_of_simplex[row];
    HandMadeFacet& facet = hull.facets[own.value];
    facet.simplices.push_back(SimplexId{row});
    for (const PointId vertex : hull.complex.vertices(SimplexId{row})) facet.vertices.push_back(vertex);
    for (const SimplexId next : hull.complex.neighbours(SimplexId{row})) {
      const FacetId other = hull.facet_of_simplex[next.value];
      if (other != own) facet.neighbours.push_back(other);
    }
  }
  for (HandMadeFacet& facet : hull.facets) {
    std::sort(facet.vertices.begin(), facet.vertices.end());
    facet.vertices.erase(std::unique(facet.vertices.begin(), facet.vertices.end()), facet.vertices.end());
    std::sort(facet.neighbours.begin(), facet.neighbours.end());
    facet.neighbours.erase(std::unique(facet.neighbours.begin(), facet.neighbours.end()),
                           facet.neighbours.end());
  }
}

/// All corners of facet x_axis = +-1 along monotone paths, Kuhn's triangulation.
void add_cube_facet(std::size_t d, std::size_t axis, bool positive, Simplices& simplices) {
  std::vector<std::size_t> steps(d);
  std::iota(steps.begin(), steps.end(), std::size_t{0});
  steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(axis));
  do {
    std::uint32_t corner = positive ? 1U << axis : 0U;
    std::vector<std::uint32_t> simplex{corner};
    for (const std::size_t step : steps) simplex.push_back(corner |= 1U << step);
    simplices.push_back(simplex);
  } while (std::next_permutation(steps.begin(), steps.end()));
}

}  // namespace

void HandMadeHull::settle_numbers() {
  claimed.point_count = points.size() / claimed.dimension;
  claimed.max_outer_offset = claimed.min_inner_offset = claimed.max_facet_width = 0.0;
  for (const HandMadeFacet& facet : facets) {
    claimed.max_outer_offset = std::max(claimed.max_outer_offset, facet.outer_offset);
    claimed.min_inner_offset = std::min(claimed.min_inner_offset, facet.inner_offset);
    claimed.max_facet_width = std::max(claimed.max_facet_width, facet.outer_offset - facet.inner_offset);
  }
}

void HandMadeHull::share_area() {
  for (HandMadeFacet& facet : facets) facet.area = claimed.area / static_cast<double>(facets.size());
}

HandMadeHull hand_made_cube(std::size_t d, bool merged, const std::vector<double>& more_points) {
  HandMadeHull hull;
  hull.claimed = {.dimension = d,
                  .rank = d,
                  .area = std::ldexp(2.0 * static_cast<double>(d), static_cast<int>(d) - 1),
                  .volume = std::ldexp(1.0, static_cast<int>(d)),
                  .roundoff = 0.0};
  for (std::uint32_t corner = 0; corner < 1U << d; ++corner) {
    hull.vertex_ids.push_back(PointId{corner});
    for (std::size_t k = 0; k < d; ++k) hull.points.push_back((corner >> k & 1U) != 0 ? 1.0 : -1.0);
  }
  hull.points.insert(hull.points.end(), more_points.begin(), more_points.end());
  hull.interior.assign(d, 0.0);
  hull.origin.assign(d, 0.0);

  Simplices simplices;
  for (std::uint32_t side = 0; side < 2 * d; ++side) {
    HandMadeFacet facet;
    facet.normal.assign(d, 0.0);
    facet.normal[side / 2] = side % 2 == 0 ? -1.0 : 1.0;
    facet.offset = facet.centred_offset = -1.0;
    add_cube_facet(d, side / 2, side % 2 != 0, simplices);
    while (hull.facet_of_simplex.size() < simplices.size()) {
      if (!merged || hull.facets.size() <= side) hull.facets.push_back(facet);
      hull.facet_of_simplex.push_back(FacetId{static_cast<std::uint32_t>(hull.facets.size() - 1)});
    }
  }
  fill_complex(hull, simplices);
  fill_facets(hull);
  hull.share_area();
  hull.settle_numbers();
  return hull;
}

HandMadeHull hand_made_cross_polytope(std::size_t d) {
  HandMadeHull hull;
  double factorial = 1.0;
  for (std::size_t k = 2; k <= d; ++k) factorial *= static_cast<double>(k);
  hull.claimed = {.dimension = d,
                  .rank = d,
                  .area = std::ldexp(std::sqrt(static_cast<double>(d)), static_cast<int>(d)) *
                          static_cast<double>(d) / factorial,
                  .volume = std::ldexp(1.0, static_cast<int>(d)) / factorial,
                  .roundoff = 0x1p-50};
  hull.points.assign(2 * d * d, 0.0);
  for (std::uint32_t row = 0; row < 2 * d; ++row) {
    hull.points[row * d + row / 2] = row % 2 == 0 ? 1.0 : -1.0;
    hull.vertex_ids.push_back(PointId{row});
  }
  hull.interior.assign(d, 0.0);
  hull.origin.assign(d, 0.0);
  Simplices simplices;
  const double component = 1.0 / std::sqrt(static_cast<double>(d));
  for (std::uint32_t signs = 0; signs < 1U << d; ++signs) {
    HandMadeFacet facet;
    simplices.emplace_back();
    for (std::uint32_t k = 0; k < d; ++k) {
      const std::uint32_t negative = signs >> k & 1U;
      facet.normal.push_back(negative != 0 ? -component : component);
      simplices.back().push_back(2 * k + negative);
    }
    facet.offset = facet.centred_offset = -component;
    hull.facets.push_back(facet);
    hull.facet_of_simplex.push_back(FacetId{signs});
  }
  fill_complex(hull, simplices);
  fill_facets(hull);
  hull.share_area();
  hull.settle_numbers();
  return hull;
}

}  // namespace ndhull
