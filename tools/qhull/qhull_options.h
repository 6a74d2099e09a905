// Qhull's command line: option strings like "Qx W1e-1 C1e-2 PA10 FV Fo", read into what they ask for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "approx/selection/facet_selection.h"

namespace ndhull {

/// Whose options are read.
enum class QhullProgram {
  kQhull,  ///< hulls of points
  kQhalf,  ///< intersections of halfspaces
};

/// Qbk:n, QBk:n: a bound that a column of the input is scaled to.
struct ColumnBound {
  std::size_t column = 0;
  bool is_upper = false;
  double value = 0.0;
};

/// Pdk:v, PDk:v: facets are kept whose normal has a component k of at least, or at most, v.
struct NormalBound {
  std::size_t column = 0;
  bool is_least = true;
  double value = 0.0;
};

/// What an option string asks for. Options that only steer how Qhull goes about it are accepted and leave no
/// trace.
struct QhullCommand {
  QhullProgram program = QhullProgram::kQhull;
  std::string text;  ///< the words, joined by one blank

  // Accuracy; lengths after scaling.
  std::optional<double> outside_width;   ///< Wn, else 2n of Vn
  std::optional<double> coplanar_depth;  ///< Un: kept points less than this below a facet are coplanar
  double centrum_radius = 0.0;           ///< Cn, C-n: the larger
  double max_cosine = 2.0;               ///< An, A-n: the smaller; above 1: not given
  bool is_merged = true;                 ///< false: Q0, QJ, without C or A
  bool triangulate = false;              ///< Qt
  std::optional<double> joggle;          ///< QJn; 0: the default size
  std::uint64_t seed = 1;                ///< of the joggle: QR-n

  // Input.
  std::string input_path = "-";        ///< TI
  std::vector<double> interior_point;  ///< Hn,n,..
  bool is_cdd = false;                 ///< Fd: the input must be a cdd file, of points where it is silent
  bool unit_cube = false;              ///< QbB
  bool scale_last = false;             ///< Qbb
  std::vector<ColumnBound> column_bounds;
  bool keep_coplanar = false, keep_interior = false;  ///< Qc, Qi

  // Selection.
  SelectionOptions selection;  ///< PAn, PFn, PMn
  std::vector<NormalBound> normal_bounds;
  bool keeps_closest = false;  ///< Pg, PA, PF, PM: without a facet within the bounds the closest one is kept
  bool prints_neighbours = false;  ///< PG: the neighbours of the facets kept instead of these ..
  bool prints_kept = false;        ///< Pg: .. or as well as these

  // Output.
  std::string output_path = "-";               ///< TO
  std::vector<std::string> formats;            ///< in the order asked for
  bool writes_cdd = false;                     ///< FD: planes and points as cdd writes them
  bool has_summary = false, has_size = false;  ///< s, FA
  bool lists_options = false;                  ///< FO
  bool has_statistics = false;                 ///< Ts
  bool diagnostics_to_stdout = false;          ///< Tz
  bool hides_warnings = false;                 ///< Pp

  // Control.
  bool verify = false;                ///< Tv
  std::uint64_t progress_facets = 0;  ///< TFn: a line each time so many simplices were made; 0: none
  std::uint64_t reruns = 0;           ///< TRn
};

/// Reads an option string.
///
/// Grammar   Qhull's: words parted by blanks; after F, P, Q and T further letters of the same group may
///           follow ("FxSo", "Qb2:-1e-14B2:1e-14"); other letters may be joined ("sn"); a leading '-' is
///           skipped.
/// Throws    Error kUsage, one line: an option that is unknown, lacks its number, or cannot be honoured, with
///           the nearest that can.
QhullCommand parse_qhull_command(std::string_view options, QhullProgram program);

}  // namespace ndhull
