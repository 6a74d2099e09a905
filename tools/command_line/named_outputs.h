// The outputs that a command line asks for, looked at before anything is computed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "approx/report.h"

namespace ndhull {

/// An output and the option that asks for it; "-" is standard output.
struct NamedOutput {
  std::string_view option;
  std::string path;
};

/// Throws Error kUsage when two outputs want the same file, by whatever names, or standard output.
void check_outputs_differ(const std::vector<NamedOutput>& outputs);

/// Says that a file cannot be written, or is one that is read, before the time for the result is spent.
/// `inputs`: paths that are read; "-" is standard input, which may be redirected from a file.
/// Throws Error kFileWrite, kUsage.
void check_outputs_are_writable(const std::vector<NamedOutput>& outputs,
                                const std::vector<std::string>& inputs);

/// A path or a list as it is reported: null when it is empty, as it is where the option is not given.
OptionValue text_or_null(const std::string& text);

}  // namespace ndhull
