// Hulls by other means: exact arithmetic, CGAL's triangulations, Qhull.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hull/hull_support.h"

namespace ndhull {

/// Facets in rational arithmetic from the definition: every hyperplane through d points that has all others
/// on one side, with all points on it that are vertices. Full rank; degenerate points are no trouble. For n
/// up to about 14. Rows given twice count as different points: avoid.
std::vector<VertexSet> facets_by_brute_force(const PointSet& set);

/// Facets as simplices: the infinite cells of CGAL's triangulation with exact predicates (Epick_d). Points in
/// general position only; in others a facet is cut into simplices. Full rank.
std::vector<VertexSet> facets_by_cgal(const PointSet& set);

/// Facets that Qhull counts with options "Qx" added to `options`; 0 when it fails.
std::uint64_t facet_count_by_qhull(const PointSet& set, const std::string& options = "");

}  // namespace ndhull
