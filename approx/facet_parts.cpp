#include "approx/facet_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "approx/slab_growth.h"
#include "core/ids.h"

namespace ndhull {
namespace {

/// A part of a facet that hangs together with none of its others.
struct Stray {
  std::uint32_t facet;
  std::vector<std::uint32_t> simplices;
};

/// How far the simplices reach below the height of the plane, which is measured if it was not yet.
double depth_below(const SimplicialComplex& complex, const WidthSpace& space,
                   std::span<const std::uint32_t> simplices, FittedPlane& plane, PlaneFitWork& work) {
  if (!is_measured(plane)) plane = measure_plane(space, plane.normal, {}, work);
  double low = HUGE_VAL;
  const double* normal = plane.normal.data();
  for (const std::uint32_t simplex : simplices) {
    for (const PointId id : complex.vertices(SimplexId{simplex})) {
      const double* z = space.row(space.row_of(id));
      double dot = 0.0;
      for (std::size_t k = 0; k < complex.rank; ++k) dot += normal[k] * z[k];
      low = std::min(low, dot);
    }
  }
  return plane.height - low;
}

/// Connected parts of facets: each row's part is known by its first row.
class FacetParts {
 public:
  /// Id: as small as holds all facets, since looking these up is what takes the time; its largest: none, or
  /// not asked about.
  template <class Id>
  FacetParts(const SimplicialComplex& complex, const std::vector<Id>& facet_of) : first_(complex.row_count) {
    // Rows as they stand in memory; each ridge from the later of its two. Which neighbours are of the same
    // facet is not to be foreseen: they are listed without a branch for each.
    std::array<std::uint32_t, kMaxRank> same;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      first_[row] = row;
      const Id facet = facet_of[row];
      if (facet == std::numeric_limits<Id>::max()) continue;
      std::size_t count = 0;
      for (const SimplexId neighbour : complex.neighbours(SimplexId{row})) {
        same[count] = neighbour.value;
        count += static_cast<std::size_t>(neighbour.value < row) &
                 static_cast<std::size_t>(facet_of[neighbour.value] == facet);
      }
      std::uint32_t root = row;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t other = find(same[i]);
        if (other == root) continue;
        first_[std::max(other, root)] = std::min(other, root);
        root = std::min(other, root);
      }
    }
  }
  /// Valid for ascending rows, once each.
  std::uint32_t part_of(std::uint32_t row) { return first_[row] = first_[first_[row]]; }

 private:
  std::uint32_t find(std::uint32_t row) {
    while (first_[row] != row) row = first_[row] = first_[first_[row]];
    return row;
  }
  std::vector<std::uint32_t> first_;
};

/// All connected parts of the facets but the largest of each, in the order of their first simplex.
/// Id: std::uint16_t where that holds all facets.
template <class Id>
std::vector<Stray> find_strays(const SimplicialComplex& complex, const Covering& covering,
                               std::span<const std::uint8_t> is_asked) {
  constexpr Id kNoId = std::numeric_limits<Id>::max();
  std::vector<Id> facet_of(complex.row_count);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    const std::uint32_t facet = covering.facet_of[row];
    const bool is_left_out = facet == kNone || (!is_asked.empty() && is_asked[facet] == 0);
    facet_of[row] = is_left_out ? kNoId : static_cast<Id>(facet);
  }
  FacetParts parts(complex, facet_of);
  std::vector<std::uint32_t> size_of(complex.row_count, 0), largest_of(covering.planes.size(), kNone);
  std::vector<std::uint32_t> others;  // first rows of the parts that are not a facet's first
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    const Id facet = facet_of[row];
    if (facet == kNoId) continue;
    const std::uint32_t part = parts.part_of(row);
    ++size_of[part];
    if (part != row) continue;
    if (largest_of[facet] == kNone) {
      largest_of[facet] = part;
    } else {
      others.push_back(part);
    }
  }
  if (others.empty()) return {};
  for (const std::uint32_t part : others) {
    std::uint32_t& largest = largest_of[facet_of[part]];
    if (size_of[part] > size_of[largest]) largest = part;
  }
  std::vector<Stray> strays;
  std::vector<std::uint32_t> place_of(complex.row_count, kNone);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    const Id facet = facet_of[row];
    if (facet == kNoId) continue;
    const std::uint32_t part = parts.part_of(row);
    if (largest_of[facet] == part) continue;
    if (part == row) {
      place_of[part] = static_cast<std::uint32_t>(strays.size());
      strays.push_back({facet, {}});
    }
    strays[place_of[part]].simplices.push_back(row);
  }
  return strays;
}

}  // namespace

void gather_strays(const SimplicialComplex& complex, const WidthSpace& space, double width,
                   Covering& covering, std::vector<float>& depth_of, PlaneFitWork& work,
                   std::span<const std::uint8_t> is_asked) {
  const bool are_few = covering.planes.size() < std::numeric_limits<std::uint16_t>::max();
  const std::vector<Stray> strays = are_few ? find_strays<std::uint16_t>(complex, covering, is_asked)
                                            : find_strays<std::uint32_t>(complex, covering, is_asked);
  std::vector<std::uint32_t> hosts;
  for (const Stray& stray : strays) {
    hosts.clear();
    for (const std::uint32_t simplex : stray.simplices) {
      for (const SimplexId neighbour : complex.neighbours(SimplexId{simplex}))
        if (covering.facet_of[neighbour.value] != stray.facet)
          hosts.push_back(covering.facet_of[neighbour.value]);
    }
    std::sort(hosts.begin(), hosts.end());
    hosts.erase(std::unique(hosts.begin(), hosts.end()), hosts.end());
    double best_depth = kDepthRoom * width;
    std::uint32_t best = kNone;
    for (const std::uint32_t host : hosts) {
      const double depth = depth_below(complex, space, stray.simplices, covering.planes[host], work);
      if (depth >= best_depth) continue;
      best_depth = depth;
      best = host;
    }
    if (best == kNone) continue;
    for (const std::uint32_t simplex : stray.simplices) {
      covering.facet_of[simplex] = best;
      depth_of[simplex] = rounded_up_depth(best_depth);
    }
  }
}

}  // namespace ndhull
