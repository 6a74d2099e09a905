// Indices of points to a file.
#pragma once

#include <span>
#include <string>

#include "core/ids.h"

namespace ndhull {

/// Writes indices in the order given: .npy as int64 of shape (n,), .csv and .tsv one a line, anything else as
/// text, the count and one index a line. Target as OutputFile: "-" is standard output (text).
/// Throws Error kFileWrite.
void write_indices(const std::string& path, std::span<const PointId> indices);

}  // namespace ndhull
