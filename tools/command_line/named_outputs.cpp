#include "tools/command_line/named_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "tools/io/file_bytes.h"
#include "tools/io/output_file.h"

namespace ndhull {
namespace {

/// By links, other spellings, and while there is no such file yet. Of what is no regular file (a terminal, a
/// pipe, /dev/null) only the names count: it can be read and written by several.
bool is_same_place(const std::string& one, const std::string& other) {
  namespace fs = std::filesystem;
  if (one == other) return true;
  if (one == "-" || other == "-") return false;
  std::error_code failed;
  if (fs::exists(one, failed) || fs::exists(other, failed))
    return fs::is_regular_file(one, failed) && fs::equivalent(one, other, failed) && !failed;
  const fs::path first = fs::weakly_canonical(fs::absolute(one, failed), failed);
  return !failed && first == fs::weakly_canonical(fs::absolute(other, failed), failed) && !failed;
}

bool is_regular_file(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

void check_input_is_kept(const NamedOutput& output, const std::string& input) {
  if (output.path == "-") return;
  const std::string read = input == "-" ? "/dev/stdin" : input;
  if (!is_regular_file(read) || !is_same_place(output.path, read)) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("{}: found {}, which is the input{}, expected another file; give it another name",
                          output.option, output.path, output.path == input ? "" : " " + display_name(input)));
}

std::string_view content_of(OutputKind kind) {
  switch (kind) {
    case OutputKind::kText: return "text";
    case OutputKind::kPoints: return "points";
    case OutputKind::kPlanes: return "planes";
    case OutputKind::kNumbers: return "numbers";
  }
  return "text";
}

}  // namespace

void add_output(std::vector<NamedOutput>& outputs, std::string_view option, const std::string& path,
                OutputKind kind) {
  if (!path.empty()) outputs.push_back({option, path, kind});
}

bool use_standard_output(const std::vector<NamedOutput>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [](const NamedOutput& output) { return output.path == "-"; });
}

void check_outputs_fit(const std::vector<NamedOutput>& outputs) {
  for (const NamedOutput& output : outputs) {
    const std::string extension = extension_of(output.path);
    const bool is_points = extension == "ext", is_planes = extension == "ine";
    if (output.kind == OutputKind::kText || !(is_points || is_planes)) continue;
    if (output.kind == (is_points ? OutputKind::kPoints : OutputKind::kPlanes)) continue;
    const std::string_view fitting = output.kind == OutputKind::kPoints   ? ".ext, "
                                     : output.kind == OutputKind::kPlanes ? ".ine, "
                                                                          : "";
    throw Error(
        ErrorCode::kUsage,
        fmt::format("{}: found {}, which readers take for {}, expected a file for {}; name it {}.npy, "
                    ".csv, .tsv or .txt",
                    output.option, output.path,
                    is_points ? "points (V-representation)" : "halfspaces (H-representation)",
                    content_of(output.kind), fitting));
  }
}

void check_outputs_differ(const std::vector<NamedOutput>& outputs) {
  for (std::size_t one = 0; one < outputs.size(); ++one) {
    for (std::size_t other = 0; other < one; ++other) {
      if (!is_same_place(outputs[one].path, outputs[other].path)) continue;
      throw Error(
          ErrorCode::kUsage,
          fmt::format("{} and {}: found both on {}, expected a place for each; give one of them a file",
                      outputs[other].option, outputs[one].option,
                      outputs[one].path == "-" ? "standard output" : outputs[one].path));
    }
  }
}

void check_outputs_are_writable(const std::vector<NamedOutput>& outputs,
                                const std::vector<std::string>& inputs) {
  for (const NamedOutput& output : outputs)
    for (const std::string& input : inputs) check_input_is_kept(output, input);
  check_outputs_fit(outputs);
  for (const NamedOutput& output : outputs) {
    std::error_code ignored;
    const auto status = std::filesystem::status(output.path, ignored);
    // Opening a pipe and closing it again would tell its reader that this is all.
    const bool is_special = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
                            !std::filesystem::is_directory(status);
    if (output.path != "-" && !is_special) const OutputFile probe(output.path);
  }
}

OptionValue text_or_null(const std::string& text) { return text.empty() ? OptionValue() : OptionValue(text); }

}  // namespace ndhull
