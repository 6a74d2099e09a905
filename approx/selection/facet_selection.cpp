#include "approx/selection/facet_selection.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/geometry/boundedness.h"
#include "approx/selection/outer_distance.h"
#include "approx/selection/volume_selection.h"

namespace ndhull {
namespace {

/// Keeps the first `count` ids by `before`, and marks the others as dropped.
template <class Before>
void keep_first(std::uint64_t count, std::vector<std::uint32_t>& ids, std::vector<bool>& is_kept,
                const Before& before) {
  if (count >= ids.size()) return;
  const auto rest = ids.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(ids.begin(), rest, ids.end(), before);
  for (auto id = rest; id != ids.end(); ++id) is_kept[*id] = false;
}

/// One flag a facet. The options look at all facets each: their results are intersected.
std::vector<bool> kept_facets(const Hull& hull, const SelectionOptions& options, const WorkEnd& end,
                              const PointView* points) {
  const auto simplices = [&hull](std::uint32_t id) { return hull.simplex_count_of(FacetId{id}); };
  // Areas beyond the range of doubles are the largest: a number that is none must not spoil the order.
  const auto area = [&hull](std::uint32_t id) {
    const double value = hull.area_of(FacetId{id});
    return std::isnan(value) ? HUGE_VAL : value;
  };
  const auto is_larger = [&area](std::uint32_t a, std::uint32_t b) {
    const double area_a = area(a), area_b = area(b);
    return area_a != area_b ? area_a > area_b : a < b;
  };
  const auto is_more_merged = [&](std::uint32_t a, std::uint32_t b) {
    const std::size_t of_a = simplices(a), of_b = simplices(b);
    return of_a != of_b ? of_a > of_b : is_larger(a, b);
  };
  std::vector<bool> is_kept(hull.facet_count(), true);
  std::vector<std::uint32_t> ids(hull.facet_count());
  std::iota(ids.begin(), ids.end(), 0U);
  if (options.largest && options.measure != SelectionMeasure::kArea) {
    is_kept.assign(is_kept.size(), false);
    const std::vector<FacetId> chosen = options.measure == SelectionMeasure::kVolume
                                            ? choose_for_volume(hull, *options.largest, end)
                                            : choose_for_distance(hull, *options.largest, end, points);
    for (const FacetId facet : chosen) is_kept[facet.value] = true;
  } else if (options.largest) {
    keep_first(*options.largest, ids, is_kept, is_larger);
  }
  if (options.most_merged) keep_first(*options.most_merged, ids, is_kept, is_more_merged);
  if (options.min_area) {
    for (const std::uint32_t id : ids) is_kept[id] = is_kept[id] && area(id) >= *options.min_area;
  }
  return is_kept;
}

}  // namespace

FacetSelection select_facets(const Hull& hull, const SelectionOptions& options, const WorkEnd& end,
                             const PointView* points) {
  const std::vector<bool> is_kept = kept_facets(hull, options, end, points);
  const bool is_chosen = options.largest && options.measure != SelectionMeasure::kArea;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 0; id < hull.facet_count(); ++id) {
    if (is_kept[id]) ids.push_back(id);
  }
  const auto region_of = [&hull](const std::vector<std::uint32_t>& chosen) {
    return find_open_direction_of(hull.normals(), hull.dimension, chosen, hull.subspace_equations);
  };
  FacetSelection selection;
  selection.is_cut_short = is_chosen && end.is_here();
  Boundedness region = region_of(ids);
  if (options.bounded && !region.bounded) {
    const std::vector<std::uint32_t> added =
        complete_to_bounded(hull.normals(), hull.dimension, ids, hull.subspace_equations);
    selection.added = added.size();
    ids.insert(ids.end(), added.begin(), added.end());
    std::sort(ids.begin(), ids.end());
    region = region_of(ids);
  }
  selection.bounded = region.bounded;
  selection.open_direction = std::move(region.direction);
  for (const std::uint32_t id : ids) selection.facets.push_back(FacetId{id});
  return selection;
}

}  // namespace ndhull
