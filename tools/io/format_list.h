// The lists of --format: which formats a command has, and which of them are asked for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ndhull {

/// The formats that a command has.
struct FormatList {
  std::vector<std::string_view> names;  ///< in the order of help and messages
  std::string_view example;             ///< some of them, as they are written
  /// Formats that are about the whole hull: `ndhull hull` has them, this command has not.
  std::vector<std::string_view> of_whole_hull = {};

  /// "n Fo Fi".
  std::string joined() const;
  /// Throws Error kUsage: there is no such format, and `names` are those that there are.
  [[noreturn]] void refuse(std::string_view name) const;
};

/// Splits what is written behind --format, like "n,Fx o", at commas and blanks.
/// Throws Error kUsage for the first name that is not in `known`, and for a list of none.
std::vector<std::string> split_formats(std::string_view list, const FormatList& known);

}  // namespace ndhull
