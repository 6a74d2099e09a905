// An intersection of halfspaces as text: Qhull's formats, a summary, a report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "approx/polytope/halfspace_intersection.h"
#include "tools/io/format_list.h"
#include "tools/io/output_file.h"

namespace ndhull {

/// Writes the formats in the order asked for, as qhalf prints them: Fp (dimension, count, vertices), Fv and i
/// (of each vertex the halfspaces in it, i without their number and oriented), Fn (its neighbours; the i-th is
/// opposite the i-th halfspace of Fv where as many as dimensions meet), Fx (halfspaces that
/// are not redundant; in 2-d counterclockwise), FN (of each halfspace its vertices). Ids count from 0.
/// Equalities of a flat intersection are left out.
///
/// Throws  Error kUsage for a name that is none of these, before anything is written; kFileWrite.
void write_intersection_formats(OutputFile& file, const std::vector<std::string>& formats,
                                const HalfspaceIntersection& intersection);

/// The formats that there are: Fp Fv Fn Fx FN i.
FormatList intersection_formats();

/// They and what they are, for help: "Fp (vertices) Fv (their halfspaces) ..".
std::string describe_intersection_formats();

/// A few lines for people: what it is, what proves it, how large it is.
std::string intersection_summary(const HalfspaceIntersection& intersection, const std::string& path);

/// "unbounded along (1, 0, 0)", and the like: why there are no vertices.
std::string describe_without_vertices(const HalfspaceIntersection& intersection);

/// What the report says and the intersection does not know.
struct IntersectionReportContext {
  std::string input_path;
  IntersectionOptions options;
  double read_seconds = 0.0, write_seconds = 0.0, total_seconds = 0.0;
  bool vertex_list = false;
};

/// The report, a JSON object: `status` bounded, unbounded, empty or lower-dimensional, with the proof of
/// each; counts, volume and area; with vertex_list every vertex, its halfspaces and neighbours.
std::string intersection_report(const HalfspaceIntersection& intersection,
                                const IntersectionReportContext& context);

}  // namespace ndhull
