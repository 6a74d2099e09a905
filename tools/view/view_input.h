// The hull that a picture is of: computed from points, or read back from a report with its list of facets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "approx/drawing/section.h"
#include "approx/hull.h"
#include "core/id_rows.h"
#include "tools/io/point_reader.h"

namespace ndhull {

/// What is drawn, and what is said about it.
struct ViewedHull {
  std::string points_name;  ///< file name without folders, for the title
  PointFile points;
  std::size_t rank = 0;
  std::string status;  ///< as the report has it
  CentredFacets facets;
  std::vector<PointId> vertices;  ///< ascending
  IdRows facet_vertices;          ///< point ids, a row a facet
  std::vector<double> extents;    ///< of the columns with the unit cube, otherwise empty

  std::size_t dimension() const { return facets.dimension; }
  bool is_unit_cube() const { return !extents.empty(); }
};

/// The viewed form of a hull of these points.
ViewedHull viewed_hull(const Hull& hull, PointFile points);

/// Do these bytes hold a report rather than points? Told by the extension .json or the first letter {.
bool is_report(const FileBytes& bytes, const std::string& path);

/// Reads a report of `ndhull hull --report FILE --facet-list` and the points it names.
///
/// Points    options.columns of input.path as it stands, or beside the report when it is relative and not
///           there.
/// Throws    Error kBadHeader for text that is no such report; kUsage when it has no facet list or its points
///           came from standard input; kWrongCount when the points are others than the report's; kFileMissing
///           and what read_points throws for the points.
ViewedHull read_report(const FileBytes& bytes, const std::string& path);

}  // namespace ndhull
