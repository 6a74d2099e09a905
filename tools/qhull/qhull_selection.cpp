#include "tools/qhull/qhull_selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "approx/geometry/boundedness.h"
#include "core/error.h"

namespace ndhull {
namespace {

using Facets = std::vector<FacetId>;

/// How far the normal is outside its bounds at most; 0 or less: within all of them.
double excess_over_bounds(const Hull& hull, FacetId facet, const std::vector<NormalBound>& bounds) {
  double excess = 0.0;
  for (const NormalBound& bound : bounds) {
    const double component = hull.normal(facet)[bound.column];
    excess = std::max(excess, bound.is_least ? bound.value - component : component - bound.value);
  }
  return excess;
}

Facets within_bounds(const Hull& hull, const QhullCommand& command) {
  for (const NormalBound& bound : command.normal_bounds) {
    if (bound.column < hull.dimension) continue;
    throw Error(ErrorCode::kUsage,
                fmt::format("qhull options: found P{}{} for points in dimension {}, expected a coordinate "
                            "from 0 to {}",
                            bound.is_least ? 'd' : 'D', bound.column, hull.dimension, hull.dimension - 1));
  }
  Facets kept;
  FacetId closest;
  double least_excess = HUGE_VAL;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    const double excess = excess_over_bounds(hull, facet, command.normal_bounds);
    if (excess <= 0.0) kept.push_back(facet);
    if (excess >= least_excess) continue;
    least_excess = excess;
    closest = facet;
  }
  if (kept.empty() && command.keeps_closest && hull.facet_count() > 0) kept.push_back(closest);
  return kept;
}

/// The first `count` by `before`, ascending.
template <class Before>
Facets first_of(Facets facets, std::uint64_t count, const Before& before) {
  if (count < facets.size()) {
    std::nth_element(facets.begin(), facets.begin() + static_cast<std::ptrdiff_t>(count), facets.end(),
                     before);
    facets.resize(count);
    std::sort(facets.begin(), facets.end());
  }
  return facets;
}

Facets intersection_of(const Facets& a, const Facets& b) {
  Facets both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

Facets chosen(const Hull& hull, const Facets& candidates, const SelectionOptions& options) {
  const auto is_larger = [&hull](FacetId a, FacetId b) {
    const double area_a = hull.area_of(a), area_b = hull.area_of(b);
    return area_a != area_b ? area_a > area_b : a < b;
  };
  const auto is_more_merged = [&](FacetId a, FacetId b) {
    const std::size_t of_a = hull.simplex_count_of(a), of_b = hull.simplex_count_of(b);
    return of_a != of_b ? of_a > of_b : is_larger(a, b);
  };
  Facets kept = candidates;
  if (options.largest) kept = first_of(candidates, *options.largest, is_larger);
  if (options.most_merged)
    kept = intersection_of(kept, first_of(candidates, *options.most_merged, is_more_merged));
  if (options.min_area)
    std::erase_if(kept, [&](FacetId facet) { return hull.area_of(facet) < *options.min_area; });
  return kept;
}

Facets with_neighbours(const Hull& hull, const Facets& kept, bool keeps_them) {
  Facets printed;
  for (const FacetId facet : kept) {
    const auto around = hull.neighbours_of(facet);
    printed.insert(printed.end(), around.begin(), around.end());
  }
  std::sort(printed.begin(), printed.end());
  printed.erase(std::unique(printed.begin(), printed.end()), printed.end());
  Facets result;
  if (keeps_them) {
    std::set_union(printed.begin(), printed.end(), kept.begin(), kept.end(), std::back_inserter(result));
  } else {
    std::set_difference(printed.begin(), printed.end(), kept.begin(), kept.end(), std::back_inserter(result));
  }
  return result;
}

}  // namespace

bool selects_facets(const QhullCommand& command) {
  return command.selection.is_set() || !command.normal_bounds.empty() || command.prints_neighbours;
}

QhullSelection select_facets(const Hull& hull, const QhullCommand& command) {
  QhullSelection selection;
  selection.facets = chosen(hull, within_bounds(hull, command), command.selection);
  if (command.prints_neighbours)
    selection.facets = with_neighbours(hull, selection.facets, command.prints_kept);
  if (command.selection.is_set()) {
    std::vector<double> normals;
    for (const FacetId facet : selection.facets) {
      const auto normal = hull.normal(facet);
      normals.insert(normals.end(), normal.begin(), normal.end());
    }
    Boundedness region = find_open_direction(normals, hull.dimension, hull.subspace_equations);
    if (!region.bounded) selection.open_direction = std::move(region.direction);
  }
  return selection;
}

}  // namespace ndhull
