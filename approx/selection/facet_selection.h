// Some of a hull's facets, as Qhull's PAn, PFn and PMn choose them, and the few more that their outer planes
// need to bound a region.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "approx/hull.h"
#include "approx/work_end.h"
#include "core/points.h"

namespace ndhull {

/// What `largest` stands for.
enum class SelectionMeasure {
  kArea,      ///< the facets of largest area
  kVolume,    ///< those whose outer planes together enclose little (approx/selection/volume_selection.h)
  kDistance,  ///< those whose outer planes meet nowhere far from the hull (approx/selection/outer_distance.h)
};

/// Which facets to keep: those that every option that is set keeps. Without any: all of them.
struct SelectionOptions {
  std::optional<std::uint64_t> largest = {};           ///< so many of largest area (PAn), or ..
  SelectionMeasure measure = SelectionMeasure::kArea;  ///< .. by another measure
  std::optional<double> min_area = {};                 ///< [area] those of at least this area (PFn)
  std::optional<std::uint64_t> most_merged = {};       ///< so many of most simplices (PMn)
  bool bounded = false;  ///< add the fewest further facets that make the outer planes bound a region

  bool is_set() const { return largest || min_area || most_merged; }
};

struct FacetSelection {
  std::vector<FacetId> facets;  ///< ascending, the added ones among them
  std::size_t added = 0;        ///< of these: facets that only close the region
  bool is_cut_short = false;    ///< `end` came before the choice for volume or distance was made
  bool bounded = false;  ///< do the outer planes of `facets` bound a region (of a flat hull: within it)?
  std::vector<double> open_direction;  ///< not bounded: a unit vector along which none of the planes is met
};

/// Selects facets; the hull does not change.
///
/// Ties      of equal area, or equally many simplices, the larger area and then the lower id is kept.
/// Added     as few as complete_to_bounded finds (approx/geometry/boundedness.h), each of which is needed.
///           Facets of a hull always can bound a region. A hull without facets is a point, and bounded.
/// End       of choosing for volume or distance, which can take many seconds: facets still missing then are
///           the largest. All else takes little.
/// points    those that the hull was made from: a choice for distance compares distances with them.
/// Throws    Error kUsage as choose_for_volume and choose_for_distance do.
/// Cost      O(facets) and a sort of those kept; a few linear programs over the planes selected, with
///           `bounded` over all planes when the selection is open.
FacetSelection select_facets(const Hull& hull, const SelectionOptions& options, const WorkEnd& end = {},
                             const PointView* points = nullptr);

}  // namespace ndhull
