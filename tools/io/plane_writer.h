// Planes of a hull, or any halfspaces, to a file that read_halfspaces and other programs read.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace ndhull {

/// Gives row `index`: fills dimension + 1 numbers, normal and offset with normal.x + offset <= 0 inside.
/// Called once for each row, in order.
using FillPlane = std::function<void(std::size_t index, double* row)>;

/// Writes `count` planes.
///
/// Formats   .ine  H-representation, rows -offset -normal, real numbers: for cdd; for lrs by its float2rat
///           .npy  float64, rows normal offset
///           .csv, .tsv  a table without names, rows normal offset; of no planes, names
///           else  Qhull text as option `n` prints it: dimension + 1, count, rows normal offset
///           All of them read back as the same doubles: text has 17 digits, one more than Qhull prints,
///           because a certified plane that is rounded is no longer certified.
/// Target    as OutputFile: "-" is standard output (Qhull text).
/// Throws    Error kFileWrite; whatever `planes` throws. Nothing is left behind then.
/// Cost      memory for one row.
void write_planes(const std::string& path, std::size_t count, std::size_t dimension, const FillPlane& planes);

}  // namespace ndhull
