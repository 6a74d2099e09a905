// What the commands' options have in common: checks of what is written, with messages that say what to write,
// and the options that several commands have.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "approx/planes/written_planes.h"
#include "tools/io/column_choice.h"

namespace ndhull {

/// A whole number in least .. most, in digits only: CLI11 alone would wrap -1 to the largest one.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most = UINT64_MAX);
/// A finite number above 0.
CLI::Validator positive_number();
/// A finite number, 0 or above.
CLI::Validator number_from_0();
/// A finite number from least to most.
CLI::Validator number_from_to(double least, double most);
/// One of these words.
CLI::Validator one_of(std::vector<std::string> words);
/// A path, which is not the empty word.
CLI::Validator path_name();
/// Not empty, as what a shell makes of a variable that is not set.
CLI::Validator some_text();

/// Adds an option that takes the names, as to_string has them, of some values of an enumeration.
template <class Enum>
CLI::Option* add_word_option(CLI::App& command, const std::string& name, Enum& chosen,
                             const std::vector<Enum>& values, const std::string& help) {
  std::vector<std::string> words;
  for (const Enum value : values) words.emplace_back(to_string(value));
  const auto choose = [&chosen, values](const std::string& word) {
    for (const Enum value : values) {
      if (word == to_string(value)) chosen = value;
    }
  };
  return command.add_option_function<std::string>(name, choose, help)->check(one_of(std::move(words)));
}

/// Adds a path that stands behind the command without a name of its own; "-" is standard input. It may be
/// left out unless the caller says that it is required.
CLI::Option* add_path_argument(CLI::App& command, const std::string& name, std::string& path,
                               const std::string& help);
/// Adds POINTS.
CLI::Option* add_points_argument(CLI::App& command, std::string& path);

/// Adds an option that says where something is written.
CLI::Option* add_file_option(CLI::App& command, const std::string& name, std::string& path,
                             const std::string& help);
/// Adds --report.
CLI::Option* add_report_option(CLI::App& command, std::string& path,
                               const std::string& help = "write the report, JSON");

/// Adds --threads.
void add_threads_option(CLI::App& command, unsigned& threads);

/// What --seed is of where a hull is built, for add_seed_option.
inline constexpr const char* kOfShifts = "of the shifts below roundoff that settle degenerate cases";
/// Adds --seed; `of_what` says of which numbers. The help's default is what `seed` holds.
void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& of_what);

/// Adds --progress and --quiet.
void add_progress_options(CLI::App& command, bool& progress, bool& quiet);

/// Adds --columns, of the points.
CLI::Option* add_columns_option(CLI::App& command, ColumnChoice& columns);

/// Adds --planes, --plane-kind and --equations, of the facets of a hull.
void add_plane_options(CLI::App& command, std::string& path, PlaneKind& kind, bool& equations);

/// The example at the end of a command's help.
std::string example(const std::string& text);

}  // namespace ndhull
