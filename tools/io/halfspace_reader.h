// Halfspaces, and the planes of a hull, from a file or standard input.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/io/file_bytes.h"

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
};

/// Reads halfspaces.
///
/// Formats   .ine (H-representation of cdd and lrs: a row b0 a' says b0 + a'.x >= 0, and is turned round),
///           .npy (rows normal, offset), otherwise text: Qhull's (`n`, `Fo`: dimension + 1, count, rows;
///           a point "dimension 1" may stand in front, as option FV writes it), or columns.
/// Throws    Error as read_points does; kBadHeader also for linearity (equations); kBadHalfspace for a
///           row whose normal is zero.
HalfspaceFile read_halfspaces(const std::string& path);

/// The same for bytes at hand; `path` tells the extension and the name in messages.
HalfspaceFile parse_halfspaces(FileBytes bytes, const std::string& path);

}  // namespace ndhull
