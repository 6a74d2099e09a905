// Planes, and the points that are held against them.
#pragma once

#include <string>
#include <string_view>

#include "tools/io/column_choice.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/point_reader.h"

namespace ndhull {

struct PlanesAndPoints {
  HalfspaceFile planes;
  PointFile points;
};

/// What messages say of them.
struct PlanesAndPointsWords {
  std::string_view command;
  std::string_view points;       ///< what the points are called
  std::string_view remedy = {};  ///< what to do about planes of another dimension, behind "; "
};

/// Reads the planes, then the points.
/// Throws   Error as read_halfspaces and read_points do; kBadHalfspace for a row that holds nowhere; kUsage
///          when their dimensions differ, or both are "-".
PlanesAndPoints read_planes_and_points(const std::string& planes_path, const std::string& points_path,
                                       const ColumnChoice& columns, const PlanesAndPointsWords& words);

}  // namespace ndhull
