// The outputs that a command line asks for, looked at before anything is computed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "approx/report.h"

namespace ndhull {

/// What an output holds. The extensions .ext and .ine tell readers that points or halfspaces follow.
enum class OutputKind { kText, kPoints, kPlanes, kNumbers };

/// An output and the option that asks for it; "-" is standard output.
struct NamedOutput {
  std::string_view option;
  std::string path;
  OutputKind kind = OutputKind::kText;
};

/// Adds an output unless `path` is empty, as it is where the option is not given.
void add_output(std::vector<NamedOutput>& outputs, std::string_view option, const std::string& path,
                OutputKind kind = OutputKind::kText);

/// Does one of them go to standard output?
bool use_standard_output(const std::vector<NamedOutput>& outputs);

/// Throws Error kUsage for points to a file .ine, planes to a file .ext, and numbers to either: it would not
/// be read again. Text may go to any.
void check_outputs_fit(const std::vector<NamedOutput>& outputs);

/// Throws Error kUsage when two outputs want the same file, by whatever names, or standard output.
void check_outputs_differ(const std::vector<NamedOutput>& outputs);

/// Says that a file cannot be written, is one that is read, or does not fit, before the time for the result is
/// spent.
/// `inputs`: paths that are read; "-" is standard input, which may be redirected from a file.
/// Throws Error kFileWrite, kUsage.
void check_outputs_are_writable(const std::vector<NamedOutput>& outputs,
                                const std::vector<std::string>& inputs);

/// A path or a list as it is reported: null when it is empty, as it is where the option is not given.
OptionValue text_or_null(const std::string& text);

}  // namespace ndhull
