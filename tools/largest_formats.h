// Qhull's text formats of the facets that ndhull largest finds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "approx/planes/written_planes.h"
#include "approx/rays/largest_facets.h"
#include "core/points.h"
#include "tools/io/format_list.h"
#include "tools/io/output_file.h"

namespace ndhull {

/// What `ndhull largest --format` has: n Fo Fi FV Fx Fv Fa FC p s. The others are about all facets of the
/// hull, which is not built, or about neighbours among them.
FormatList largest_formats();

/// Rows normal, offset of one kind of planes of all facets; `largest` are the largest coordinates of the
/// points.
/// Throws Error kNotFinite for an offset that is no double.
std::vector<double> plane_rows(const LargestFacets& found, std::span<const double> largest, PlaneKind kind);

/// Ascending, each once.
std::vector<PointId> vertices_of(const LargestFacets& found);

/// What the formats print besides the facets.
struct LargestPrint {
  const LargestFacets& found;
  PointView points;
  std::vector<double> largest;  ///< coordinates
  std::string summary;          ///< for s
};

/// Writes the formats in the order asked for, as write_qhull_formats; facets are in the order they were found
/// in, the largest first.
void write_largest_formats(OutputFile& file, const std::vector<std::string>& formats,
                           const LargestPrint& print);

}  // namespace ndhull
