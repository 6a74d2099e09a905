#include "tools/io/format_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace ndhull {
namespace {

bool has(const std::vector<std::string_view>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string FormatList::joined() const { return fmt::format("{}", fmt::join(names, " ")); }

void FormatList::refuse(std::string_view name) const {
  if (has(of_whole_hull, name)) {
    throw Error(ErrorCode::kUsage,
                fmt::format("--format: found \"{}\", which is about the whole hull, expected some of {}; use "
                            "ndhull hull for it",
                            name, joined()));
  }
  throw Error(ErrorCode::kUsage,
              fmt::format("format: found \"{}\", expected some of {}; correct the list", name, joined()));
}

std::vector<std::string> split_formats(std::string_view list, const FormatList& known) {
  std::vector<std::string> formats;
  while (!list.empty()) {
    const std::size_t length = std::min(list.find_first_of(", \t\r\n\v\f"), list.size());
    const std::string_view name = list.substr(0, length);
    if (!name.empty() && !has(known.names, name)) known.refuse(name);
    if (!name.empty()) formats.emplace_back(name);
    list.remove_prefix(std::min(length + 1, list.size()));
  }
  if (!formats.empty()) return formats;
  throw Error(ErrorCode::kUsage,
              fmt::format("--format: found no format, expected some; write them like \"{}\"", known.example));
}

}  // namespace ndhull
