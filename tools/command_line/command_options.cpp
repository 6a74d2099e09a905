#include "tools/command_line/command_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/machine/arena.h"
#include "tools/io/text_source.h"

namespace ndhull {
namespace {

template <class Fits>
CLI::Validator number_that(const Fits& fits, const std::string& wanted) {
  const auto check = [fits, wanted](const std::string& text) -> std::string {
    double value = 0.0;
    const char* const end = text.data() + text.size();
    // What is no finite number is null.
    if (parse_number(text.data(), end, value) == end && fits(value)) return {};
    return fmt::format("found \"{}\", expected {}", printable(text), wanted);
  };
  return {check, ""};
}

}  // namespace

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const auto check = [least, most](const std::string& text) -> std::string {
    std::size_t value = 0;
    const char* const end = text.data() + text.size();
    const bool is_number = parse_count(text.data(), end, value) == end && !text.empty();
    if (is_number && value >= least && value <= most) return {};
    const std::string range =
        most == UINT64_MAX ? fmt::format("of at least {}", least) : fmt::format("from {} to {}", least, most);
    return fmt::format("found \"{}\", expected a whole number {}, in digits", printable(text), range);
  };
  return {check, ""};
}

CLI::Validator positive_number() {
  return number_that([](double value) { return value > 0.0; }, "a number above 0");
}

CLI::Validator number_from_0() {
  return number_that([](double value) { return value >= 0.0; }, "a number, 0 or above");
}

CLI::Validator number_from_to(double least, double most) {
  return number_that([least, most](double value) { return least <= value && value <= most; },
                     fmt::format("a number from {} to {}", least, most));
}

CLI::Validator one_of(std::vector<std::string> words) {
  const auto check = [words = std::move(words)](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    return fmt::format("found \"{}\", expected {}", printable(text), fmt::join(words, " or "));
  };
  return {check, ""};
}

CLI::Validator path_name() {
  const auto check = [](const std::string& text) -> std::string {
    return text.empty() ? "found an empty name, expected a file, or - for standard input or output" : "";
  };
  return {check, ""};
}

CLI::Validator some_text() {
  const auto check = [](const std::string& text) -> std::string {
    return text.empty() ? "found an empty value; write it, or leave the option out" : "";
  };
  return {check, ""};
}

CLI::Option* add_path_argument(CLI::App& command, const std::string& name, std::string& path,
                               const std::string& help) {
  return command.add_option(name, path, help)->type_name("")->check(path_name());
}

CLI::Option* add_points_argument(CLI::App& command, std::string& path) {
  return add_path_argument(command, "POINTS", path, "points: a file, or - for standard input");
}

CLI::Option* add_file_option(CLI::App& command, const std::string& name, std::string& path,
                             const std::string& help) {
  return command.add_option(name, path, help)->type_name("FILE")->check(path_name());
}

CLI::Option* add_report_option(CLI::App& command, std::string& path, const std::string& help) {
  return add_file_option(command, "--report", path, help);
}

void add_threads_option(CLI::App& command, unsigned& threads) {
  command
      .add_option("--threads", threads, "0, the default: all cores; the result is the same for any number")
      ->type_name("N")
      ->check(whole_number(0, kMostThreads));
}

void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& of_what) {
  command.add_option("--seed", seed, fmt::format("{}; default {}", of_what, seed))
      ->type_name("S")
      ->check(whole_number(0));
}

void add_progress_options(CLI::App& command, bool& progress, bool& quiet) {
  command.add_flag("--progress", progress, "show progress though standard error is no terminal");
  command.add_flag("--quiet", quiet, "no progress, no summary");
}

CLI::Option* add_columns_option(CLI::App& command, ColumnChoice& columns) {
  return command
      .add_option_function<std::string>(
          "--columns", [&columns](const std::string& list) { columns = ColumnChoice(list); },
          "the columns that are coordinates, by number from 1 or by name of the header, as in mass,4,6-9; "
          "others of a table may hold anything")
      ->type_name("LIST");
}

void add_plane_options(CLI::App& command, std::string& path, PlaneKind& kind, bool& equations) {
  CLI::Option* const planes = add_file_option(command, "--planes", path,
                                              "write the facets' planes a.x + b <= 0, rows a b in input "
                                              "units: .npy, .csv, .tsv, .ine or Qhull text");
  add_word_option(command, "--plane-kind", kind, {PlaneKind::kOuter, PlaneKind::kMean, PlaneKind::kInner},
                  "outer (no input point is above; default), mean, or inner (no vertex is below)")
      ->type_name("KIND")
      ->needs(planes);
  command
      .add_flag("--equations", equations,
                "of flat data, write two opposite planes more for each equation of their subspace")
      ->needs(planes);
}

std::string example(const std::string& text) { return "Example: " + text; }

}  // namespace ndhull
