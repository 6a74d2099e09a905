// Halfspaces, and the planes of a hull, from a file or standard input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/io/file_bytes.h"
#include "tools/io/qhull_text_reader.h"

namespace ndhull {

/// Halfspaces a.x + b <= 0. None at all, as the planes of an empty selection are, leave the whole space.
///
/// Shapes  rows: count x (dimension + 1), each a_1 .. a_d, b. The normals are as in the file: of any
///         length but zero.
struct HalfspaceFile {
  std::size_t dimension = 0;
  std::size_t count = 0;
  std::vector<double> rows;
  std::optional<std::vector<double>> interior_point;  ///< when the file has one in front
  std::string path;                                   ///< as given, "standard input" for "-"

  /// Equations of an .ine file are two halfspaces, and rows that hold everywhere are none. Then the row of
  /// the file, from 0, that each halfspace is from; empty where they are the rows.
  std::vector<std::uint32_t> file_row;
  std::vector<bool> is_reversed;  ///< as file_row: the second halfspace of an equation
  std::size_t file_row_count = 0;
  /// A row of the file that holds nowhere: its normal is zero, and its offset has this size.
  struct ImpossibleRow {
    std::uint32_t row;
    double offset;  ///< > 0 as a halfspace is written here; an equation may have it < 0
  };
  std::optional<ImpossibleRow> impossible;

  std::uint32_t row_of(std::size_t halfspace) const {
    return file_row.empty() ? static_cast<std::uint32_t>(halfspace) : file_row[halfspace];
  }
  /// Throws kBadHalfspace when there is an impossible row: the planes of the others tell nothing then.
  void require_possible() const;
};

/// Reads halfspaces.
///
/// Formats   .ine (H-representation of cdd and lrs: a row b0 a' says b0 + a'.x >= 0, and is turned round),
///           .npy (rows normal, offset), otherwise text: Qhull's (`n`, `Fo`: dimension + 1, count, rows;
///           a point "dimension 1" may stand in front, as option FV writes it), or columns. `kind` says
///           which of these a name without an extension that tells is taken for.
/// Throws    Error as read_points does; kBadHalfspace for a row whose normal is zero, but in .ine files.
HalfspaceFile read_halfspaces(const std::string& path);

/// The same for bytes at hand; `path` tells the extension and the name in messages.
HalfspaceFile parse_halfspaces(FileBytes bytes, const std::string& path,
                               TextKind kind = TextKind::kByContent);

}  // namespace ndhull
