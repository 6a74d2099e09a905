// Hulls as text in the formats that Qhull's users know: numbers as "%6.16g ", 0-based indices, the same
// order of facets in all formats of one run.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "approx/hull.h"
#include "core/points.h"
#include "tools/io/attached_points.h"
#include "tools/io/facet_order.h"
#include "tools/io/format_list.h"
#include "tools/io/output_file.h"

namespace ndhull {

/// What the formats print. Hull and points must outlive it.
struct QhullPrint {
  /// `selection`: the facets to print, in this order; all of them when absent.
  QhullPrint(const Hull& hull, const PointView& points,
             std::optional<std::span<const FacetId>> selection = std::nullopt);

  const Hull& hull;
  PointView points;
  std::vector<FacetId> facets;      ///< to print
  std::vector<std::int64_t> label;  ///< of every facet: its position in `facets`, or minus its printed id
  std::vector<PointId> vertices;    ///< of the facets to print, ascending
  FacetOrder order;

  /// What FI and FP call a facet: minus that is another number.
  static std::int64_t printed_id(FacetId facet) { return std::int64_t{facet.value} + 1; }

  // What Qhull's own command line may ask for besides (tools/qhull/qhull_run.cpp).
  /// Points of the facets to print that are no vertices (Qc, Qi), and those of other facets, which FN has.
  std::vector<AttachedPoint> attached, attached_elsewhere;
  std::string invocation;   ///< "rbox ... | qhull ...": FQ, FD before its planes, the summary
  bool writes_cdd = false;  ///< FD: n, Fo, Fi and p as cdd reads them
};

/// What `ndhull hull --format` has: n Fo Fi FV Fx Fv Fn FN i o p Fa FA FS Fs FC s.
FormatList hull_formats();

/// Splits a list of these; throws as split_formats.
std::vector<std::string> split_qhull_formats(std::string_view list);

/// Writes one format to `file`: of those, or Fc Ft Fm FI FP FQ. s and FA belong to the summary and write
/// nothing here.
///
/// Lengths    everything in input units; outer and inner offsets are converted when the hull was measured
///            in the unit cube.
/// Differs from Qhull   i numbers the points inside non-simplicial facets (dimension 4 and more) from the
///            number of input points on, as Ft does: Qhull counts from its vertices, which collides with
///            indices of points. Fv lists vertices in the order of the neighbours of Fn.
/// Throws     Error kUsage for an unknown name, kFileWrite.
void write_qhull_format(OutputFile& file, std::string_view format, const QhullPrint& print);

/// Writes the formats one after the other to `file`; the summary stands where s or FA does first.
void write_qhull_formats(OutputFile& file, std::span<const std::string> formats, const QhullPrint& print);

/// What the summary says beside counts and distances.
struct QhullSummaryParts {
  bool with_area = false;        ///< area and volume
  bool counts_attached = false;  ///< the points kept by Qc and Qi
  double seconds = 0.0;          ///< of the hull
  std::string run = {};          ///< lines about the run
};
/// The summary under Qhull's names, which scripts look for. The distances are certified.
std::string qhull_summary(const QhullPrint& print, const QhullSummaryParts& parts);

/// The widest offsets of all facets in input units.
struct InputOffsets {
  double outer = 0.0;
  double inner = 0.0;
};
InputOffsets input_offsets(const Hull& hull);

/// Mean of the facet's vertices, moved along the normal into its plane.
std::vector<double> centrum(const QhullPrint& print, FacetId facet);
std::vector<double> centrum(const PointView& points, std::span<const PointId> vertices,
                            std::span<const double> normal, double offset);
/// Numbers as "%6.16g ", and a newline.
void print_row(OutputFile& file, std::span<const double> numbers);

// The formats by what they are tables of.
void write_planes_format(OutputFile& file, std::string_view format, const QhullPrint& print);  // n Fo Fi
void write_facet_areas(OutputFile& file, const QhullPrint& print);                             // Fa
void write_facet_centrums(OutputFile& file, const QhullPrint& print);                          // FC
void write_facet_vertices(OutputFile& file, const QhullPrint& print);                          // Fv
void write_facet_neighbours(OutputFile& file, const QhullPrint& print);                        // Fn
void write_facet_simplices(OutputFile& file, const QhullPrint& print);                         // i
void write_off(OutputFile& file, const QhullPrint& print);                                     // o
void write_triangulated_off(OutputFile& file, const QhullPrint& print);                        // Ft
void write_merge_counts(OutputFile& file, const QhullPrint& print);                            // Fm
void write_facet_ids(OutputFile& file, const QhullPrint& print);                               // FI
void write_attached_points(OutputFile& file, const QhullPrint& print);                         // Fc
void write_nearest_vertices(OutputFile& file, const QhullPrint& print);                        // FP
void write_size(OutputFile& file, const QhullPrint& print);                                    // FS
void write_statistics(OutputFile& file, const QhullPrint& print);                              // Fs
void write_mean_vertex(OutputFile& file, const QhullPrint& print);                             // FV
void write_extreme_points(OutputFile& file, const QhullPrint& print);                          // Fx
void write_vertex_coordinates(OutputFile& file, const QhullPrint& print);                      // p
void write_vertex_facets(OutputFile& file, const QhullPrint& print);                           // FN

}  // namespace ndhull
