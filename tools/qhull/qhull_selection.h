// Which facets Qhull's print options keep: Pdk:v PDk:v, then PAn PFn PMn, then PG.
#pragma once

#include <vector>

#include "approx/hull.h"
#include "tools/qhull/qhull_options.h"

namespace ndhull {

struct QhullSelection {
  std::vector<FacetId> facets;  ///< to print, ascending
  /// PA, PF or PM chose facets whose outer planes bound no region: a unit vector along which none is met.
  std::vector<double> open_direction;
};

/// Does the command keep some of the facets only?
bool selects_facets(const QhullCommand& command);

/// Chooses the facets.
///
/// Order     the facets within all bounds of their normals; with Pg and none of them, the one least outside
///           the bounds. Of these the n largest, the n most merged, those of at least some area: those that
///           all of these options keep. With PG the neighbours of what is kept, with Pg as well that itself.
/// Ties      the larger area, then the lower id.
/// Throws    Error kUsage for a bound on a coordinate that the points do not have.
QhullSelection select_facets(const Hull& hull, const QhullCommand& command);

}  // namespace ndhull
