#include "tools/io/column_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "tools/io/text_source.h"

namespace ndhull {
namespace {

/// Reads "4" or "6-9": first and last column from 1, or two zeros.
std::pair<std::size_t, std::size_t> read_range(const std::string& item) {
  const char* const end = item.data() + item.size();
  std::size_t first = 0;
  const char* const place = parse_count(item.data(), end, first);
  if (place == nullptr) return {0, 0};
  if (place == end) return {first, first};
  std::size_t last = 0;
  if (*place != '-' || parse_count(place + 1, end, last) != end) return {0, 0};
  return {first, last};
}

/// The columns of a file in words, cut where they are many.
std::string describe(std::span<const std::string> names, std::size_t columns) {
  std::string text = fmt::format("a number from 1 to {}", columns);
  if (names.empty()) return text + " (the file has no header)";
  constexpr std::size_t kMostNames = 8;
  text += " or a name of the header: ";
  for (std::size_t k = 0; k < std::min(names.size(), kMostNames); ++k)
    text += (k == 0 ? "" : ", ") + (names[k].empty() ? "(no name)" : printable(names[k]));
  return names.size() > kMostNames ? text + ", ..." : text;
}

/// The column from 0 that has this name, or the number of columns. A name that could be another column is an
/// error.
std::size_t find_name(const std::string& item, std::span<const std::string> names, const std::string& file) {
  const auto named = std::find(names.begin(), names.end(), item);
  const auto column = static_cast<std::size_t>(named - names.begin());
  if (named == names.end()) return column;
  const auto again = std::find(named + 1, names.end(), item);
  if (again != names.end()) {
    throw Error(
        ErrorCode::kUsage,
        fmt::format("--columns: found \"{}\", the name of columns {} and {} of {}, expected one column; "
                    "give its number",
                    printable(item), column + 1, again - names.begin() + 1, file));
  }
  const auto [number, last] = read_range(item);
  if (number != 0 && number == last && number <= names.size() && number != column + 1) {
    throw Error(
        ErrorCode::kUsage,
        fmt::format("--columns: found \"{0}\", the name of column {1} and the number of another of {2}, "
                    "expected one column; write {1}-{1} or {3}-{3}",
                    printable(item), column + 1, file, number));
  }
  return column;
}

}  // namespace

ColumnChoice::ColumnChoice(std::string list) : list_(std::move(list)) {
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = list_.find(',', begin);
    const std::string item = list_.substr(begin, end == std::string::npos ? end : end - begin);
    if (item.empty()) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("--columns: found \"{}\", expected names or numbers from 1 between commas, as "
                              "in mass,4,6-9",
                              printable(list_)));
    }
    items_.push_back(item);
  }
}

std::vector<std::size_t> ColumnChoice::resolve(std::span<const std::string> names, std::size_t columns,
                                               const std::string& file) const {
  std::vector<std::size_t> chosen;
  const auto choose = [&](std::size_t column) {
    if (std::find(chosen.begin(), chosen.end(), column) != chosen.end()) {
      throw Error(ErrorCode::kUsage, fmt::format("--columns: found column {} of {} twice, expected each once",
                                                 column + 1, file));
    }
    chosen.push_back(column);
  };
  for (const std::string& item : items_) {
    if (const std::size_t named = find_name(item, names, file); named < names.size()) {
      choose(named);
      continue;
    }
    const auto [first, last] = read_range(item);
    if (first == 0 || last < first || last > columns) {
      throw Error(ErrorCode::kUsage, fmt::format("--columns: found \"{}\", expected a column of {}: {}",
                                                 printable(item), file, describe(names, columns)));
    }
    for (std::size_t column = first; column <= last; ++column) choose(column - 1);
  }
  return chosen;
}

}  // namespace ndhull
