// ndhull generate FAMILY, and ndhull rbox "ARGUMENTS": point sets to a file or standard output.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/points/generate.h"

namespace ndhull {

/// Writes the points of `options` as they are made: memory for one block.
///
/// Formats   .npy (float32 or float64 as options.scalar says), .csv, .tsv, .ext, else Qhull text. Text has the
///           shortest digits that read back as the same numbers. "-": Qhull text on standard output.
/// Throws    Error as generate, kFileWrite.
void write_generated(const std::string& path, const GenerateOptions& options);

/// Writes what `rbox ARGUMENTS` prints; to .npy, .csv, .tsv and .ext the same numbers in that format.
/// Throws    Error as rbox_text, kFileWrite.
void write_rbox(const std::string& path, const std::string& arguments);

/// Add the commands, which write when they are chosen and parsed.
void add_generate_command(CLI::App& app);
void add_rbox_command(CLI::App& app);

}  // namespace ndhull
