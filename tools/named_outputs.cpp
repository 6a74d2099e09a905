#include "tools/named_outputs.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "tools/output_file.h"

namespace ndhull {

void check_outputs_differ(const std::vector<NamedOutput>& outputs) {
  for (std::size_t one = 0; one < outputs.size(); ++one) {
    for (std::size_t other = 0; other < one; ++other) {
      if (outputs[one].path != outputs[other].path) continue;
      throw Error(
          ErrorCode::kUsage,
          fmt::format("{} and {}: found both on {}, expected a place for each; give one of them a file",
                      outputs[other].option, outputs[one].option,
                      outputs[one].path == "-" ? "standard output" : outputs[one].path));
    }
  }
}

void check_outputs_are_writable(const std::vector<NamedOutput>& outputs) {
  for (const NamedOutput& output : outputs) {
    std::error_code ignored;
    const auto status = std::filesystem::status(output.path, ignored);
    // Opening a pipe and closing it again would tell its reader that this is all.
    const bool is_special = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
                            !std::filesystem::is_directory(status);
    if (output.path != "-" && !is_special) const OutputFile probe(output.path);
  }
}

OptionValue path_or_null(const std::string& path) { return path.empty() ? OptionValue() : OptionValue(path); }

}  // namespace ndhull
