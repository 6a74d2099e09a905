#include "tools/io/planes_and_points.h"

#include <fmt/format.h>

#include "core/error.h"

namespace ndhull {

PlanesAndPoints read_planes_and_points(const std::string& planes_path, const std::string& points_path,
                                       const ColumnChoice& columns, const PlanesAndPointsWords& words) {
  if (planes_path == "-" && points_path == "-") {
    throw Error(
        ErrorCode::kUsage,
        fmt::format("{}: found - for both, expected one of them in a file: standard input is read once",
                    words.command));
  }
  PlanesAndPoints read;
  read.planes = read_halfspaces(planes_path);
  read.planes.require_possible();
  read.points = read_points(points_path, columns);
  if (read.planes.dimension == read.points.view().dimension) return read;
  throw Error(ErrorCode::kUsage,
              fmt::format("{}: found planes in {}-d, expected {}-d as the {} of {}{}{}", read.planes.path,
                          read.planes.dimension, read.points.view().dimension, words.points, read.points.path,
                          words.remedy.empty() ? "" : "; ", words.remedy));
}

}  // namespace ndhull
